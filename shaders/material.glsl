// Material lookup for passes that draw the scene.
layout(set = 0, binding = 1, scalar) readonly buffer Materials { Material materials[]; };
layout(set = 1, binding = 0) uniform sampler2D base_colour_texture;
layout(set = 1, binding = 1) uniform sampler2D metallic_roughness_texture;
layout(set = 1, binding = 2) uniform sampler2D normal_texture;
layout(set = 1, binding = 3) uniform sampler2D emissive_texture;

vec2 texture_uv(Material material, int use, vec4 uv)
{
    vec2 chosen = material.uv_set[use] == 0 ? uv.xy : uv.zw;
    return (material.uv_transform[use] * vec3(chosen, 1.0)).xy;
}

vec4 base_colour_of(Material material, vec4 uv, vec4 vertex_colour)
{
    return material.base_colour * vertex_colour * texture(base_colour_texture, texture_uv(material, 0, uv));
}
