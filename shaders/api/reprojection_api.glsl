// All that the author of a reprojection strategy reads (docs/explanation/motion.md): where was, in the frame before, what a pixel reflects now?
// reproject.glsl defines
//     Reprojected reproject(Reflection now)
// Positions on the image are in pixels and without the jitter of either frame. _vs is this frame's view space, _pvs that of the frame before.

// One ray that hit.
struct Reflection
{
    vec2  incidence_px;        // where the ray started
    vec2  incidence_motion_px; // where that surface was in the frame before, minus where it is; NaN: behind the camera
    vec3  incidence_vs;
    vec3  incidence_pvs;       // the same point of the surface in the frame before, carried there by camera and object
    vec2  hit_px;              // where the ray hit, and the surface there
    vec2  hit_motion_px;
    vec3  hit_vs;
    vec3  hit_pvs;             // as incidence_pvs
    vec3  normal_vs;           // of the mirror in which the eye sees the hit: the reflector's, or one drawn from a rough one's lobe; unit length
    vec3  normal_pvs;          // the same normal in the frame before: turned with the camera and with the reflector
    float ray_length_m;        // from incidence to hit
};

// Where the reflection was; px is undefined unless `seen`.
struct Reprojected
{
    bool seen;
    vec2 px;
};

Reprojected unseen() { return Reprojected(false, vec2(0)); }

// What is not a finite number counts as unseen.
Reprojected seen_at(vec2 px) { return Reprojected(all(lessThan(abs(px), vec2(1e9))), px); }

vec2 pvs_to_px(vec3 position_pvs)
{
    vec2 slope = orthographic != 0 ? position_pvs.xy : position_pvs.xy / -position_pvs.z;
    return previous_centre_px + slope * previous_focal_px * vec2(1, -1);
}

// Where the previous view shows a point, if that lies in front of the camera.
Reprojected seen_at_pvs(vec3 position_pvs)
{
    if (orthographic == 0 && position_pvs.z >= 0.0) return unseen();
    return seen_at(pvs_to_px(position_pvs));
}

// The surface that the previous frame shows at a position, from its depth; false: it shows none there.
bool previous_surface(vec2 px, out vec3 position_pvs)
{
    float depth  = previous_depth(px);
    position_pvs = previous_px_to_pvs(vec3(px, depth));
    return depth > 0.0;
}

// T. Stachowiak and Y. Uludag 2015, Stochastic Screen-Space Reflections: the farther the reflected point, the less it moves.
vec2 parallax_corrected(vec2 motion_px, float ray_length_m, float factor)
{
    return motion_px * clamp(1.0 - ray_length_m * factor, 0.0, 1.0);
}
