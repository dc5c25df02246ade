#include "world/world.h"

#include "gpu/timed_run.h"
#include "shared.h"
#include "world/materials.h"

#include <algorithm>

namespace ssrlab {
namespace {

struct TextureBlock {
    glm::ivec2 size_px;
    uint32_t   first; // texel
    uint32_t   flags; // wrap u, wrap v: two bits each; nearest; sRGB
};

void upload_textures(Gpu& gpu, const Scene& scene, World& world)
{
    std::vector<TextureBlock> blocks;
    std::vector<uint8_t>      texels;
    for (const Texture& texture : scene.textures) {
        blocks.push_back({texture.rgba.empty() ? glm::ivec2(0) : texture.size_px,
                          static_cast<uint32_t>(texels.size() / 4),
                          uint32_t(texture.wrap_u) | uint32_t(texture.wrap_v) << 2U | uint32_t(texture.nearest) << 4U |
                              uint32_t(texture.srgb) << 5U});
        texels.insert(texels.end(), texture.rgba.begin(), texture.rgba.end());
    }
    world.textures = make_buffer_with<TextureBlock>(gpu, blocks);
    world.texels   = make_buffer_with<uint8_t>(gpu, texels);
    world.bytes += blocks.size() * sizeof(TextureBlock) + texels.size();
}

template <typename T> Buffer make_texels(Gpu& gpu, const std::vector<T>& values)
{
    Buffer buffer =
        make_texel_buffer(gpu, std::max<uint64_t>(values.size() * sizeof(T), 16), vk::Format::eR32G32B32A32Uint);
    if (!values.empty()) upload(gpu, buffer, values.data(), values.size() * sizeof(T));
    return buffer;
}

} // namespace

WorldRayList make_ray_list(Gpu& gpu, std::span<const WorldRay> rays)
{
    const ListLaunch launch{groups_in_rows(rays.size(), RAYS_PER_GROUP, LAUNCH_ROW_GROUPS),
                            static_cast<uint32_t>(rays.size())};
    return {make_buffer_with<WorldRay>(gpu, rays), make_buffer_with<ListLaunch>(gpu, std::span(&launch, 1))};
}

WorldRayList make_ray_list(Gpu& gpu, size_t capacity)
{
    return {make_buffer(gpu, capacity * sizeof(WorldRay)), make_buffer(gpu, sizeof(ListLaunch))};
}

void record_empty(const Commands& commands, const Buffer& launch)
{
    commands.updateBuffer<ListLaunch>(*launch.buffer, 0, ListLaunch{});
}

Bindings material_bindings(const World& world)
{
    return {{"Triangles", world.triangles}, {"Vertices", world.vertices}, {"Indices", world.indices},
            {"Materials", world.materials}, {"Textures", world.textures}, {"Texels", world.texels}};
}

std::shared_ptr<World> upload_world(Gpu& gpu, const Scene& scene)
{
    auto world         = std::make_shared<World>();
    world->tree        = build_triangle_tree(scene);
    world->nodes       = make_texels(gpu, world->tree.nodes);
    world->triangles   = make_texels(gpu, world->tree.triangles);
    world->vertices    = make_buffer_with<Vertex>(gpu, scene.vertices);
    world->indices     = make_buffer_with<uint32_t>(gpu, scene.indices);
    world->alpha_masks = std::ranges::any_of(scene.materials, &Material::alpha_mask);
    world->materials   = upload_materials(gpu, scene.materials);
    world->bytes = world->tree.nodes.size() * sizeof(TreeNode) + world->tree.triangles.size() * sizeof(TreeTriangle) +
                   scene.vertices.size() * sizeof(Vertex) + scene.indices.size() * sizeof(uint32_t) +
                   world->materials.bytes;
    upload_textures(gpu, scene, *world);
    return world;
}

void move_world(Gpu& gpu, World& world, const Scene& moved)
{
    const auto replace = [&](Buffer& buffer, const auto& values) {
        if (!values.empty()) upload(gpu, buffer, values.data(), values.size() * sizeof(values[0]));
    };
    refit(world.tree, moved);
    replace(world.nodes, world.tree.nodes);
    replace(world.triangles, world.tree.triangles);
    replace(world.vertices, moved.vertices);
}

namespace {

ComputePass make_walk(Gpu& gpu, const World& world, const WorldRayList& list, const Buffer& hits, const Buffer* visits)
{
    std::map<std::string, std::string> defines;
    Bindings                           bindings = material_bindings(world);
    bindings.insert(
        {{"Nodes", world.nodes}, {"WorldRays", list.rays}, {"WorldLaunch", list.launch}, {"WorldHits", hits}});
    if (world.alpha_masks) defines.emplace("ALPHA_MASKS", "1");
    if (visits != nullptr) {
        defines.emplace("COUNT_WORK", "1");
        bindings.insert({"NodeVisits", *visits});
    }
    return make_compute_pass(gpu, compile_shader(gpu, {.file = "world/walk.comp", .defines = defines}), bindings);
}

} // namespace

ComputePass make_walk_pass(Gpu& gpu, const World& world, const WorldRayList& list, const Buffer& hits)
{
    return make_walk(gpu, world, list, hits, nullptr);
}

WorldTrace trace_world(Gpu& gpu, const World& world, std::span<const WorldRay> rays)
{
    WorldTrace trace;
    trace.hits.resize(rays.size());
    if (rays.empty() || world.tree.nodes.empty()) return trace;
    const WorldRayList list     = make_ray_list(gpu, rays);
    const Buffer       hits     = make_buffer(gpu, rays.size() * sizeof(WorldHit));
    const Buffer       visits   = make_buffer(gpu, rays.size() * sizeof(uint32_t));
    const ComputePass  counting = make_walk(gpu, world, list, hits, &visits),
                      walk      = make_walk(gpu, world, list, hits, nullptr);
    submit(gpu, [&](const Commands& commands) { dispatch_indirect(commands, counting, list.launch); });
    for (const uint32_t of_ray : download_as<uint32_t>(gpu, visits, rays.size())) trace.node_visits += of_ray;
    trace.ms   = time_second_run_ms(gpu, [&](const auto& commands) { dispatch_indirect(commands, walk, list.launch); });
    trace.hits = download_as<WorldHit>(gpu, hits, rays.size());
    return trace;
}

} // namespace ssrlab
