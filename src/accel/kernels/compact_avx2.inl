// Reading compact blocks and pushing the children of compact nodes, with AVX2.

struct CompactLanes : CompactBlock {
    const char* first;    ///< x of the first vertex
    uint64_t stride;      ///< from x to y and from y to z, in bytes
    uint64_t second;      ///< where corner 2 is found, in bytes
    __m256i corners_0_1;  ///< indices of corner 0 of four triangles, then of corner 1
    __m256i corner_2;     ///< of corner 2; the upper half means nothing

    explicit CompactLanes(const CompactBlock& block)
        : CompactBlock(block),
          first(at + 4),
          stride(4 * vertices()),
          second(many() ? sizeof(float[kSecondVector]) : 0) {
        // Only the lowest three bits of an index count. Shifts of 32 leave 0, to which the first triangle's is added.
        const __m256i bits = _mm256_set1_epi32(static_cast<int>(header));
        corners_0_1 = _mm256_or_si256(_mm256_srlv_epi32(bits, _mm256_setr_epi32(32, 0, 3, 6, 32, 9, 12, 15)),
                                      _mm256_setr_epi32(0, 0, 0, 0, 1, 0, 0, 0));
        corner_2 = _mm256_or_si256(_mm256_srlv_epi32(bits, _mm256_setr_epi32(32, 18, 21, 24, 32, 32, 32, 32)),
                                   _mm256_setr_epi32(2, 0, 0, 0, 0, 0, 0, 0));
    }

    void corners(int which_axis, Float4 out[3]) const {
        const char* from = first + stride * static_cast<uint32_t>(which_axis);
        const __m256 a = _mm256_loadu_ps(reinterpret_cast<const float*>(from));
        const __m256 b = _mm256_loadu_ps(reinterpret_cast<const float*>(from + second));
        const __m256 p = _mm256_permutevar8x32_ps(a, corners_0_1);
        out[0] = {_mm256_castps256_ps128(p)};
        out[1] = {_mm256_extractf128_ps(p, 1)};
        out[2] = {_mm256_castps256_ps128(_mm256_permutevar8x32_ps(b, corner_2))};
    }
    void corners(int which_axis, Double4 out[3]) const {
        Float4 p[3];
        corners(which_axis, p);
        for (int i = 0; i < 3; ++i) out[i] = Double4::of(p[i]);
    }
};
