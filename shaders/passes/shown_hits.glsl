// After trace/hit_list.glsl and pass/parameters.
// Does a ray bring back the light of a surface? One that stopped met the unseen side of something; the side that is seen may stand for it.
bool shows_surface(PackedHit found)
{
    int status = unpack_status(found.pixel);
    return status == TRACE_HIT || (stopped_shows_front && status == TRACE_STOPPED);
}
