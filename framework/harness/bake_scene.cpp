#include "harness/bake_scene.h"

#include "gpu/disk_cache.h"
#include "truth/bounced_light.h"
#include "truth/truth_cache.h"

#include <fmt/format.h>

#include <cstring>

namespace ssrlab {

void bake_scene(Scene& scene, const std::function<void(const std::string&)>& say)
{
    if (!scene.bake) return;
    const std::string      name = "bounced_" + bounced_light_key(scene);
    std::vector<glm::vec3> light(scene.vertices.size());
    const size_t           bytes = light.size() * sizeof(glm::vec3);
    if (const auto kept = read_cached(name); kept && kept->size() == bytes) {
        std::memcpy(static_cast<void*>(light.data()), kept->data(), bytes);
    } else {
        say(fmt::format("{}: computing the bounced light of {} vertices; it is kept for the next time", scene.name,
                        light.size()));
        light = bounced_light(scene);
        write_cached(name, {reinterpret_cast<const char*>(light.data()), bytes});
    }
    for (size_t v = 0; v < light.size(); ++v) scene.vertices[v].bounced = glm::min(light[v], largest_radiance);
}

} // namespace ssrlab
