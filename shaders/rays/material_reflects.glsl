// Which materials reflect: metals, and what reflects enough at normal incidence and is smooth enough. After
// dielectric_min_f0 and dielectric_max_roughness. core/trace_image.h compares the same floats. A macro reads no image in
// vain.
#define MATERIAL_REFLECTS(metallic, dielectric_f0, roughness) \
    ((metallic) > 0.0 || ((dielectric_f0) >= dielectric_min_f0 && (roughness) <= dielectric_max_roughness))
