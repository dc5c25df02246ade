#include "frame/passes/pass_helpers.h"

#include "core/error.h"

namespace ssrlab {

Parameter boolean_parameter(const char* name, bool fallback, const char* doc)
{
    return {name, ParameterType::boolean, fallback ? 1.0 : 0.0, 0, 1, {}, doc};
}

Parameter integer_parameter(const char* name, double fallback, double min, double max, const char* doc)
{
    return {name, ParameterType::integer, fallback, min, max, {}, doc};
}

Parameter real_parameter(const char* name, double fallback, double min, double max, const char* doc)
{
    return {name, ParameterType::real, fallback, min, max, {}, doc};
}

Parameter choice_parameter(ChoiceNames names, double fallback, const char* doc)
{
    constexpr std::string_view separator = ", ";
    std::vector<std::string>   choices;
    for (std::string_view rest = names.choices; !rest.empty();) {
        const size_t end = std::min(rest.find(separator), rest.size());
        choices.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + separator.size(), rest.size()));
    }
    const double last = static_cast<double>(choices.size()) - 1;
    return {std::string(names.parameter), ParameterType::choice, fallback, 0, last, std::move(choices), doc};
}

PassDecision needed_if_anything_reflects(const FrameFacts& /*facts*/, const FrameStatistics& statistics,
                                         const ParameterValues& /*values*/)
{
    const uint32_t reflecting = statistics.gbuffer.reflecting_pixels;
    if (reflecting == 0) return {PassDecision::not_needed, "no pixel reflects"};
    return {PassDecision::needed,
            fmt::format("{} pixels reflect ({})", reflecting, percent(reflecting, statistics.pixels))};
}

PassDecision needed_if_anything_is_rough(const FrameStatistics& statistics)
{
    const uint32_t all = statistics.gbuffer.reflecting_pixels, rough = all - statistics.gbuffer.roughness_pixels[0];
    if (all == 0) return {PassDecision::not_needed, "no pixel reflects"};
    if (rough == 0) return {PassDecision::not_needed, "every reflecting pixel is smooth"};
    return {PassDecision::needed, fmt::format("{} of the reflecting pixels are rough", percent(rough, all))};
}

PassDecision needed_at_lower_resolution(const FrameFacts& facts, const FrameStatistics& statistics,
                                        const ParameterValues& values)
{
    const int block_px = trace_block_px(values);
    if (block_px == 1) {
        const bool shading = choice<PassSet>(values) == PassSet::shading;
        return {shading ? PassDecision::off : PassDecision::not_needed, "every reflecting pixel has its own rays"};
    }
    if (statistics.gbuffer.reflecting_pixels == 0) return needed_if_anything_reflects(facts, statistics, values);
    return {PassDecision::needed, fmt::format("one pixel in {} has rays", block_px * block_px)};
}

bool one_ray_per_pixel(const ParameterValues& values)
{
    return values.at("rays_per_pixel") == 1 && trace_block_px(values) == 1;
}

std::string_view name_of(Resource resource)
{
    static constexpr auto names = std::to_array<std::string_view>(
        {"gbuffer",    "light",      "objects",     "layers",    "solids",      "surroundings", "tiles",
         "rays",       "structures", "hits",        "answers",   "reprojected", "small_colour", "cones",
         "reflection", "filtered",   "block_pixel", "lobe_rays", "history",     "kept",         "shaded"});
    static_assert(names.size() == static_cast<size_t>(Resource::shaded) + 1);
    return names[static_cast<size_t>(resource)];
}

namespace {

void require_declared(const PassContext& context, Resource resource)
{
    const auto has = [&](const std::vector<Resource>& list) { return std::ranges::count(list, resource) > 0; };
    if (!has(context.pass.reads) && !has(context.pass.writes))
        throw std::logic_error(
            fmt::format("the pass {} uses '{}' and does not declare it", context.pass.id, name_of(resource)));
}

/// What each ray found and where (passes/ray_reuse.comp).
Bindings lobe_ray_bindings(Gpu& gpu, const PassContext& context)
{
    const LobeRayImages& images  = lobe_ray_images(gpu, context);
    const bool           several = context.frame.plan.values.at("rays_per_pixel") > 1;
    return {{"ray_light_image", several ? images.light : context.frame.buffers->reflection},
            {"ray_end_image", images.end},
            {"gathered_image", images.gathered},
            {"reused_image", images.reused}};
}

Bindings history_bindings(const FrameInputs& frame)
{
    if (!frame.plan.facts.history.usable) return {};
    const FrameHistory& history = *frame.history;
    return {{"PreviousView", frame.motion.previous_view}, {"Objects", frame.motion.objects},
            {"previous_depth_image", history.depth},      {"previous_gradient_image", history.gradient},
            {"previous_normal_image", history.normal},    {"previous_reflection_image", history.reflection},
            {"previous_facts_image", history.facts},      {"previous_picture_image", history.picture}};
}

Bindings surroundings_of(const FrameInputs& frame)
{
    const GpuScene* scene = scene_of(*frame.buffers);
    if (scene == nullptr) return {};
    return {{"Frame", frame.buffers->drawing->frame_uniforms},
            {"environment_map", scene->environment_map},
            {"Lights", scene->lights},
            {"ShadowMatrices", scene->shadow_matrices},
            {"shadow_map", {scene->shadow_map, scene->shadow_sampler}}};
}

/// An image that frames at full resolution bind and leave alone.
Bound low_resolution(const FrameInputs& frame, const GpuImage& image)
{
    Bound bound(image);
    if (trace_block_px(frame.plan.values) == 1) bound.storage.bytes = 0;
    return bound;
}

Bindings layer_bindings(const FrameInputs& frame)
{
    Bindings         bindings;
    const GBufferPtr second = hits_hidden_layer(frame) ? frame.buffers->second_layer->gbuffer : nullptr;
    add_layers(bindings, second ? std::span<const GBufferPtr>(&second, 1)
                                : std::span<const GBufferPtr>(frame.lab->gbuffer->layers));
    return bindings;
}

} // namespace

const LobeRayImages& lobe_ray_images(Gpu& gpu, const PassContext& context)
{
    require_declared(context, Resource::lobe_rays);
    FrameBuffers&    buffers = *context.frame.buffers;
    const int        rays    = static_cast<int>(context.frame.plan.values.at("rays_per_pixel"));
    const glm::ivec2 own_px = buffers.gbuffer->view.size_px, size_px = own_px * glm::ivec2(1, rays);
    if (size_px.y > MAX_IMAGE_PX)
        throw_spec_error("rays_per_pixel = {} with gloss = stochastic: at most {} at this image's height", rays,
                         MAX_IMAGE_PX / own_px.y);
    std::shared_ptr<LobeRayImages>& images = buffers.lobe_rays[rays];
    if (!images) {
        images = std::make_shared<LobeRayImages>(
            LobeRayImages{rays > 1 ? make_storage_image(gpu, vk::Format::eR16G16B16A16Sfloat, size_px) : GpuImage{},
                          make_storage_image(gpu, vk::Format::eR32G32B32A32Sfloat, size_px),
                          make_storage_image(gpu, vk::Format::eR32G32B32A32Uint, own_px),
                          make_storage_image(gpu, vk::Format::eR32G32B32A32Uint, own_px)});
    }
    return *images;
}

Bindings bindings_of(Gpu& gpu, const PassContext& context, Resource resource)
{
    require_declared(context, resource);
    const FrameInputs&  frame   = context.frame;
    const FrameBuffers& buffers = *frame.buffers;
    const GBuffer&      gbuffer = *frame.lab->gbuffer;
    switch (resource) {
    case Resource::gbuffer: {
        Bindings surfaces = depth_bindings(gbuffer.depth);
        surfaces.insert({{"normal_image", gbuffer.normal},
                         {"material_image", gbuffer.material},
                         {"dielectric_image", gbuffer.dielectric}});
        return surfaces;
    }
    case Resource::light:
        return {{"radiance_image", gbuffer.radiance},
                {"highlight_image", gbuffer.highlight},
                {"emission_image", gbuffer.emission}};
    case Resource::objects: {
        Bindings objects = {{"object_image", gbuffer.object}, {"gradient_image", gbuffer.gradient}};
        if (gbuffer.motion_px) objects.insert({"motion_image", *gbuffer.motion_px});
        return objects;
    }
    case Resource::layers: return layer_bindings(frame);
    case Resource::solids: return {{"solid_image", gbuffer.solid}};
    case Resource::surroundings: return surroundings_of(frame);
    case Resource::tiles:
        return {{"TileMasks", gbuffer.tiles.masks},
                {"TileCount", gbuffer.tiles.count},
                {"Tiles", gbuffer.tiles.tiles},
                {"PictureStatistics", gbuffer.tiles.statistics}};
    case Resource::rays: return {{"RayCount", frame.rays->count}, {"Rays", frame.rays->list}};
    case Resource::hits: return {{"Hits", frame.rays->hits}};
    case Resource::answers: return frame.answers.bytes > 0 ? Bindings{{"RayLights", frame.answers}} : Bindings{};
    case Resource::structures: return {}; // the lab's own
    case Resource::reprojected:
        return frame.history ? Bindings{{"reprojected_image", frame.history->reprojected}} : Bindings{};
    case Resource::small_colour: return {{"small_colour_image", low_resolution(frame, buffers.small_colour)}};
    case Resource::cones:
        return buffers.cone ? Bindings{{"cone_pyramid", buffers.cone->cells}, {"cone_ranges", buffers.cone->ranges}}
                            : Bindings{};
    case Resource::reflection: return {{"reflection_image", buffers.reflection}};
    case Resource::filtered: return {{"filtered_image", buffers.filtered}};
    case Resource::block_pixel: return {{"block_pixel_image", low_resolution(frame, buffers.block_pixel)}};
    case Resource::lobe_rays: return draws_lobe_rays(frame.plan.values) ? lobe_ray_bindings(gpu, context) : Bindings{};
    case Resource::history: return history_bindings(frame);
    case Resource::kept:
        return frame.history ? Bindings{{"kept_reflection_image", frame.history->kept_reflection},
                                        {"kept_facts_image", frame.history->kept_facts},
                                        {"kept_picture_image", frame.history->kept_picture},
                                        {"HistoryCounts", frame.history->counts}}
                             : Bindings{};
    case Resource::shaded: return {{"shaded_image", buffers.shaded}};
    }
    return {};
}

const GpuImage& image_of(const PassContext& context, Resource resource)
{
    require_declared(context, resource);
    const FrameBuffers& buffers = *context.frame.buffers;
    switch (resource) {
    case Resource::reflection: return buffers.reflection;
    case Resource::filtered: return buffers.filtered;
    case Resource::block_pixel: return buffers.block_pixel;
    case Resource::shaded: return buffers.shaded;
    default: throw std::logic_error(fmt::format("'{}' is no single image", name_of(resource)));
    }
}

const Buffer& tile_launch(const PassContext& context)
{
    require_declared(context, Resource::tiles);
    return context.frame.lab->gbuffer->tiles.launch;
}

const Buffer& ray_launch(const PassContext& context)
{
    require_declared(context, Resource::rays);
    return context.frame.rays->launch;
}

bool hits_hidden_layer(const FrameInputs& frame) { return runs(frame.plan, "hidden_layer"); }

ComputePass make_pass(Gpu& gpu, const PassContext& context, const std::string& shader, const Defines& defines,
                      const Bindings& more, uint32_t push_constant_bytes)
{
    return make_composed_pass(gpu, context, {.file = shader, .defines = defines}, more, {}, push_constant_bytes);
}

ComputePass make_composed_pass(Gpu& gpu, const PassContext& context, ShaderSource source, const Bindings& more,
                               std::span<const Parameter> own, uint32_t push_constant_bytes)
{
    const FrameInputs&  frame     = context.frame;
    const FrameBuffers& buffers   = *frame.buffers;
    const GBuffer&      gbuffer   = *frame.lab->gbuffer;
    Constants           constants = settings_constants(gbuffer.view, frame.lab->settings, NumberFormat::float32);
    add_parameters(constants, pass_parameters(), frame.plan.values, CONSTANT_PASSES);
    add_parameters(constants, own, frame.plan.values, CONSTANT_REPROJECTION);
    Bindings bindings = more;
    if (!bindings.contains("Rays")) source.defines.merge(ray_list_defines(gpu, *frame.rays));
    bindings.insert({{"View", gbuffer.view_uniforms},
                     {"Ambient", buffers.ambient},
                     {"dfg_table", {buffers.dfg_table.image, buffers.dfg_table.sampler}}});
    for (const std::vector<Resource>& declared : {context.pass.reads, context.pass.writes})
        for (const Resource resource : declared) bindings.merge(bindings_of(gpu, context, resource));
    source.include_texts.emplace("pass/parameters", parameter_declarations(pass_parameters(), CONSTANT_PASSES));
    try {
        return make_compute_pass(gpu, compile_shader(gpu, source), bindings, constants, push_constant_bytes);
    } catch (const std::logic_error& error) {
        throw std::logic_error(
            fmt::format("the pass {} does not declare what it uses: {}", context.pass.id, error.what()));
    }
}

std::shared_ptr<ComputePass> make_shared_pass(Gpu& gpu, const PassContext& context, const std::string& shader,
                                              const Defines& defines)
{
    return std::make_shared<ComputePass>(make_pass(gpu, context, shader, defines));
}

ComputePass make_colour_pass(Gpu& gpu, const PassContext& context, const std::string& shader, Defines defines,
                             Bindings more)
{
    const FrameInputs&     frame  = context.frame;
    const ParameterValues& values = frame.plan.values;
    if (choice<HitShading>(values) == HitShading::mirrored) defines.emplace("MIRRORED_LIGHT", "1");
    defines.emplace("LAYERS", std::to_string(layers_of_hits(frame)));
    if (draws_lobe_rays(values)) {
        defines.emplace("LOBE_RAYS", "1");
        add_environment(gpu, context, defines, more);
    }
    if (runs(frame.plan, "cone_pyramid")) defines.emplace("CONE", "1");
    return make_pass(gpu, context, shader, defines, more);
}

int layers_of_hits(const FrameInputs& frame) { return hits_hidden_layer(frame) ? 2 : frame.lab->settings.layers; }

void add_environment(Gpu& gpu, const PassContext& context, Defines& defines, Bindings& bindings)
{
    require_declared(context, Resource::surroundings);
    GpuScene* scene = scene_of(*context.frame.buffers);
    if (scene == nullptr || context.frame.plan.values.at("environment_fallback") == 0) return;
    const GBufferCounts& counts = context.frame.plan.statistics.gbuffer;
    const bool           smooth = counts.roughness_pixels[0] == counts.reflecting_pixels; // looks up the map alone
    const GpuImage&      levels = smooth ? scene->environment_map : blurred_environment(gpu, *scene);
    defines.emplace("ENVIRONMENT", "1");
    bindings.insert({"environment_levels", {levels, scene->shadow_sampler}}); // only fetched from
}

} // namespace ssrlab
