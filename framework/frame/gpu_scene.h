// A scene on the device: geometry, materials, textures, lights and shadow maps.
#pragma once

#include "frame/scene_pictures.h"
#include "gpu/compute.h"
#include "trace/depth_buffer.h"

namespace ssrlab {

/// Push constants of every pass that draws the scene (shaders/gbuffer/scene_types.glsl).
struct DrawPush {
    glm::mat4 world_to_clip;
    uint32_t  material_index;
    uint32_t  object_id;
};

/// Which sides of triangles are left out.
enum class Culling : uint8_t { by_material /* back faces, but of double-sided materials none */, back_faces, nothing };

struct DrawPipeline {
    vk::raii::PipelineLayout layout   = nullptr;
    vk::raii::Pipeline       pipeline = nullptr; // for any material; null if none needs it
    vk::raii::Pipeline       opaque   = nullptr; // for materials without an alpha mask; null: `pipeline`
    Culling                  culling  = Culling::by_material;
};

struct GpuScene {
    struct DrawCall {
        uint32_t  first_index = 0, index_count = 0, material = 0, object_id = 0;
        bool      double_sided = false, alpha_mask = false;
        glm::vec3 bounds_min_ws{0}, bounds_max_ws{0};
    };
    Buffer                               vertices, indices, materials, lights, shadow_matrices;
    std::vector<GpuImage>                textures;
    std::vector<vk::raii::Sampler>       samplers; // one per texture; the last is the default
    vk::raii::Sampler                    shadow_sampler = nullptr;
    GpuImage                             shadow_map; // one layer per directional or spot light, six per point light
    GpuImage                             environment_map;     // RGBA32F; without one, a texel of Scene::background
    EnvironmentMap                       environment;         // on the host; empty if there is none
    std::optional<GpuImage>              blurred_environment; // RGBA32F, of half floats; when a frame first needs it
    vk::raii::DescriptorSetLayout        frame_layout    = nullptr; // set 0
    vk::raii::DescriptorSetLayout        material_layout = nullptr; // set 1
    vk::raii::DescriptorPool             pool            = nullptr;
    std::vector<vk::raii::DescriptorSet> material_sets;
    std::vector<DrawCall>                draws;
    // Made when first drawn: lavapipe never frees the memory of a graphics pipeline.
    std::shared_ptr<const DrawPipeline> first_layer_pipeline, second_layer_pipeline, layer_pipeline,
        solid_back_pipeline, shadow_pipeline;
    glm::vec3 ambient{0};
    bool      alpha_mask          = false; // some material has one
    bool      has_environment_map = false;
};

/// With depth_alone, the fragment shader reads nothing of a surface but what shaders/gbuffer/cut_out.glsl does.
struct DrawPipelineOptions {
    const char*             fragment_shader = nullptr;
    std::vector<vk::Format> colour_formats;
    bool reversed_depth = true; // the G-buffer's convention; shadow maps use standard depth with a bias
    std::map<std::string, std::string> fragment_defines = {};
    Culling                            culling          = Culling::by_material;
    bool                               depth_alone      = false;
};
DrawPipeline make_draw_pipeline(Gpu& gpu, const GpuScene& scene, const DrawPipelineOptions& options);

/// Draws everything whose bounds are not entirely outside the clip volume.
void draw_scene(const Commands& commands, const GpuScene& scene, const DrawPipeline& pipeline,
                vk::DescriptorSet frame_set, const glm::dmat4& world_to_clip);

/// Descriptor set 0: frame uniforms and, for the second layer, the depth of the first. Kept by the caller.
struct FrameSet {
    vk::raii::DescriptorPool pool = nullptr;
    vk::raii::DescriptorSet  set  = nullptr;
};
FrameSet make_frame_set(Gpu& gpu, const GpuScene& scene, const Buffer& frame_uniforms,
                        const DepthBuffer* first_depth = nullptr);

/// Returns the environment blurred for rough surfaces; without a map, its one colour.
const GpuImage& blurred_environment(Gpu& gpu, GpuScene& scene);

/// Makes light matrices, and shadow maps with undefined content.
void make_shadow_maps(Gpu& gpu, GpuScene& scene, const Scene& source);
/// Draws the shadow maps, with matrices updated for what moved.
void render_shadow_maps(Gpu& gpu, GpuScene& scene, const Scene& source);

} // namespace ssrlab
