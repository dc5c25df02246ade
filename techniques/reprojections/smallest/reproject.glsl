vec2 smaller(vec2 a, vec2 b)
{
    // A vector that is not a number loses every comparison.
    return dot(b, b) < dot(a, a) || !(dot(a, a) < 1e18) ? b : a;
}

Reprojected reproject(Reflection now)
{
    vec2 surface  = now.incidence_motion_px, hit = now.hit_motion_px;
    vec2 straight = smaller(surface, hit);
    vec2 parallax = smaller(parallax_corrected(surface, now.ray_length_m, factor), parallax_corrected(hit, now.ray_length_m, factor));
    return seen_at(now.incidence_px + smaller(straight, parallax));
}
