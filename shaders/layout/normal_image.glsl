// The normal of each pixel.
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D normal_image; // xyz = view-space normal, w = roughness
