// The point of the plane below p, and how high p lies above it.
vec3 onto_plane(vec3 p, vec3 on_plane, vec3 normal, out float height)
{
    height = dot(normal, p - on_plane);
    return p - normal * height;
}

Reprojected reproject(Reflection now)
{
    vec3 incidence, hit;
    if (!previous_surface(now.incidence_px + now.incidence_motion_px, incidence)) return unseen();
    if (!previous_surface(now.hit_px + now.hit_motion_px, hit)) return unseen();
    float eye_height, hit_height;
    vec3  below_eye = onto_plane(vec3(0), incidence, now.normal_pvs, eye_height);
    vec3  below_hit = onto_plane(hit, incidence, now.normal_pvs, hit_height);
    // On two sides of the plane they do not see each other in it.
    if (eye_height * hit_height <= 0.0) return unseen();
    // An orthographic eye is infinitely far away: it sees the mirror image of the point.
    if (orthographic != 0) return seen_at_pvs(below_hit - now.normal_pvs * hit_height);
    // Equal angles make similar triangles: the heights divide the way between the two feet.
    return seen_at_pvs(mix(below_eye, below_hit, eye_height / (eye_height + hit_height)));
}
