// No material of the scene has an alpha mask.
bool passes_mask(uint first_index, uint material, vec2 barycentric) { return true; }
