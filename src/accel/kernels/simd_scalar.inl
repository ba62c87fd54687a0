// Vectors for the kernels as plain loops, for every machine. Included inside the namespace of an instruction set.

template <class T, int kLanes>
struct Lanes {
    T v[kLanes];
    static Lanes load(const T* p) {
        Lanes a;
        for (int i = 0; i < kLanes; ++i) a.v[i] = p[i];
        return a;
    }
    template <class U>
    static Lanes of(const Lanes<U, kLanes>& b) {
        return of_floats(b.v);
    }
    static Lanes of_floats(const float* p) {
        Lanes a;
        for (int i = 0; i < kLanes; ++i) a.v[i] = p[i];
        return a;
    }
    static Lanes of_bytes(const uint8_t* p) {
        Lanes a;
        for (int i = 0; i < kLanes; ++i) a.v[i] = p[i];
        return a;
    }
    static Lanes all(T x) {
        Lanes a;
        for (int i = 0; i < kLanes; ++i) a.v[i] = x;
        return a;
    }
    void store(T* p) const {
        for (int i = 0; i < kLanes; ++i) p[i] = v[i];
    }
};
template <class T, int kLanes, class F>
inline Lanes<T, kLanes> per_lane(const Lanes<T, kLanes>& a, const Lanes<T, kLanes>& b, F f) {
    Lanes<T, kLanes> out;
    for (int i = 0; i < kLanes; ++i) out.v[i] = f(a.v[i], b.v[i]);
    return out;
}
template <class T, int kLanes>
inline Lanes<T, kLanes> operator+(const Lanes<T, kLanes>& a, const Lanes<T, kLanes>& b) {
    return per_lane(a, b, [](T x, T y) { return x + y; });
}
template <class T, int kLanes>
inline Lanes<T, kLanes> operator-(const Lanes<T, kLanes>& a, const Lanes<T, kLanes>& b) {
    return per_lane(a, b, [](T x, T y) { return x - y; });
}
template <class T, int kLanes>
inline Lanes<T, kLanes> operator*(const Lanes<T, kLanes>& a, const Lanes<T, kLanes>& b) {
    return per_lane(a, b, [](T x, T y) { return x * y; });
}
template <class T, int kLanes>
inline Lanes<T, kLanes> operator/(const Lanes<T, kLanes>& a, const Lanes<T, kLanes>& b) {
    return per_lane(a, b, [](T x, T y) { return x / y; });
}
/// a > b ? a : b and a < b ? a : b, also for NaN: b then.
template <class T, int kLanes>
inline Lanes<T, kLanes> larger(const Lanes<T, kLanes>& a, const Lanes<T, kLanes>& b) {
    return per_lane(a, b, [](T x, T y) { return x > y ? x : y; });
}
template <class T, int kLanes>
inline Lanes<T, kLanes> smaller(const Lanes<T, kLanes>& a, const Lanes<T, kLanes>& b) {
    return per_lane(a, b, [](T x, T y) { return x < y ? x : y; });
}
using Float8 = Lanes<float, 8>;
using Double4 = Lanes<double, 4>;
using Float4 = Lanes<float, 4>;
inline Float8 magnitude(const Float8& a) {
    Float8 out;
    for (int i = 0; i < 8; ++i) out.v[i] = std::fabs(a.v[i]);
    return out;
}
inline Float4 four(float a, float b, float c, float d) { return {{a, b, c, d}}; }
inline Float4 to_floats(const Double4& a) {
    Float4 out;
    for (int i = 0; i < 4; ++i) out.v[i] = static_cast<float>(a.v[i]);
    return out;
}

/// Bit i where a <= b in lane i.
template <int kLanes>
inline uint32_t at_most(const Lanes<float, kLanes>& a, const Lanes<float, kLanes>& b) {
    uint32_t bits = 0;
    for (int i = 0; i < kLanes; ++i) bits |= uint32_t(a.v[i] <= b.v[i]) << i;
    return bits;
}
/// Bit i where a >= 0, or a <= 0, in lane i.
inline uint32_t not_negative(const Double4& a) {
    uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits |= uint32_t(a.v[i] >= 0) << i;
    return bits;
}
inline uint32_t not_positive(const Double4& a) {
    uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits |= uint32_t(a.v[i] <= 0) << i;
    return bits;
}

#include "accel/kernels/float16_pair.inl"
#include "accel/kernels/generic_lanes.inl"
