Reprojected reproject(Reflection now)
{
    return seen_at(now.incidence_px + parallax_corrected(now.hit_motion_px, now.ray_length_m, factor));
}
