// Order and bounds of boxes. shaders/surfaces/README.md says what each answers.
// A front counts at its pixel's centre, and is level across it.
const bool level_fronts = true;
float front_above(Held held, vec2 gradient) { return held.front; }

// A number that is larger the nearer the back is: the depth itself, since a slab's back is monotone in its front.
float back_key(Held held, float depth) { return depth; }

// The key of a pixel whose back lies at that depth.
float key_of_back(float back) { return (back + float(slab_shift)) / (float(slab_scale) - back * float(slab_slope)); }

// Does a ray of this depth pass behind all pixels whose keys are at least this one?
bool passes_behind(real key, real z_near) { return !reaches_slab_back(key, z_near); }
