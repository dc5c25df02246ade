#include "frame/layers.h"

#include "frame/solid_backs.h"

#include <fmt/format.h>

namespace ssrlab {

void prepare_layers(Gpu& gpu, GBuffer& gbuffer, const TraceSettings& settings)
{
    while (static_cast<int>(gbuffer.layers.size()) + 1 < settings.layers) {
        const GBuffer& before = gbuffer.layers.empty() ? gbuffer : *gbuffer.layers.back();
        if (!gbuffer.scene) {
            gbuffer.layers.push_back(make_gbuffer(gpu, gbuffer.view, Filled::uploaded));
            continue;
        }
        const GBufferPtr& layer = gbuffer.layers.emplace_back(make_next_layer(gpu, before));
        submit(gpu, [&](const vk::raii::CommandBuffer& commands) { record_drawing(commands, *layer); });
        prepare_solid_backs(gpu, *layer);
    }
}

void record_layers(const vk::raii::CommandBuffer& commands, const GBuffer& gbuffer, const TraceSettings& settings)
{
    for (int i = 0; i + 1 < settings.layers; ++i) record_drawing(commands, *gbuffer.layers[static_cast<size_t>(i)]);
}

void add_layers(Bindings& bindings, std::span<const GBufferPtr> layers)
{
    for (size_t i = 0; i < layers.size(); ++i) {
        const GBuffer& layer = *layers[i];
        const auto     name  = [&](const char* what) { return fmt::format("layer_{}_{}", i + 1, what); };
        bindings.insert({{name("cells"), layer.depth.cells},
                         {name("depth_words"), {layer.depth.cells, layer.depth.words}},
                         {name("normal_image"), layer.normal},
                         {name("material_image"), layer.material},
                         {name("radiance_image"), layer.radiance},
                         {name("highlight_image"), layer.highlight},
                         {name("object_image"), layer.object},
                         {name("dielectric_image"), layer.dielectric},
                         {name("solid_image"), layer.solid}});
    }
}

} // namespace ssrlab
