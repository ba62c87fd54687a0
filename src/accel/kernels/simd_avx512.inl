// Vectors for the kernels with AVX-512 (VL), still eight floats wide. Included inside the namespace of an instruction
// set. IEEE operations only, so that every lane computes what the scalar expression computes.

struct Float8 {
    __m256 v;
    static Float8 load(const float* p) { return {_mm256_load_ps(p)}; }
    static Float8 all(float x) { return {_mm256_set1_ps(x)}; }
    static Float8 of_bytes(const uint8_t* p) {
        return {_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p))))};
    }
    void store(float* p) const { _mm256_store_ps(p, v); }
};
inline Float8 operator+(Float8 a, Float8 b) { return {_mm256_add_ps(a.v, b.v)}; }
inline Float8 operator-(Float8 a, Float8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
inline Float8 operator*(Float8 a, Float8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
inline Float8 operator/(Float8 a, Float8 b) { return {_mm256_div_ps(a.v, b.v)}; }
/// a > b ? a : b and a < b ? a : b, also for NaN: b then.
inline Float8 larger(Float8 a, Float8 b) { return {_mm256_max_ps(a.v, b.v)}; }
inline Float8 smaller(Float8 a, Float8 b) { return {_mm256_min_ps(a.v, b.v)}; }
inline Float8 magnitude(Float8 a) { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)}; }
/// from[places[i]] in lane i, out of sixteen.
inline Float8 pick(const float* from, const uint32_t* places) {
    const __m256i at = _mm256_load_si256(reinterpret_cast<const __m256i*>(places));
    return {_mm256_permutex2var_ps(_mm256_load_ps(from), at, _mm256_load_ps(from + 8))};
}
/// Bit i where a <= b in lane i.
inline uint32_t at_most(Float8 a, Float8 b) { return _mm256_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ); }

/// Where the bit is set a, else b.
inline Float8 select(uint32_t bits, Float8 a, Float8 b) {
    return {_mm256_mask_blend_ps(static_cast<__mmask8>(bits), b.v, a.v)};
}
/// Writes the value where the bit is set.
inline void set_where(uint32_t bits, uint32_t value, uint32_t* eight) {
    _mm256_mask_storeu_epi32(eight, static_cast<__mmask8>(bits), _mm256_set1_epi32(static_cast<int>(value)));
}

struct Double4 {
    __m256d v;
    static Double4 of(Float4 a) { return {_mm256_cvtps_pd(a.v)}; }
    static Double4 of_floats(const float* p) { return {_mm256_cvtps_pd(_mm_load_ps(p))}; }
    static Double4 all(double x) { return {_mm256_set1_pd(x)}; }
    void store(double* p) const { _mm256_store_pd(p, v); }
};
inline Double4 operator+(Double4 a, Double4 b) { return {_mm256_add_pd(a.v, b.v)}; }
inline Double4 operator-(Double4 a, Double4 b) { return {_mm256_sub_pd(a.v, b.v)}; }
inline Double4 operator*(Double4 a, Double4 b) { return {_mm256_mul_pd(a.v, b.v)}; }
inline Double4 operator/(Double4 a, Double4 b) { return {_mm256_div_pd(a.v, b.v)}; }
inline Float4 to_floats(Double4 a) { return {_mm256_cvtpd_ps(a.v)}; }
inline Double4 larger(Double4 a, Double4 b) { return {_mm256_max_pd(a.v, b.v)}; }
inline Double4 smaller(Double4 a, Double4 b) { return {_mm256_min_pd(a.v, b.v)}; }
/// Bit i where a >= 0, or a <= 0, in lane i.
inline uint32_t not_negative(Double4 a) { return _mm256_cmp_pd_mask(a.v, _mm256_setzero_pd(), _CMP_GE_OQ); }
inline uint32_t not_positive(Double4 a) { return _mm256_cmp_pd_mask(a.v, _mm256_setzero_pd(), _CMP_LE_OQ); }

#include "accel/kernels/avx_lanes.inl"

/// Eight words.
struct Words8 {
    __m256i v;
    static Words8 none() { return {_mm256_setzero_si256()}; }
    static Words8 load(const uint32_t* p) { return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p))}; }
    /// Sets a bit where a <= b.
    void set_where_at_most(Float8 a, Float8 b, uint32_t bit) {
        v = _mm256_mask_or_epi32(v, _mm256_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ), v,
                                 _mm256_set1_epi32(static_cast<int>(1u << bit)));
    }
    /// Those whose bits are set, 0 in the place of others.
    Words8 only(uint32_t lanes) const { return {_mm256_maskz_mov_epi32(static_cast<__mmask8>(lanes), v)}; }
    /// A bit for each that is not 0.
    uint32_t some() const { return _mm256_test_epi32_mask(v, v); }
    /// Those whose bits are set, one after the other. Writes eight.
    void pack(uint32_t lanes, uint32_t* to) const {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                            _mm256_maskz_compress_epi32(static_cast<__mmask8>(lanes), v));
    }
};
inline Words8 operator|(Words8 a, Words8 b) { return {_mm256_or_si256(a.v, b.v)}; }
/// A bit for each whose highest bit is set.
inline uint32_t top_bits(Words8 a) { return _mm256_movepi32_mask(a.v); }

/// at_most(in, out) for the children of a node, each at its place in the order from far to near.
template <class AnyNode>
inline uint32_t ordered_at_most(Float8 in, Float8 out, const AnyNode& node, uint32_t octant_shift) {
    const __m256i lane = lanes_in_order(node, octant_shift);
    return at_most({_mm256_permutexvar_ps(lane, in.v)}, {_mm256_permutexvar_ps(lane, out.v)}) & present_in_order(node);
}

/// Pushes the children that are met (in <= out, in <= limit) with their t_in, from far to near; returns their number.
/// Writes up to kWidth entries, whatever the number.
template <class AnyNode>
inline uint32_t push_met(Float8 in, Float8 out, float limit, const AnyNode& node, uint32_t octant_shift, float* t_in,
                         uint32_t* ref) {
    const __m256i child = _mm256_load_si256(reinterpret_cast<const __m256i*>(node.child));
    const __m256i lane = lanes_in_order(node, octant_shift);
    const __m256 ordered = _mm256_permutexvar_ps(lane, in.v);
    const __mmask8 below = _mm256_cmp_ps_mask(ordered, _mm256_set1_ps(limit), _CMP_LE_OQ);
    const __mmask8 met = _mm256_mask_cmp_ps_mask(static_cast<__mmask8>(below & present_in_order(node)), ordered,
                                                 _mm256_permutexvar_ps(lane, out.v), _CMP_LE_OQ);
    _mm256_storeu_ps(t_in, _mm256_maskz_compress_ps(met, ordered));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(ref),
                        _mm256_maskz_compress_epi32(met, _mm256_permutexvar_epi32(lane, child)));
    return static_cast<uint32_t>(__builtin_popcount(met));
}
/// Pushes the children whose bits are set, in no particular order; returns their number. Writes kWidth entries.
template <class AnyNode>
inline uint32_t push_met(uint32_t met, const AnyNode& node, uint32_t* ref) {
    met &= present(node);
    const __m256i child = _mm256_load_si256(reinterpret_cast<const __m256i*>(node.child));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(ref),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(met), child));
    return static_cast<uint32_t>(__builtin_popcount(met));
}

struct Float16 {
    __m512 v;
    static Float16 load(const float* p) { return {_mm512_load_ps(p)}; }
    static Float16 all(float x) { return {_mm512_set1_ps(x)}; }
    void store(float* p) const { _mm512_store_ps(p, v); }
};
inline Float16 operator+(Float16 a, Float16 b) { return {_mm512_add_ps(a.v, b.v)}; }
inline Float16 operator-(Float16 a, Float16 b) { return {_mm512_sub_ps(a.v, b.v)}; }
inline Float16 operator*(Float16 a, Float16 b) { return {_mm512_mul_ps(a.v, b.v)}; }
inline Float16 operator/(Float16 a, Float16 b) { return {_mm512_div_ps(a.v, b.v)}; }
inline Float16 magnitude(Float16 a) { return {_mm512_abs_ps(a.v)}; }
/// Of all lanes, none of which is NaN.
inline float least(Float16 a) { return _mm512_reduce_min_ps(a.v); }
inline float largest(Float16 a) { return _mm512_reduce_max_ps(a.v); }
inline Float16 larger(Float16 a, Float16 b) { return {_mm512_max_ps(a.v, b.v)}; }
inline Float16 smaller(Float16 a, Float16 b) { return {_mm512_min_ps(a.v, b.v)}; }
inline uint32_t at_most(Float16 a, Float16 b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ); }

struct Double8 {
    __m512d v;
    static Double8 of(Float8 a) { return {_mm512_cvtps_pd(a.v)}; }
    static Double8 all(double x) { return {_mm512_set1_pd(x)}; }
    void store(double* p) const { _mm512_store_pd(p, v); }
};
inline Double8 operator+(Double8 a, Double8 b) { return {_mm512_add_pd(a.v, b.v)}; }
inline Double8 operator-(Double8 a, Double8 b) { return {_mm512_sub_pd(a.v, b.v)}; }
inline Double8 operator*(Double8 a, Double8 b) { return {_mm512_mul_pd(a.v, b.v)}; }
inline Double8 operator/(Double8 a, Double8 b) { return {_mm512_div_pd(a.v, b.v)}; }
inline Float8 to_floats(Double8 a) { return {_mm512_cvtpd_ps(a.v)}; }
inline Double8 larger(Double8 a, Double8 b) { return {_mm512_max_pd(a.v, b.v)}; }
inline Double8 smaller(Double8 a, Double8 b) { return {_mm512_min_pd(a.v, b.v)}; }
inline uint32_t not_negative(Double8 a) { return _mm512_cmp_pd_mask(a.v, _mm512_setzero_pd(), _CMP_GE_OQ); }
inline uint32_t not_positive(Double8 a) { return _mm512_cmp_pd_mask(a.v, _mm512_setzero_pd(), _CMP_LE_OQ); }

/// What packets test triangles in: as many rays at a time as there are doubles in a register.
using Doubles = Double8;
using Floats = Float8;
inline constexpr uint32_t kGroup = 8;

/// from[lane][offset] in every lane.
inline Float8 gathered(const float* const* from, ptrdiff_t offset) {
    return {_mm256_set_m128(gathered4(from + 4, offset).v, gathered4(from, offset).v)};
}
