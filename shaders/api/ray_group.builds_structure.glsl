// Its passes have it from api/group_lanes.glsl.
