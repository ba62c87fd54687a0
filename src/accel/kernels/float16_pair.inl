// Sixteen floats where no register has as many.

/// Sixteen floats as two halves.
struct Float16 {
    Float8 lo, hi;
    static Float16 load(const float* p) { return {Float8::load(p), Float8::load(p + 8)}; }
    static Float16 all(float x) { return {Float8::all(x), Float8::all(x)}; }
    void store(float* p) const { lo.store(p), hi.store(p + 8); }
};
inline Float16 operator+(Float16 a, Float16 b) { return {a.lo + b.lo, a.hi + b.hi}; }
inline Float16 operator-(Float16 a, Float16 b) { return {a.lo - b.lo, a.hi - b.hi}; }
inline Float16 operator*(Float16 a, Float16 b) { return {a.lo * b.lo, a.hi * b.hi}; }
inline Float16 larger(Float16 a, Float16 b) { return {larger(a.lo, b.lo), larger(a.hi, b.hi)}; }
inline Float16 smaller(Float16 a, Float16 b) { return {smaller(a.lo, b.lo), smaller(a.hi, b.hi)}; }
inline uint32_t at_most(Float16 a, Float16 b) { return at_most(a.lo, b.lo) | at_most(a.hi, b.hi) << 8; }
inline Float16 operator/(Float16 a, Float16 b) { return {a.lo / b.lo, a.hi / b.hi}; }
inline Float16 magnitude(Float16 a) { return {magnitude(a.lo), magnitude(a.hi)}; }
/// Of all lanes, none of which is NaN.
inline float least(Float16 a) {
    alignas(32) float v[8];
    smaller(a.lo, a.hi).store(v);
    float out = v[0];
    for (int i = 1; i < 8; ++i) out = min_of(v[i], out);
    return out;
}
inline float largest(Float16 a) {
    alignas(32) float v[8];
    larger(a.lo, a.hi).store(v);
    float out = v[0];
    for (int i = 1; i < 8; ++i) out = max_of(v[i], out);
    return out;
}

/// What packets test triangles in: as many rays at a time as there are doubles in a register, or four.
using Doubles = Double4;
using Floats = Float4;
inline constexpr uint32_t kGroup = 4;
