// Clamps what the frames before hold of a pixel to what the pixels around it hold now. After pass/parameters.

vec4 clamped_to(vec4 around[9], int count, vec4 value)
{
    vec4 low = vec4(1e30), high = vec4(-1e30), sum = vec4(0), squares = vec4(0);
    for (int i = 0; i < count; ++i)
    {
        low  = min(low, around[i]);
        high = max(high, around[i]);
        sum += around[i];
        squares += around[i] * around[i];
    }
    if (history_clamping == history_clamping_minmax) return clamp(value, low, high);
    vec4 mean = sum / float(count), deviation = sqrt(max(squares / float(count) - mean * mean, 0.0)) * clamping_deviations;
    return clamp(value, mean - deviation, mean + deviation);
}
