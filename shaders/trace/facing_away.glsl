// Has the ray met a surface from behind, and passed?
bool met_facing_away = false;
