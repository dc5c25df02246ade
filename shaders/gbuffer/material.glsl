// Material lookup for passes that draw the scene.
layout(set = 0, binding = 1, scalar) readonly buffer Materials { Material materials[]; };
layout(set = 1, binding = 0) uniform sampler2D base_colour_texture;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_texture;
layout(set = 1, binding = 2) uniform sampler2D normal_texture;
layout(set = 1, binding = 3) uniform sampler2D emissive_texture;

// Texture coordinates of both sets with their screen derivatives. Derivatives are taken before anything is read from a buffer:
// some drivers load zeros in the pixels beside a triangle's edge, and the wrong mip level would show as a dotted line.
struct Coordinates
{
    vec4 uv, dx, dy;
};

Coordinates coordinates_of(vec4 uv)
{
    return Coordinates(uv, dFdx(uv), dFdy(uv));
}

vec4 sample_texture(sampler2D image, Material material, int use, Coordinates at)
{
    bool first     = material.uv_set[use] == 0;
    mat3 transform = material.uv_transform[use];
    vec2 uv        = (transform * vec3(first ? at.uv.xy : at.uv.zw, 1.0)).xy;
    vec2 dx        = (transform * vec3(first ? at.dx.xy : at.dx.zw, 0.0)).xy;
    vec2 dy        = (transform * vec3(first ? at.dy.xy : at.dy.zw, 0.0)).xy;
    return textureGrad(image, uv, dx, dy);
}

vec4 base_colour_of(Material material, Coordinates at, vec4 vertex_colour)
{
    return material.base_colour * vertex_colour * sample_texture(base_colour_texture, material, 0, at);
}

// Interpolation rounds: an alpha of 1 at all corners may be a bit less between them. Alphas in files differ by 1/255.
bool is_cut_out(Material material, float alpha)
{
    const float rounding = 1.0 / 65536.0;
    return material.alpha_cutoff >= 0.0 && alpha < material.alpha_cutoff - rounding;
}
