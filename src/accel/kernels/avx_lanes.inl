// What AVX2 and AVX-512 do in the same way.

/// from[lane][offset] in every lane.
inline Float4 gathered4(const float* const* from, ptrdiff_t offset) {
    return {_mm_setr_ps(from[0][offset], from[1][offset], from[2][offset], from[3][offset])};
}

/// Sixteen rows of eight floats become eight columns of sixteen, one after the other.
inline void transpose(const float* const* rows, float* columns) {
    for (int half = 0; half < 2; ++half, rows += 8, columns += 8) {
        __m256 pair[8], quad[8];
        for (int i = 0; i < 4; ++i) {  // rows 2 i and 2 i + 1
            const __m256 a = _mm256_loadu_ps(rows[2 * i]), b = _mm256_loadu_ps(rows[2 * i + 1]);
            pair[2 * i] = _mm256_unpacklo_ps(a, b), pair[2 * i + 1] = _mm256_unpackhi_ps(a, b);
        }
        for (int i = 0; i < 2; ++i)        // rows 4 i … 4 i + 3
            for (int k = 0; k < 2; ++k) {  // columns 2 k and 2 k + 1 of either half
                const __m256d a = _mm256_castps_pd(pair[4 * i + k]), b = _mm256_castps_pd(pair[4 * i + 2 + k]);
                quad[4 * i + 2 * k] = _mm256_castpd_ps(_mm256_unpacklo_pd(a, b));
                quad[4 * i + 2 * k + 1] = _mm256_castpd_ps(_mm256_unpackhi_pd(a, b));
            }
        for (int i = 0; i < 4; ++i) {
            _mm256_store_ps(columns + 16 * i, _mm256_permute2f128_ps(quad[i], quad[4 + i], 0x20));
            _mm256_store_ps(columns + 16 * (i + 4), _mm256_permute2f128_ps(quad[i], quad[4 + i], 0x31));
        }
    }
}

/// Lanes in the order that a node has stored for an octant.
inline __m256i lanes_in_order(const WideNode& node, uint32_t octant_shift) {
    const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(node.order));
    return _mm256_srl_epi32(order, _mm_cvtsi32_si128(static_cast<int>(octant_shift)));
}
/// Bits of the places, and of the children, where there is a child; of others in full nodes no box is ever met.
inline uint32_t present_in_order(const WideNode&) { return ~0u; }
inline uint32_t present(const WideNode&) { return ~0u; }
inline __m256i lanes_in_order(const CompactNode& node, uint32_t octant_shift) {
    return _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(node.order_of(octant_shift))),
                             _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21));
}
inline uint32_t present_in_order(const CompactNode& node) { return node.present_in_order(); }
inline uint32_t present(const CompactNode& node) { return node.present(); }
