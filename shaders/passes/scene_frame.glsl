// The beginning of gbuffer.frag's uniform Frame, for passes of frames that were drawn from a scene.
layout(set = 0, binding = 34, scalar) uniform Frame
{
    mat4 world_to_view;
    vec3 eye_ws;
    int  frame_orthographic;
    vec3 view_axis_ws;
};
