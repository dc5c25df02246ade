// How much of a reflector's colour its reflection is: beta = metallic^exponent * weight of the reflection.
// J. Somerville Roberts, "Screen Space Reflections".
float beta_of(ivec2 reflector, float weight)
{
    if (weight <= 0.0) return 0.0;
    float metallic = imageLoad(material_image, reflector).a;
    return (metallic_exponent > 0.0 ? pow(metallic, metallic_exponent) : 1.0) * weight;
}
