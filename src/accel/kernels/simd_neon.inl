// Vectors for the kernels with NEON: pairs of registers. Included inside the namespace of an instruction set. IEEE
// operations only, so that every lane computes what the scalar expression computes.

struct Float8 {
    float32x4_t lo, hi;
    static Float8 load(const float* p) { return {vld1q_f32(p), vld1q_f32(p + 4)}; }
    static Float8 all(float x) { return {vdupq_n_f32(x), vdupq_n_f32(x)}; }
    static Float8 of_bytes(const uint8_t* p) {
        const uint16x8_t words = vmovl_u8(vld1_u8(p));
        return {vcvtq_f32_u32(vmovl_u16(vget_low_u16(words))), vcvtq_f32_u32(vmovl_high_u16(words))};
    }
    void store(float* p) const { vst1q_f32(p, lo), vst1q_f32(p + 4, hi); }
};
inline Float8 operator+(Float8 a, Float8 b) { return {vaddq_f32(a.lo, b.lo), vaddq_f32(a.hi, b.hi)}; }
inline Float8 operator-(Float8 a, Float8 b) { return {vsubq_f32(a.lo, b.lo), vsubq_f32(a.hi, b.hi)}; }
inline Float8 operator*(Float8 a, Float8 b) { return {vmulq_f32(a.lo, b.lo), vmulq_f32(a.hi, b.hi)}; }
inline Float8 operator/(Float8 a, Float8 b) { return {vdivq_f32(a.lo, b.lo), vdivq_f32(a.hi, b.hi)}; }
/// a > b ? a : b and a < b ? a : b, also for NaN: b then.
inline float32x4_t larger(float32x4_t a, float32x4_t b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
inline float32x4_t smaller(float32x4_t a, float32x4_t b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
inline Float8 larger(Float8 a, Float8 b) { return {larger(a.lo, b.lo), larger(a.hi, b.hi)}; }
inline Float8 smaller(Float8 a, Float8 b) { return {smaller(a.lo, b.lo), smaller(a.hi, b.hi)}; }
inline Float8 magnitude(Float8 a) { return {vabsq_f32(a.lo), vabsq_f32(a.hi)}; }
/// Bit i where a <= b in lane i.
inline uint32_t at_most(Float8 a, Float8 b) {
    static const uint32_t kBits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    const uint32x4_t lo = vandq_u32(vcleq_f32(a.lo, b.lo), vld1q_u32(kBits));
    const uint32x4_t hi = vandq_u32(vcleq_f32(a.hi, b.hi), vld1q_u32(kBits + 4));
    return vaddvq_u32(vorrq_u32(lo, hi));
}

struct Double4 {
    float64x2_t lo, hi;
    static Double4 of(Float4 a) { return {vcvt_f64_f32(vget_low_f32(a.v)), vcvt_high_f64_f32(a.v)}; }
    static Double4 of_floats(const float* p) { return of(Float4::load(p)); }
    static Double4 all(double x) { return {vdupq_n_f64(x), vdupq_n_f64(x)}; }
    void store(double* p) const { vst1q_f64(p, lo), vst1q_f64(p + 2, hi); }
};
inline Double4 operator+(Double4 a, Double4 b) { return {vaddq_f64(a.lo, b.lo), vaddq_f64(a.hi, b.hi)}; }
inline Double4 operator-(Double4 a, Double4 b) { return {vsubq_f64(a.lo, b.lo), vsubq_f64(a.hi, b.hi)}; }
inline Double4 operator*(Double4 a, Double4 b) { return {vmulq_f64(a.lo, b.lo), vmulq_f64(a.hi, b.hi)}; }
inline Double4 operator/(Double4 a, Double4 b) { return {vdivq_f64(a.lo, b.lo), vdivq_f64(a.hi, b.hi)}; }
inline Float4 four(float a, float b, float c, float d) {
    const float p[4] = {a, b, c, d};
    return {vld1q_f32(p)};
}
inline Float4 to_floats(Double4 a) { return {vcvt_high_f32_f64(vcvt_f32_f64(a.lo), a.hi)}; }
inline float64x2_t larger(float64x2_t a, float64x2_t b) { return vbslq_f64(vcgtq_f64(a, b), a, b); }
inline float64x2_t smaller(float64x2_t a, float64x2_t b) { return vbslq_f64(vcltq_f64(a, b), a, b); }
inline Double4 larger(Double4 a, Double4 b) { return {larger(a.lo, b.lo), larger(a.hi, b.hi)}; }
inline Double4 smaller(Double4 a, Double4 b) { return {smaller(a.lo, b.lo), smaller(a.hi, b.hi)}; }
inline uint32_t bits_of(uint64x2_t lo, uint64x2_t hi) {
    static const uint64_t kBits[4] = {1, 2, 4, 8};
    const uint64x2_t both = vorrq_u64(vandq_u64(lo, vld1q_u64(kBits)), vandq_u64(hi, vld1q_u64(kBits + 2)));
    return static_cast<uint32_t>(vaddvq_u64(both));
}
/// Bit i where a >= 0, or a <= 0, in lane i.
inline uint32_t not_negative(Double4 a) { return bits_of(vcgezq_f64(a.lo), vcgezq_f64(a.hi)); }
inline uint32_t not_positive(Double4 a) { return bits_of(vclezq_f64(a.lo), vclezq_f64(a.hi)); }

#include "accel/kernels/float16_pair.inl"
#include "accel/kernels/generic_lanes.inl"
