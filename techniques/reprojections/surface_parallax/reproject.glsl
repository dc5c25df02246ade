Reprojected reproject(Reflection now)
{
    return seen_at(now.incidence_px + parallax_corrected(now.incidence_motion_px, now.ray_length_m, factor));
}
