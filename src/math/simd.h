// Four floats at a time with the baseline instructions of each machine: IEEE operations only, so every lane computes
// what the scalar expression computes. On other machines plain loops do the same.
#pragma once

#include <cmath>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace steradian {

#if defined(__SSE2__)

struct Float4 {
    __m128 v;
    static Float4 load(const float* p) { return {_mm_load_ps(p)}; }
    static Float4 all(float x) { return {_mm_set1_ps(x)}; }
    void store(float* p) const { _mm_store_ps(p, v); }
    /// Towards zero; values must fit.
    void store_integers(uint32_t* p) const { _mm_store_si128(reinterpret_cast<__m128i*>(p), _mm_cvttps_epi32(v)); }
    /// The fourth lane becomes 0.
    Float4 first_three() const { return {_mm_and_ps(v, _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0)))}; }
};
/// x y + y z + z x
inline float half_area(Float4 e) {
    const __m128 p = _mm_mul_ps(e.v, _mm_shuffle_ps(e.v, e.v, _MM_SHUFFLE(3, 0, 2, 1)));
    const __m128 xy_yz = _mm_add_ss(p, _mm_shuffle_ps(p, p, 1));
    return _mm_cvtss_f32(_mm_add_ss(xy_yz, _mm_movehl_ps(p, p)));
}
inline Float4 operator+(Float4 a, Float4 b) { return {_mm_add_ps(a.v, b.v)}; }
inline Float4 operator-(Float4 a, Float4 b) { return {_mm_sub_ps(a.v, b.v)}; }
inline Float4 operator*(Float4 a, Float4 b) { return {_mm_mul_ps(a.v, b.v)}; }
/// a > b ? a : b and a < b ? a : b, also for NaN: b then.
inline Float4 larger(Float4 a, Float4 b) { return {_mm_max_ps(a.v, b.v)}; }
inline Float4 smaller(Float4 a, Float4 b) { return {_mm_min_ps(a.v, b.v)}; }
/// Bit i where a <= b in lane i.
inline uint32_t at_most(Float4 a, Float4 b) { return static_cast<uint32_t>(_mm_movemask_ps(_mm_cmple_ps(a.v, b.v))); }
inline Float4 operator/(Float4 a, Float4 b) { return {_mm_div_ps(a.v, b.v)}; }
inline Float4 sqrt(Float4 a) { return {_mm_sqrt_ps(a.v)}; }
inline Float4 abs(Float4 a) { return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.v)}; }

/// A yes or no for each lane.
struct Mask4 {
    __m128 v;
};
/// False where one is NaN.
inline Mask4 operator<(Float4 a, Float4 b) { return {_mm_cmplt_ps(a.v, b.v)}; }
inline Mask4 operator&&(Mask4 a, Mask4 b) { return {_mm_and_ps(a.v, b.v)}; }
inline Float4 select(Mask4 which, Float4 yes, Float4 no) {
    return {_mm_or_ps(_mm_and_ps(which.v, yes.v), _mm_andnot_ps(which.v, no.v))};
}

#elif defined(__aarch64__)

struct Float4 {
    float32x4_t v;
    static Float4 load(const float* p) { return {vld1q_f32(p)}; }
    static Float4 all(float x) { return {vdupq_n_f32(x)}; }
    void store(float* p) const { vst1q_f32(p, v); }
    void store_integers(uint32_t* p) const { vst1q_u32(p, vcvtq_u32_f32(v)); }
    Float4 first_three() const { return {vsetq_lane_f32(0.0f, v, 3)}; }
};
inline float half_area(Float4 e) {
    const float x = vgetq_lane_f32(e.v, 0), y = vgetq_lane_f32(e.v, 1), z = vgetq_lane_f32(e.v, 2);
    return x * y + y * z + z * x;
}
inline Float4 operator+(Float4 a, Float4 b) { return {vaddq_f32(a.v, b.v)}; }
inline Float4 operator-(Float4 a, Float4 b) { return {vsubq_f32(a.v, b.v)}; }
inline Float4 operator*(Float4 a, Float4 b) { return {vmulq_f32(a.v, b.v)}; }
inline Float4 larger(Float4 a, Float4 b) { return {vbslq_f32(vcgtq_f32(a.v, b.v), a.v, b.v)}; }
inline Float4 smaller(Float4 a, Float4 b) { return {vbslq_f32(vcltq_f32(a.v, b.v), a.v, b.v)}; }
inline uint32_t at_most(Float4 a, Float4 b) {
    static const uint32_t kLanes[4] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(vcleq_f32(a.v, b.v), vld1q_u32(kLanes)));
}
inline Float4 operator/(Float4 a, Float4 b) { return {vdivq_f32(a.v, b.v)}; }
inline Float4 sqrt(Float4 a) { return {vsqrtq_f32(a.v)}; }
inline Float4 abs(Float4 a) { return {vabsq_f32(a.v)}; }

struct Mask4 {
    uint32x4_t v;
};
inline Mask4 operator<(Float4 a, Float4 b) { return {vcltq_f32(a.v, b.v)}; }
inline Mask4 operator&&(Mask4 a, Mask4 b) { return {vandq_u32(a.v, b.v)}; }
inline Float4 select(Mask4 which, Float4 yes, Float4 no) { return {vbslq_f32(which.v, yes.v, no.v)}; }

#else

struct Float4 {
    float v[4];
    static Float4 load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
    static Float4 all(float x) { return {{x, x, x, x}}; }
    void store(float* p) const {
        for (int i = 0; i < 4; ++i) p[i] = v[i];
    }
    void store_integers(uint32_t* p) const {
        for (int i = 0; i < 4; ++i) p[i] = static_cast<uint32_t>(v[i]);
    }
    Float4 first_three() const { return {{v[0], v[1], v[2], 0}}; }
};
inline float half_area(Float4 e) { return e.v[0] * e.v[1] + e.v[1] * e.v[2] + e.v[2] * e.v[0]; }
template <class F>
inline Float4 per_lane(Float4 a, Float4 b, F f) {
    return {{f(a.v[0], b.v[0]), f(a.v[1], b.v[1]), f(a.v[2], b.v[2]), f(a.v[3], b.v[3])}};
}
inline Float4 operator+(Float4 a, Float4 b) {
    return per_lane(a, b, [](float x, float y) { return x + y; });
}
inline Float4 operator-(Float4 a, Float4 b) {
    return per_lane(a, b, [](float x, float y) { return x - y; });
}
inline Float4 operator*(Float4 a, Float4 b) {
    return per_lane(a, b, [](float x, float y) { return x * y; });
}
inline Float4 larger(Float4 a, Float4 b) {
    return per_lane(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline Float4 smaller(Float4 a, Float4 b) {
    return per_lane(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline uint32_t at_most(Float4 a, Float4 b) {
    uint32_t mask = 0;
    for (int i = 0; i < 4; ++i) mask |= uint32_t(a.v[i] <= b.v[i]) << i;
    return mask;
}
inline Float4 operator/(Float4 a, Float4 b) {
    return per_lane(a, b, [](float x, float y) { return x / y; });
}
inline Float4 sqrt(Float4 a) {
    return per_lane(a, a, [](float x, float) { return std::sqrt(x); });
}
inline Float4 abs(Float4 a) {
    return per_lane(a, a, [](float x, float) { return std::fabs(x); });
}

struct Mask4 {
    bool v[4];
};
inline Mask4 operator<(Float4 a, Float4 b) {
    return {{a.v[0] < b.v[0], a.v[1] < b.v[1], a.v[2] < b.v[2], a.v[3] < b.v[3]}};
}
inline Mask4 operator&&(Mask4 a, Mask4 b) {
    return {{a.v[0] && b.v[0], a.v[1] && b.v[1], a.v[2] && b.v[2], a.v[3] && b.v[3]}};
}
inline Float4 select(Mask4 which, Float4 yes, Float4 no) {
    Float4 out;
    for (int i = 0; i < 4; ++i) out.v[i] = which.v[i] ? yes.v[i] : no.v[i];
    return out;
}

#endif

}  // namespace steradian
