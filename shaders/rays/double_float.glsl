// Numbers of twice the precision, for the ray set-up: the sum x + y of two floats, y at most half of x's last place (T. J. Dekker 1971, A
// Floating-Point Technique for Extending the Available Precision; D. E. Knuth, The Art of Computer Programming 2, 4.2.2), or a double where
// those are cheap (-D DF64_IS_DOUBLE) and in the double twin, which is what float is held to.
#include "api/real.glsl"

#if defined(REAL_IS_DOUBLE) || defined(DF64_IS_DOUBLE)
#define df64 double

df64 to_df64(real high, real low) { return df64(high) + df64(low); }

real to_real(df64 a) { return real(a); }

df64 sum(df64 a, df64 b)
{
    precise df64 result = a + b;
    return result;
}

df64 product(df64 a, df64 b)
{
    precise df64 result = a * b;
    return result;
}

df64 quotient(df64 a, df64 b)
{
    precise df64 result = a / b;
    return result;
}
#else
#define df64 vec2

df64 to_df64(float high, float low) { return df64(high, low); }

float to_real(df64 a) { return a.x; }

df64 exact_sum(float a, float b)
{
    precise float whole = a + b;
    precise float of_b  = whole - a;
    precise float rest  = (a - (whole - of_b)) + (b - of_b);
    return df64(whole, rest);
}

// |a| >= |b|
df64 exact_sum_of_ordered(float a, float b)
{
    precise float whole = a + b;
    precise float rest  = b - (whole - a);
    return df64(whole, rest);
}

float upper_half(float a) { return uintBitsToFloat(floatBitsToUint(a) & 0xFFFFF000u); }

df64 exact_product(float a, float b)
{
    precise float whole = a * b;
    precise float a_up = upper_half(a), b_up = upper_half(b), a_down = a - a_up, b_down = b - b_up;
    precise float rest = ((a_up * b_up - whole) + a_up * b_down + a_down * b_up) + a_down * b_down;
    return df64(whole, rest);
}

df64 sum(df64 a, df64 b)
{
    df64          high = exact_sum(a.x, b.x);
    precise float low  = high.y + (a.y + b.y);
    return exact_sum_of_ordered(high.x, low);
}

df64 product(df64 a, df64 b)
{
    df64          high = exact_product(a.x, b.x);
    precise float low  = high.y + (a.x * b.y + a.y * b.x);
    return exact_sum_of_ordered(high.x, low);
}

df64 quotient(df64 a, df64 b)
{
    float high = a.x / b.x;
    df64  rest = sum(a, -product(b, df64(high, 0)));
    return exact_sum_of_ordered(high, rest.x / b.x);
}
#endif

df64 to_df64(real a) { return to_df64(a, real(0)); }

struct Df64x3
{
    df64 x, y, z;
};

Df64x3 to_df64(real3 v) { return Df64x3(to_df64(v.x), to_df64(v.y), to_df64(v.z)); }

real3 to_real(Df64x3 v) { return real3(to_real(v.x), to_real(v.y), to_real(v.z)); }

Df64x3 scaled(df64 factor, Df64x3 v) { return Df64x3(product(factor, v.x), product(factor, v.y), product(factor, v.z)); }

Df64x3 sum(Df64x3 a, Df64x3 b) { return Df64x3(sum(a.x, b.x), sum(a.y, b.y), sum(a.z, b.z)); }

df64 inner_product(Df64x3 a, Df64x3 b) { return sum(sum(product(a.x, b.x), product(a.y, b.y)), product(a.z, b.z)); }
