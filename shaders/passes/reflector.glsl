// A pixel as a rough reflector. After rays/reflecting.glsl and pass/parameters.
#include "passes/camera.glsl"

struct Reflector
{
    vec3  position_vs, normal_vs, to_eye_vs;
    float alpha;
};

Reflector reflector_at(ivec2 pixel)
{
    vec4      stored = imageLoad(normal_image, pixel);
    Reflector own;
    own.position_vs = px_to_vs(vec3(vec2(pixel) + 0.5, load_depth(pixel)));
    own.to_eye_vs   = to_camera_vs(own.position_vs);
    own.normal_vs   = normalize(stored.xyz);
    own.normal_vs   = dot(own.normal_vs, own.to_eye_vs) < 0.0 ? -own.normal_vs : own.normal_vs;
    own.alpha       = stored.w * stored.w;
    return own;
}
