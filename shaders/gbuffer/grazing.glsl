// Fresnel's reflectance at grazing angles. Below 2 % nothing reflects at normal incidence: such a value says that there is no reflection.
float grazing_reflectance(vec3 f0) { return min(1.0, 50.0 * max(max(f0.r, f0.g), f0.b)); }
