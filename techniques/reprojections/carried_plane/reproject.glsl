Reprojected reproject(Reflection now)
{
    float eye_height = dot(now.normal_pvs, -now.incidence_pvs);
    float hit_height = dot(now.normal_pvs, now.hit_pvs - now.incidence_pvs);
    // On two sides of the plane they do not see each other in it.
    if (eye_height * hit_height <= 0.0) return unseen();
    // The eye sees the reflection where it sees the point's mirror image.
    return seen_at_pvs(now.hit_pvs - now.normal_pvs * (2.0 * hit_height));
}
