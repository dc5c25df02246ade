// The directional albedo of a GGX surface, as the split-sum (DFG) table for shaders/passes/directional_albedo.glsl.
#pragma once

#include "gpu/resources.h"

#include <glm/glm.hpp>

#include <vector>

namespace ssrlab {

/// Returns the table: roughness by row, square root of the cosine by column, DFG_TABLE_ENTRIES of each from 0 to 1.
/// A surface with reflectance f0 at normal incidence has the directional albedo f0 * x + y.
const std::vector<glm::vec2>& dfg_table();

struct SampledTable {
    GpuImage          image; // RG16F
    vk::raii::Sampler sampler = nullptr;
};
/// Uploads dfg_table(), with a linear sampler.
SampledTable upload_dfg_table(Gpu& gpu);

} // namespace ssrlab
