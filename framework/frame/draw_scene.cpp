// The one graphics pipeline that G-buffer and shadow passes share.
#include "frame/gpu_scene.h"

#include <algorithm>

namespace ssrlab {
namespace {

/// Entirely beyond one plane of the clip volume?
bool outside(const GpuScene::DrawCall& draw, const glm::dmat4& world_to_clip)
{
    int beyond[5] = {};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) != 0 ? draw.bounds_max_ws.x : draw.bounds_min_ws.x,
                           (corner & 2) != 0 ? draw.bounds_max_ws.y : draw.bounds_min_ws.y,
                           (corner & 4) != 0 ? draw.bounds_max_ws.z : draw.bounds_min_ws.z);
        const glm::dvec4 clip = world_to_clip * glm::dvec4(p, 1.0);
        beyond[0] += clip.x < -clip.w;
        beyond[1] += clip.x > clip.w;
        beyond[2] += clip.y < -clip.w;
        beyond[3] += clip.y > clip.w;
        beyond[4] += clip.w <= 0;
    }
    return std::ranges::any_of(beyond, [](int count) { return count == 8; });
}

vk::raii::ShaderModule make_module(Gpu& gpu, const Shader& shader)
{
    return {gpu.impl->device,
            vk::ShaderModuleCreateInfo{.codeSize = shader.spirv.size() * 4, .pCode = shader.spirv.data()}};
}

/// What the vertex shader reads: the place alone where nothing else is asked of a surface.
enum class VertexInput : uint8_t { all, position };

vk::raii::Pipeline make_pipeline(Gpu& gpu, const vk::raii::PipelineLayout& layout, const DrawPipelineOptions& options,
                                 VertexInput reads)
{
    const bool position_only = reads == VertexInput::position;
    auto       defines       = options.fragment_defines;
    if (options.depth_alone && !position_only) defines.emplace("ALPHA_MASKS", "1");
    const Shader vertex = compile_shader(
        gpu, {.file = position_only ? "gbuffer/position.vert" : "gbuffer/gbuffer.vert", .stage = ShaderStage::vertex});
    const Shader fragment =
        compile_shader(gpu, {.file = options.fragment_shader, .stage = ShaderStage::fragment, .defines = defines});
    const auto vertex_module = make_module(gpu, vertex), fragment_module = make_module(gpu, fragment);

    const vk::PipelineShaderStageCreateInfo stages[] = {
        {.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex_module, .pName = "main"},
        {.stage = vk::ShaderStageFlagBits::eFragment, .module = *fragment_module, .pName = "main"}};
    const vk::VertexInputBindingDescription   binding{0, sizeof(Vertex), vk::VertexInputRate::eVertex};
    const vk::VertexInputAttributeDescription attributes[] = {
        {0, 0, vk::Format::eR32G32B32Sfloat, offsetof(Vertex, position_ws)},
        {1, 0, vk::Format::eR32G32B32Sfloat, offsetof(Vertex, normal_ws)},
        {2, 0, vk::Format::eR32G32B32A32Sfloat, offsetof(Vertex, tangent_ws)},
        {3, 0, vk::Format::eR32G32Sfloat, offsetof(Vertex, uv0)},
        {4, 0, vk::Format::eR32G32Sfloat, offsetof(Vertex, uv1)},
        {5, 0, vk::Format::eR32G32B32A32Sfloat, offsetof(Vertex, colour)},
        {6, 0, vk::Format::eR32G32B32Sfloat, offsetof(Vertex, bounced)}};
    const vk::PipelineVertexInputStateCreateInfo   input{.vertexBindingDescriptionCount = 1,
                                                         .pVertexBindingDescriptions    = &binding,
                                                         .vertexAttributeDescriptionCount =
                                                           position_only ? 1U : uint32_t{std::size(attributes)},
                                                         .pVertexAttributeDescriptions = attributes};
    const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
    const vk::PipelineViewportStateCreateInfo      viewport{.viewportCount = 1, .scissorCount = 1};
    const bool                                     biased = !options.reversed_depth;
    const vk::PipelineRasterizationStateCreateInfo raster{.frontFace               = vk::FrontFace::eCounterClockwise,
                                                          .depthBiasEnable         = biased,
                                                          .depthBiasConstantFactor = 4.0F,
                                                          .depthBiasSlopeFactor    = 2.0F,
                                                          .lineWidth               = 1.0F};
    const vk::PipelineMultisampleStateCreateInfo   samples{.rasterizationSamples = vk::SampleCountFlagBits::e1};
    const vk::PipelineDepthStencilStateCreateInfo  depth{
         .depthTestEnable  = true,
         .depthWriteEnable = true,
         .depthCompareOp   = options.reversed_depth ? vk::CompareOp::eGreater : vk::CompareOp::eLess};
    using Component = vk::ColorComponentFlagBits;
    const std::vector<vk::PipelineColorBlendAttachmentState> blend(
        options.colour_formats.size(),
        {.colorWriteMask = Component::eR | Component::eG | Component::eB | Component::eA});
    const vk::PipelineColorBlendStateCreateInfo blending{.attachmentCount = static_cast<uint32_t>(blend.size()),
                                                         .pAttachments    = blend.data()};
    const vk::DynamicState                      dynamic[] = {vk::DynamicState::eViewport, vk::DynamicState::eScissor,
                                                             vk::DynamicState::eCullMode};
    const vk::PipelineDynamicStateCreateInfo    dynamics{.dynamicStateCount = std::size(dynamic),
                                                         .pDynamicStates    = dynamic};
    const vk::PipelineRenderingCreateInfo       rendering{.colorAttachmentCount =
                                                        static_cast<uint32_t>(options.colour_formats.size()),
                                                          .pColorAttachmentFormats = options.colour_formats.data(),
                                                          .depthAttachmentFormat   = vk::Format::eD32Sfloat};
    const vk::GraphicsPipelineCreateInfo        info{.pNext               = &rendering,
                                                     .stageCount          = std::size(stages),
                                                     .pStages             = stages,
                                                     .pVertexInputState   = &input,
                                                     .pInputAssemblyState = &assembly,
                                                     .pViewportState      = &viewport,
                                                     .pRasterizationState = &raster,
                                                     .pMultisampleState   = &samples,
                                                     .pDepthStencilState  = &depth,
                                                     .pColorBlendState    = &blending,
                                                     .pDynamicState       = &dynamics,
                                                     .layout              = *layout};
    return {gpu.impl->device, gpu.impl->pipeline_cache, info};
}

} // namespace

DrawPipeline make_draw_pipeline(Gpu& gpu, const GpuScene& scene, const DrawPipelineOptions& options)
{
    DrawPipeline result;
    result.culling                          = options.culling;
    const vk::DescriptorSetLayout layouts[] = {*scene.frame_layout, *scene.material_layout};
    const vk::PushConstantRange   range{vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment, 0,
                                      sizeof(DrawPush)};
    result.layout = {gpu.impl->device, vk::PipelineLayoutCreateInfo{.setLayoutCount         = 2,
                                                                    .pSetLayouts            = layouts,
                                                                    .pushConstantRangeCount = 1,
                                                                    .pPushConstantRanges    = &range}};
    if (options.depth_alone) result.opaque = make_pipeline(gpu, result.layout, options, VertexInput::position);
    if (!options.depth_alone || scene.alpha_mask)
        result.pipeline = make_pipeline(gpu, result.layout, options, VertexInput::all);
    return result;
}

void draw_scene(const Commands& commands, const GpuScene& scene, const DrawPipeline& pipeline,
                vk::DescriptorSet frame_set, const glm::dmat4& world_to_clip)
{
    const vk::Pipeline of_opaque = *pipeline.opaque ? *pipeline.opaque : *pipeline.pipeline;
    vk::Pipeline       bound;
    commands.bindVertexBuffers(0, *scene.vertices.buffer, vk::DeviceSize{0});
    commands.bindIndexBuffer(*scene.indices.buffer, 0, vk::IndexType::eUint32);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *pipeline.layout, 0, frame_set, nullptr);
    for (const GpuScene::DrawCall& draw : scene.draws) {
        if (draw.index_count == 0 || outside(draw, world_to_clip)) continue;
        if (const vk::Pipeline own = draw.alpha_mask ? *pipeline.pipeline : of_opaque; own != bound)
            commands.bindPipeline(vk::PipelineBindPoint::eGraphics, bound = own);
        const DrawPush push{glm::mat4(world_to_clip), draw.material, draw.object_id};
        const bool     culls =
            pipeline.culling == Culling::back_faces || (pipeline.culling == Culling::by_material && !draw.double_sided);
        commands.setCullMode(culls ? vk::CullModeFlagBits::eBack : vk::CullModeFlagBits::eNone);
        commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *pipeline.layout, 1,
                                    *scene.material_sets[draw.material], nullptr);
        commands.pushConstants<DrawPush>(
            *pipeline.layout, vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment, 0, push);
        commands.drawIndexed(draw.index_count, 1, draw.first_index, 0, 0);
    }
}

} // namespace ssrlab
