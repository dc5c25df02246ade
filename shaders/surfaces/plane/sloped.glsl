// Order and bounds of what slopes with its pixel's plane. shaders/surfaces/README.md says what each answers.
// The most that the pixel holds above a plane of this gradient through 0 at its centre.
const bool level_fronts = false;
float front_above(Held held, vec2 gradient) { return held.front + dot(abs(held.gradient - gradient), vec2(held_reach_px)); }

// A number that is larger the nearer the back is: the depth of the back, at its farthest.
float back_key(Held held, float depth) { return held.back - (abs(held.gradient.x) + abs(held.gradient.y)) * held_reach_px; }

float key_of_back(float back) { return back; }

bool passes_behind(real key, real z_near) { return z_near < key; }
