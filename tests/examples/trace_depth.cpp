// The tracing lab alone: rays up the depth of an EXR, traced by a named technique; prints how each ended.
#include "core/error.h"
#include "trace/lab.h"

#include <OpenImageIO/imageio.h>

int main(int argc, char** argv)
try {
    using namespace ssrlab;
    if (argc != 3) throw_spec_error("usage: trace_depth FRAME.exr TECHNIQUE");
    const auto file    = OIIO::ImageInput::open(argv[1]);
    const int  channel = file ? file->spec().channelindex("depth") : -1;
    if (channel < 0) throw_spec_error("{}: expected an image with a channel 'depth'", argv[1]);
    const glm::ivec2   size_px(file->spec().width, file->spec().height);
    std::vector<float> depth(pixel_count(size_px));
    file->read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::FLOAT, depth.data());

    Gpu                   gpu       = open_gpu();
    const Catalogue       catalogue = load_catalogue();
    const Technique&      technique = find_technique(catalogue.techniques, argv[2]);
    const GBufferPtr      gbuffer   = upload_depth(gpu, camera_to_view(Camera{}, size_px), depth);
    const TraceSettings   settings  = boxes({.thickness_m = 1});
    std::vector<RayInput> rays; // from the lower border to the upper one, where they are ten times as far away
    for (int x = 0; x < size_px.x; x += 8)
        if (const double from = depth[pixel_index({x, size_px.y - 1}, size_px)]; from > 0)
            rays.push_back({{x + 0.5, size_px.y - 0.5, from}, {0, 1 - size_px.y, -0.9 * from}});
    const LabPtr    lab    = make_lab(gpu, catalogue, gbuffer, technique, default_values(technique), settings);
    const TracerPtr tracer = make_tracer(gpu, lab, rays.size());
    for (size_t i = 0; const RayOutcome& found : trace_rays(gpu, *tracer, rays))
        fmt::print("x {} {} at {},{}\n", rays[i++].origin_px_depth.x, status_name(found.status), found.hit_pixel.x,
                   found.hit_pixel.y);
} catch (const std::exception& error) {
    fmt::print(stderr, "trace_depth: {}\n", error.what());
    return 1;
}
