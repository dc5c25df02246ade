Reprojected reproject(Reflection now)
{
    return seen_at(now.incidence_px + now.hit_motion_px);
}
