#include "benchmarks/bench.h"
#include "core/pixel_index.h"
#include "shared.h"

namespace ssrlab {

/// One of 16 pixels keeps its metal, chosen by a hash of its place.
Bench::Scattered Bench::scatter(Picture& p)
{
    GBufferImage image = read_gbuffer(gpu_, *p.gbuffer);
    for (size_t i = 0; i < image.metallic.size(); ++i)
        if (static_cast<uint32_t>(i) * 2654435761U >> 28 != 0) image.metallic[i] = 0;
    Scattered s;
    s.gbuffer                  = upload_gbuffer(gpu_, image);
    s.buffers                  = make_frame_buffers(gpu_, s.gbuffer);
    const Technique& technique = find_technique(techniques_, "hiz");
    s.frame                    = prepare_frame(gpu_, s.buffers, technique, default_values(technique), bench_settings);
    run_frame(gpu_, *s.frame);

    const glm::ivec2 size                 = p.gbuffer->view.size_px;
    const auto       capacity             = pixel_count(size);
    const size_t     count                = s.frame->rays->capacity;
    s.every_pixel                         = make_ray_buffers(gpu_, capacity, Precision::float32);
    s.over_every_pixel                    = make_trace_passes(gpu_, *s.frame, s.every_pixel, s.buffers->view, nullptr);
    const auto             listed_origins = download_as<glm::vec3>(gpu_, s.frame->rays->origins, count);
    const auto             listed_deltas  = download_as<glm::vec3>(gpu_, s.frame->rays->deltas, count);
    const auto             listed_lengths = download_as<float>(gpu_, s.frame->rays->lengths, count);
    const auto             listed_pixels  = download_as<uint32_t>(gpu_, s.frame->rays->pixels, count);
    std::vector<glm::vec3> origins(capacity), deltas(capacity);
    std::vector<float>     lengths(capacity);
    std::vector<uint32_t>  pixels(capacity);
    for (size_t i = 0; i < capacity; ++i) origins[i] = glm::vec3(glm::vec2(pixel_at(i, size)) + 0.5F, 1);
    for (size_t i = 0; i < count; ++i) {
        const size_t place = pixel_index(unpack_pixel(listed_pixels[i]), size);
        origins[place]     = listed_origins[i];
        deltas[place]      = listed_deltas[i];
        lengths[place]     = listed_lengths[i];
        pixels[place]      = listed_pixels[i];
    }
    const auto all = static_cast<uint32_t>(capacity);
    upload(gpu_, s.every_pixel.count, &all, sizeof(all));
    upload(gpu_, s.every_pixel.origins, origins.data(), capacity * sizeof(origins[0]));
    upload(gpu_, s.every_pixel.deltas, deltas.data(), capacity * sizeof(deltas[0]));
    upload(gpu_, s.every_pixel.lengths, lengths.data(), capacity * sizeof(lengths[0]));
    upload(gpu_, s.every_pixel.pixels, pixels.data(), capacity * sizeof(pixels[0]));
    submit(gpu_, [&](const auto& commands) {
        barrier(commands);
        dispatch(commands, s.over_every_pixel.ray_launch, {1, 1, 1});
        barrier(commands);
    });
    return s;
}

} // namespace ssrlab
