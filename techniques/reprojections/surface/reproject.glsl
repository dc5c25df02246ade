Reprojected reproject(Reflection now)
{
    return seen_at(now.incidence_px + now.incidence_motion_px);
}
