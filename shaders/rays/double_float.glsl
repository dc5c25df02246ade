// Numbers of twice the precision, for the ray set-up: the sum x + y of two floats, y at most half of x's last place (T. J. Dekker 1971, A
// Floating-Point Technique for Extending the Available Precision; D. E. Knuth, The Art of Computer Programming 2, 4.2.2), or a double where
// those are cheap (-D WIDE_IS_DOUBLE) and in the double twin, which is what float is held to.
#include "api/real.glsl"

#if defined(REAL_IS_DOUBLE) || defined(WIDE_IS_DOUBLE)
#define wide double

wide widen(real high, real low) { return wide(high) + wide(low); }

real narrow(wide a) { return real(a); }

wide sum(wide a, wide b)
{
    precise wide result = a + b;
    return result;
}

wide product(wide a, wide b)
{
    precise wide result = a * b;
    return result;
}

wide quotient(wide a, wide b)
{
    precise wide result = a / b;
    return result;
}
#else
#define wide vec2

wide widen(float high, float low) { return wide(high, low); }

float narrow(wide a) { return a.x; }

wide exact_sum(float a, float b)
{
    precise float whole = a + b;
    precise float of_b  = whole - a;
    precise float rest  = (a - (whole - of_b)) + (b - of_b);
    return wide(whole, rest);
}

// |a| >= |b|
wide exact_sum_of_ordered(float a, float b)
{
    precise float whole = a + b;
    precise float rest  = b - (whole - a);
    return wide(whole, rest);
}

float upper_half(float a) { return uintBitsToFloat(floatBitsToUint(a) & 0xFFFFF000u); }

wide exact_product(float a, float b)
{
    precise float whole = a * b;
    precise float a_up = upper_half(a), b_up = upper_half(b), a_down = a - a_up, b_down = b - b_up;
    precise float rest = ((a_up * b_up - whole) + a_up * b_down + a_down * b_up) + a_down * b_down;
    return wide(whole, rest);
}

wide sum(wide a, wide b)
{
    wide          high = exact_sum(a.x, b.x);
    precise float low  = high.y + (a.y + b.y);
    return exact_sum_of_ordered(high.x, low);
}

wide product(wide a, wide b)
{
    wide          high = exact_product(a.x, b.x);
    precise float low  = high.y + (a.x * b.y + a.y * b.x);
    return exact_sum_of_ordered(high.x, low);
}

wide quotient(wide a, wide b)
{
    float high = a.x / b.x;
    wide  rest = sum(a, -product(b, wide(high, 0)));
    return exact_sum_of_ordered(high, rest.x / b.x);
}
#endif

wide widen(real a) { return widen(a, real(0)); }

struct Wide3
{
    wide x, y, z;
};

Wide3 widen(real3 v) { return Wide3(widen(v.x), widen(v.y), widen(v.z)); }

real3 narrow(Wide3 v) { return real3(narrow(v.x), narrow(v.y), narrow(v.z)); }

Wide3 scaled(wide factor, Wide3 v) { return Wide3(product(factor, v.x), product(factor, v.y), product(factor, v.z)); }

Wide3 sum(Wide3 a, Wide3 b) { return Wide3(sum(a.x, b.x), sum(a.y, b.y), sum(a.z, b.z)); }

wide inner_product(Wide3 a, Wide3 b) { return sum(sum(product(a.x, b.x), product(a.y, b.y)), product(a.z, b.z)); }
