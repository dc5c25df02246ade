#include "benchmarks/bench.h"
#include "core/pixel_index.h"
#include "shared.h"

namespace ssrlab {

/// One of 16 pixels keeps its metal, chosen by a hash of its place.
Bench::Scattered Bench::scatter(Workload& w)
{
    GBufferImage image = read_gbuffer(gpu_, *w.gbuffer);
    for (size_t i = 0; i < image.metallic.size(); ++i)
        if (static_cast<uint32_t>(i) * 2654435761U >> 28 != 0) image.metallic[i] = 0;
    Scattered s;
    s.gbuffer                  = upload_gbuffer(gpu_, image);
    s.buffers                  = make_frame_buffers(gpu_, s.gbuffer);
    const Technique& technique = find_technique(catalogue_.techniques, tracer_.technique);
    const LabPtr     lab =
        make_lab(gpu_, catalogue_, s.gbuffer, technique, default_values(technique), bench_settings.trace);
    s.frame = make_frame(gpu_, lab, s.buffers, plan_frame(gpu_, catalogue_, lab, s.buffers, bench_settings));
    run_frame(gpu_, *s.frame);

    const glm::ivec2 size     = w.gbuffer->view.size_px;
    const auto       capacity = pixel_count(size);
    const size_t     count    = s.frame->inputs.rays->capacity;
    s.every_pixel             = make_ray_buffers(gpu_, capacity, NumberFormat::float32);
    s.over_every_pixel        = make_trace_passes(gpu_, *lab, s.every_pixel, s.gbuffer->view_uniforms);
    std::vector<PackedRay<float>> rays(capacity);
    for (size_t i = 0; i < capacity; ++i) rays[i].origin = glm::vec3(glm::vec2(pixel_at(i, size)) + 0.5F, 1);
    for (const PackedRay<float>& ray : download_as<PackedRay<float>>(gpu_, s.frame->inputs.rays->list, count))
        rays[pixel_index(unpack_pixel(ray.pixel), size)] = ray;
    set_ray_count(gpu_, s.every_pixel, capacity);
    upload(gpu_, s.every_pixel.list, rays.data(), capacity * sizeof(rays[0]));
    return s;
}

} // namespace ssrlab
