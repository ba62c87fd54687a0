// Vectors for the kernels with SSE4.2: pairs of registers. Included inside the namespace of an instruction set. IEEE
// operations only, so that every lane computes what the scalar expression computes.

struct Float8 {
    __m128 lo, hi;
    static Float8 load(const float* p) { return {_mm_load_ps(p), _mm_load_ps(p + 4)}; }
    static Float8 all(float x) { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
    static Float8 of_bytes(const uint8_t* p) {
        const __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(p));
        return {_mm_cvtepi32_ps(_mm_cvtepu8_epi32(bytes)),
                _mm_cvtepi32_ps(_mm_cvtepu8_epi32(_mm_srli_si128(bytes, 4)))};
    }
    void store(float* p) const { _mm_store_ps(p, lo), _mm_store_ps(p + 4, hi); }
};
inline Float8 operator+(Float8 a, Float8 b) { return {_mm_add_ps(a.lo, b.lo), _mm_add_ps(a.hi, b.hi)}; }
inline Float8 operator-(Float8 a, Float8 b) { return {_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)}; }
inline Float8 operator*(Float8 a, Float8 b) { return {_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)}; }
inline Float8 operator/(Float8 a, Float8 b) { return {_mm_div_ps(a.lo, b.lo), _mm_div_ps(a.hi, b.hi)}; }
/// a > b ? a : b and a < b ? a : b, also for NaN: b then.
inline Float8 larger(Float8 a, Float8 b) { return {_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)}; }
inline Float8 smaller(Float8 a, Float8 b) { return {_mm_min_ps(a.lo, b.lo), _mm_min_ps(a.hi, b.hi)}; }
inline Float8 magnitude(Float8 a) {
    const __m128 sign = _mm_set1_ps(-0.0f);
    return {_mm_andnot_ps(sign, a.lo), _mm_andnot_ps(sign, a.hi)};
}
/// Bit i where a <= b in lane i.
inline uint32_t at_most(Float8 a, Float8 b) {
    return static_cast<uint32_t>(_mm_movemask_ps(_mm_cmple_ps(a.lo, b.lo)) | _mm_movemask_ps(_mm_cmple_ps(a.hi, b.hi))
                                                                                 << 4);
}

struct Double4 {
    __m128d lo, hi;
    static Double4 of(Float4 a) { return {_mm_cvtps_pd(a.v), _mm_cvtps_pd(_mm_movehl_ps(a.v, a.v))}; }
    static Double4 of_floats(const float* p) { return of(Float4::load(p)); }
    static Double4 all(double x) { return {_mm_set1_pd(x), _mm_set1_pd(x)}; }
    void store(double* p) const { _mm_store_pd(p, lo), _mm_store_pd(p + 2, hi); }
};
inline Double4 operator+(Double4 a, Double4 b) { return {_mm_add_pd(a.lo, b.lo), _mm_add_pd(a.hi, b.hi)}; }
inline Double4 operator-(Double4 a, Double4 b) { return {_mm_sub_pd(a.lo, b.lo), _mm_sub_pd(a.hi, b.hi)}; }
inline Double4 operator*(Double4 a, Double4 b) { return {_mm_mul_pd(a.lo, b.lo), _mm_mul_pd(a.hi, b.hi)}; }
inline Double4 operator/(Double4 a, Double4 b) { return {_mm_div_pd(a.lo, b.lo), _mm_div_pd(a.hi, b.hi)}; }
inline Float4 four(float a, float b, float c, float d) { return {_mm_setr_ps(a, b, c, d)}; }
inline Float4 to_floats(Double4 a) { return {_mm_movelh_ps(_mm_cvtpd_ps(a.lo), _mm_cvtpd_ps(a.hi))}; }
inline Double4 larger(Double4 a, Double4 b) { return {_mm_max_pd(a.lo, b.lo), _mm_max_pd(a.hi, b.hi)}; }
inline Double4 smaller(Double4 a, Double4 b) { return {_mm_min_pd(a.lo, b.lo), _mm_min_pd(a.hi, b.hi)}; }
/// Bit i where a >= 0, or a <= 0, in lane i.
inline uint32_t not_negative(Double4 a) {
    const __m128d zero = _mm_setzero_pd();
    return static_cast<uint32_t>(_mm_movemask_pd(_mm_cmpge_pd(a.lo, zero)) | _mm_movemask_pd(_mm_cmpge_pd(a.hi, zero))
                                                                                 << 2);
}
inline uint32_t not_positive(Double4 a) {
    const __m128d zero = _mm_setzero_pd();
    return static_cast<uint32_t>(_mm_movemask_pd(_mm_cmple_pd(a.lo, zero)) | _mm_movemask_pd(_mm_cmple_pd(a.hi, zero))
                                                                                 << 2);
}

#include "accel/kernels/float16_pair.inl"
#include "accel/kernels/generic_lanes.inl"
