#include "app/new_technique.h"

#include "core/error.h"
#include "core/files.h"
#include "core/names.h"
#include "trace/catalogue.h"

#include <cstdio>

namespace ssrlab {
namespace {

constexpr const char* manifest = R"(name       = "{0}"
summary    = "Looks at places a fixed number of pixels apart."
limits     = ["point_sampled", "tests_whole_steps"] # what it does not claim; docs/reference/manifests.md
bounded_by = ["max_steps"]                          # bounds the loop

[parameters]
stride_px = {{ default = 4.0, min = 1.0, max = 64.0, doc = "Distance between two places on screen." }}
max_steps = {{ default = 1024, min = 1, max = 60000, doc = "Places before the ray gives up." }}
)";

constexpr const char* trace = R"(// Place after place along the ray, until the ray meets a surface at one.
#include "api/sampling.glsl"

TraceResult trace(Ray ray)
{
    real  dt = real(stride_px) / max(length(ray.delta.xy), real(stride_px)), t = real(0);
    real  begin = start_pixel_end_t(ray);
    Contact contact = no_contact();
    int     taken   = 0;
    while (!contact.found && t + dt <= real(1) && taken < max_steps)
    {
        ++taken;
        t           = real(taken) * dt;
        ivec2 pixel = pixel_at(ray, t);
        if (pixel != ray.start_pixel) contact = test_pixel(ray, pixel, max(t - dt, begin), t);
    }
    if (contact.found) return hit_at(ray, contact, t, taken);
    if (taken == max_steps) return out_of_steps(taken);
    return miss(ray, taken);
}
)";

} // namespace

int write_new_technique(const std::filesystem::path& folder)
{
    const std::string id = folder.filename().string();
    if (const std::string fault = glsl_name_fault(id); !fault.empty())
        throw_spec_error("'{}' cannot be a technique's name: {}", id, fault);
    if (id == fastest_exact)
        throw_spec_error("'{}' cannot be a technique's name: it stands for the fastest exact technique", id);
    if (std::filesystem::exists(folder)) throw_spec_error("{}: already there", folder.string());
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw_failure("{}: cannot be created: {}", folder.string(), error.message());
    write_file_atomically(folder / "technique.toml", fmt::format(manifest, id));
    write_file_atomically(folder / "trace.glsl", trace);
    std::puts(fmt::format("{0}/technique.toml says what it is, {0}/trace.glsl how it traces. Now:\n"
                          "  ssrlab --techniques {0} check {1}\n"
                          "  ssrlab --techniques {0} render builtin:stairs -t {1} -o {1}.png",
                          folder.string(), id)
                  .c_str());
    return 0;
}

} // namespace ssrlab
