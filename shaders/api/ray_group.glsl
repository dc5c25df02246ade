// per = "ray_group": of this invocation; a pass per ray group includes api/group_lanes.glsl.
int ray_group() { return int(work_group()); }
