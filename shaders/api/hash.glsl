// PCG: M. Jarzynski and M. Olano 2020, Hash Functions for GPU Rendering.
uint pcg(uint value)
{
    uint state = value * 747796405u + 2891336453u;
    uint word  = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}
