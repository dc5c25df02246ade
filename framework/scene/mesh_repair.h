// What files leave out or get wrong: bad triangles, missing normals, missing tangents.
#pragma once

#include "scene/model.h"

#include <string>

namespace ssrlab {

/// Removes triangles with an unusable position or without area, and vertices that nothing uses. Returns how many had an unusable position; those
/// without area show nothing.
size_t drop_bad_triangles(Mesh& mesh);
/// What to warn of them.
std::string dropped_triangles_text(size_t count);

/// Vertices that are equal in every bit become one.
void weld_equal_vertices(Mesh& mesh);

/// Flips triangles whose winding contradicts their vertex normals: exporters care for the normals only.
void turn_fronts_to_normals(Mesh& mesh);

/// One normal per triangle, as glTF asks for when a mesh has none.
void make_flat_normals(Mesh& mesh);

/// Normals averaged by area over the triangles that meet at a position, where they turn by less than `crease_deg`.
/// Vertices are told apart by position, not by index: scanned models repeat or share them as they like.
void make_smooth_normals(Mesh& mesh, double crease_deg);

/// Tangents along the u direction of `uv_set`, after Lengyel 2001, "Computing Tangent Space Basis Vectors".
void make_tangents(Mesh& mesh, int uv_set);

/// Replaces attribute values that are not finite, and normals that are not unit vectors.
void clean_attributes(Mesh& mesh);

} // namespace ssrlab
