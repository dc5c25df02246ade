// Rounded outward.
float held_front(float depth)
{
    float front = float(slab_front(real(depth)));
    return front + (abs(front) * held_margin + abs(float(slab_shift)) * held_margin);
}
