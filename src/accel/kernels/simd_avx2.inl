// Vectors for the kernels with AVX2. Included inside the namespace of an instruction set. IEEE operations only, so that
// every lane computes what the scalar expression computes.

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
    const __m256 low = _mm256_permutevar8x32_ps(_mm256_load_ps(from), at);
    const __m256 high = _mm256_permutevar8x32_ps(_mm256_load_ps(from + 8), at);
    return {_mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(at, 28)))};
}
/// Bit i where a <= b in lane i.
inline uint32_t at_most(Float8 a, Float8 b) {
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}

inline __m256i lanes_of(uint32_t bits) {
    const __m256i own = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), own), own);
}
/// Where the bit is set a, else b.
inline Float8 select(uint32_t bits, Float8 a, Float8 b) {
    return {_mm256_blendv_ps(b.v, a.v, _mm256_castsi256_ps(lanes_of(bits)))};
}
/// Writes the value where the bit is set.
inline void set_where(uint32_t bits, uint32_t value, uint32_t* eight) {
    _mm256_maskstore_epi32(reinterpret_cast<int*>(eight), lanes_of(bits), _mm256_set1_epi32(static_cast<int>(value)));
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
inline uint32_t not_negative(Double4 a) {
    return static_cast<uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, _mm256_setzero_pd(), _CMP_GE_OQ)));
}
inline uint32_t not_positive(Double4 a) {
    return static_cast<uint32_t>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, _mm256_setzero_pd(), _CMP_LE_OQ)));
}

/// The places of the set bits, in the first lanes.
inline __m256i places_of(uint32_t bits) {
    const uint64_t bytes = _pext_u64(0x0706050403020100u, _pdep_u64(bits, 0x0101010101010101u) * 0xffu);
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(bytes)));
}

#include "accel/kernels/avx_lanes.inl"

/// Eight words.
struct Words8 {
    __m256i v;
    static Words8 none() { return {_mm256_setzero_si256()}; }
    static Words8 load(const uint32_t* p) { return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p))}; }
    /// Sets a bit where a <= b.
    void set_where_at_most(Float8 a, Float8 b, uint32_t bit) {
        const __m256i where = _mm256_castps_si256(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ));
        v = _mm256_or_si256(v, _mm256_and_si256(where, _mm256_set1_epi32(static_cast<int>(1u << bit))));
    }
    /// Those whose bits are set, 0 in the place of others.
    Words8 only(uint32_t lanes) const { return {_mm256_and_si256(v, lanes_of(lanes))}; }
    /// A bit for each that is not 0.
    uint32_t some() const { return ~top_bits_of(_mm256_cmpeq_epi32(v, _mm256_setzero_si256())) & 255; }
    /// Those whose bits are set, one after the other. Writes eight.
    void pack(uint32_t lanes, uint32_t* to) const {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(v, places_of(lanes)));
    }
    static uint32_t top_bits_of(__m256i a) { return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(a))); }
};
inline Words8 operator|(Words8 a, Words8 b) { return {_mm256_or_si256(a.v, b.v)}; }
/// A bit for each whose highest bit is set.
inline uint32_t top_bits(Words8 a) { return Words8::top_bits_of(a.v); }

/// at_most(in, out) for the children of a node, each at its place in the order from far to near.
template <class AnyNode>
inline uint32_t ordered_at_most(Float8 in, Float8 out, const AnyNode& node, uint32_t octant_shift) {
    const __m256i lane = lanes_in_order(node, octant_shift);
    return at_most({_mm256_permutevar8x32_ps(in.v, lane)}, {_mm256_permutevar8x32_ps(out.v, lane)}) &
           present_in_order(node);
}

/// Pushes the children that are met (in <= out, in <= limit) with their t_in, from far to near; returns their number.
/// Writes up to kWidth entries, whatever the number.
template <class AnyNode>
inline uint32_t push_met(Float8 in, Float8 out, float limit, const AnyNode& node, uint32_t octant_shift, float* t_in,
                         uint32_t* ref) {
    const __m256i child = _mm256_load_si256(reinterpret_cast<const __m256i*>(node.child));
    const __m256i lane = lanes_in_order(node, octant_shift);
    const __m256 ordered = _mm256_permutevar8x32_ps(in.v, lane);
    const uint32_t met = at_most({ordered}, {_mm256_permutevar8x32_ps(out.v, lane)}) &
                         at_most({ordered}, Float8::all(limit)) & present_in_order(node);
    const __m256i pack = places_of(met);
    _mm256_storeu_ps(t_in, _mm256_permutevar8x32_ps(ordered, pack));
    const __m256i from = _mm256_permutevar8x32_epi32(lane, pack);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(ref), _mm256_permutevar8x32_epi32(child, from));
    return static_cast<uint32_t>(__builtin_popcount(met));
}
/// Pushes the children whose bits are set, in no particular order; returns their number. Writes kWidth entries.
template <class AnyNode>
inline uint32_t push_met(uint32_t met, const AnyNode& node, uint32_t* ref) {
    met &= present(node);
    const __m256i child = _mm256_load_si256(reinterpret_cast<const __m256i*>(node.child));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(ref), _mm256_permutevar8x32_epi32(child, places_of(met)));
    return static_cast<uint32_t>(__builtin_popcount(met));
}

inline Float4 gathered(const float* const* from, ptrdiff_t offset) { return gathered4(from, offset); }
#include "accel/kernels/float16_pair.inl"
