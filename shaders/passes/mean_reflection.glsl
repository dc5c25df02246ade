// The mean of reflections (colour and weight): colours count by their weight. sum: of each its colour times weight, and its weight.
// A weight of 1 stays 1, which a quotient does not promise: a GPU's may lie below (Vulkan 1.3, "Precision of Individual Operations"), and
// the environment would then be blended in.
float share_of(float part, float whole) { return part == whole ? 1.0 : part / whole; }

vec4 mean_reflection(vec4 sum, float total) { return sum.a > 0.0 ? vec4(sum.rgb / sum.a, share_of(sum.a, total)) : vec4(0); }
