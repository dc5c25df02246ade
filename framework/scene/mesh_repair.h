// Repairs what files leave out or get wrong: bad triangles, missing normals, missing tangents.
#pragma once

#include "scene/model.h"

#include <string>

namespace ssrlab {

/// Removes unused vertices and triangles without area or with an unusable position. Returns how many had an unusable
/// position.
size_t drop_bad_triangles(Mesh& mesh);
/// Returns the warnings about them.
std::string dropped_triangles_text(size_t count);

/// Merges vertices that are equal in every bit.
void weld_equal_vertices(Mesh& mesh);

/// Flips triangles whose winding contradicts their vertex normals; some exporters get only the normals right.
void turn_fronts_to_normals(Mesh& mesh);

/// Gives each triangle one normal, as glTF asks for meshes without normals.
void make_flat_normals(Mesh& mesh);

/// Averages normals by area over the triangles that meet at a position, where they turn by less than `crease_deg`.
/// Compares positions rather than indices, since scanned models repeat or share vertices arbitrarily.
void make_smooth_normals(Mesh& mesh, double crease_deg);

/// Gives vertices without a tangent one along the u direction of `uv_set` after `uv_transform`, with bitangents against
/// v, as glTF has them. After Lengyel 2001, "Computing Tangent Space Basis Vectors". Returns how many.
size_t make_tangents(Mesh& mesh, int uv_set, const glm::mat3& uv_transform);

/// Gives corners whose normal is zero or not finite that of their triangle. Returns how many there were.
size_t replace_bad_normals(Mesh& mesh);

/// Replaces attribute values that are not finite; makes normals unit vectors, which must have a direction; makes
/// tangents that have none across the normal zero.
void clean_attributes(Mesh& mesh);

} // namespace ssrlab
