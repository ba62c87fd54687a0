// How it is done: reduce the argument to a small interval in double-double arithmetic (pairs of doubles whose sum is
// the value: Dekker 1971, "A floating-point technique for extending the available precision"), evaluate a polynomial
// whose error is far below the rounding, and add the small part to the large one last. The polynomials are Chebyshev
// fits, computed with 400 bits and rounded to double; the weighted error of each, relative to the function's value and
// with its coefficients rounded, is given beside it.
#include "math/elementary.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace steradian::math {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// --- Double-double ---------------------------------------------------------------------------------------------------

struct Dd {
    double hi, lo;
};

/// a + b exactly (Knuth).
inline Dd two_sum(double a, double b) {
    const double s = a + b;
    const double t = s - a;
    return {s, (a - (s - t)) + (b - t)};
}

/// a + b exactly, for |a| >= |b| or a = 0.
inline Dd quick_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
}

/// a * b exactly (Veltkamp's splitting, Dekker's product); for |a|, |b| < 2^990 and products that are not denormal.
inline Dd two_product(double a, double b) {
    constexpr double kSplit = 0x1p27 + 1;
    const double ca = kSplit * a, cb = kSplit * b;
    const double a1 = ca - (ca - a), b1 = cb - (cb - b);
    const double a2 = a - a1, b2 = b - b1;
    const double p = a * b;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

inline Dd multiply(Dd a, Dd b) {
    const Dd p = two_product(a.hi, b.hi);
    return quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

inline Dd add(Dd a, Dd b) {
    const Dd s = two_sum(a.hi, b.hi);
    return quick_sum(s.hi, s.lo + (a.lo + b.lo));
}

inline Dd negate(Dd a) { return {-a.hi, -a.lo}; }

inline Dd divide(Dd a, Dd b) {
    const double q = a.hi / b.hi;
    const Dd p = two_product(q, b.hi);
    const double rest = ((a.hi - p.hi) - p.lo) + (a.lo - q * b.lo);
    return {q, rest / b.hi};
}

inline double value(Dd a) { return a.hi + a.lo; }

/// Horner's rule; the first coefficient is the constant one.
template <size_t N>
inline double polynomial(const std::array<double, N>& c, double x) {
    double sum = c[N - 1];
    for (size_t i = N - 1; i-- > 0;) sum = sum * x + c[i];
    return sum;
}

/// To the nearest integer; |x| <= 2^52.
inline int64_t nearest(double x) { return static_cast<int64_t>(x + std::copysign(0.5, x)); }

constexpr Dd kPi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Dd kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

// --- Sine, cosine, tangent -------------------------------------------------------------------------------------------

/// x = quadrant π/2 + r, |r| <= π/4 (a little more, by rounding).
struct Quadrant {
    Dd r;
    int index;
};

/// Cody & Waite 1980: π/2 in parts of 33 bits, whose products with n < 2^20 are exact. The sum of the parts is π/2 to
/// within 2^-159; no double lies closer than 2^-62 to a multiple of π/2.
inline Dd subtract_quadrants_small(double x, double n) {
    constexpr double kP1 = 0x1.921fb544p+0, kP2 = 0x1.0b4611a6p-34, kP3 = 0x1.3198a2ep-69, kP4 = 0x1.b839a252049c1p-104;
    const Dd a = two_sum(x - n * kP1, -(n * kP2));
    const Dd b = two_sum(a.hi, -(n * kP3));
    return quick_sum(b.hi, (a.lo + b.lo) - n * kP4);
}

/// The same for n < 2^52, with π/2 as three doubles and exact products.
Dd subtract_quadrants_large(double x, double n) {
    constexpr double kP1 = kHalfPi.hi, kP2 = kHalfPi.lo, kP3 = -0x1.f1976b7ed8fbcp-110;
    const Dd p1 = two_product(n, kP1), p2 = two_product(n, kP2);
    const Dd a = two_sum(x - p1.hi, -p1.lo);
    const Dd b = two_sum(a.hi, -p2.hi);
    return add(quick_sum(b.hi, a.lo + b.lo), {-p2.lo, -(n * kP3)});
}

/// |x| <= 2^52.
inline Quadrant reduce(double x) {
    constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
    int64_t n = nearest(x * kTwoOverPi);
    if (std::fabs(x) <= 0x1p20) return {subtract_quadrants_small(x, static_cast<double>(n)), static_cast<int>(n & 3)};
    Dd r = subtract_quadrants_large(x, static_cast<double>(n));
    if (std::fabs(r.hi) > 0.7855) {  // n was one off, because x * 2/π has no digits left behind the point
        const bool above = r.hi > 0;
        r = add(r, above ? negate(kHalfPi) : kHalfPi);
        n += above ? 1 : -1;
    }
    return {r, static_cast<int>(n & 3)};
}

/// sin(r) = r + r³ S(r²), |r| <= π/4; weighted error 2^-57.2.
inline Dd sin_quadrant(Dd r) {
    constexpr std::array kS{-0x1.5555555555555p-3, 0x1.1111111111110p-7,   -0x1.a01a01a01992fp-13,
                            0x1.71de3a545f836p-19, -0x1.ae645410e937bp-26, 0x1.61217d9252c03p-33,
                            -0x1.ab16f5caa198ap-41};
    const double u = r.hi * r.hi;
    return {r.hi, r.hi * u * polynomial(kS, u) + r.lo * (1 - 0.5 * u)};
}

/// cos(r) = 1 - r²/2 + r⁴ C(r²), |r| <= π/4; weighted error 2^-60.
inline Dd cos_quadrant(Dd r) {
    constexpr std::array kC{0x1.5555555555555p-5,   -0x1.6c16c16c16c16p-10, 0x1.a01a01a019d06p-16,
                            -0x1.27e4fb77125c5p-22, 0x1.1eed8deac3dfep-29,  -0x1.9394b8bd50ae1p-37,
                            0x1.ab779550c8d9bp-45};
    const double u = r.hi * r.hi;
    const double half = 0.5 * u;
    const double one_minus = 1 - half;
    return {one_minus, ((1 - one_minus) - half) + (u * u * polynomial(kC, u) - r.hi * r.lo)};
}

// --- Exponential and logarithm ---------------------------------------------------------------------------------------

// ln 2 in three parts; the first two have 42 bits, so that their products with an exponent are exact.
constexpr double kLn2[3] = {0x1.62e42fefa38p-1, 0x1.ef35793c76p-45, 0x1.cc01f97b57a08p-87};
constexpr Dd kOneOverLn2{0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56};

/// 2^n for a normal result.
inline double power_of_two(int n) { return std::bit_cast<double>(static_cast<uint64_t>(n + 1023) << 52); }

/// x 2^n, rounded once when it is denormal; x in [0.5, 2), n in [-1200, 1100].
inline double scale(double x, int n) {
    if (n > 1000) return x * power_of_two(n - 1000) * 0x1p1000;
    if (n < -1000) return x * power_of_two(n + 1000) * 0x1p-1000;
    return x * power_of_two(n);
}

/// e^x for |x| < 760. e^(n ln 2 + r) = 2^n (1 + r + r² E(r)), |r| <= ln(2)/2; weighted error 2^-61.6.
inline double exp_of(Dd x) {
    constexpr std::array kE{0.5,
                            0x1.5555555555557p-3,
                            0x1.5555555555556p-5,
                            0x1.11111111100bep-7,
                            0x1.6c16c16c162c3p-10,
                            0x1.a01a01abf85abp-13,
                            0x1.a01a01a6e1e2ap-16,
                            0x1.71de01fdbf9cap-19,
                            0x1.27e4db46cddd1p-22,
                            0x1.af4e554377204p-26,
                            0x1.1f7340dbc337ep-29};
    const int64_t exponent = nearest(x.hi * kOneOverLn2.hi);
    const double n = static_cast<double>(exponent);
    const Dd a = two_sum(x.hi - n * kLn2[0], -(n * kLn2[1]));
    const Dd r = two_sum(a.hi, (a.lo - n * kLn2[2]) + x.lo);
    const double tail = r.hi * r.hi * polynomial(kE, r.hi) + (r.lo + r.lo * r.hi);
    const Dd one_plus = quick_sum(1, r.hi);
    return scale(one_plus.hi + (one_plus.lo + tail), static_cast<int>(exponent));
}

/// x = m 2^exponent with m in [√½, √2).
struct Split {
    double m;
    int exponent;
};

/// x positive and finite.
inline Split split(double x) {
    int bias = 0;
    if (x < 0x1p-1022) x *= 0x1p54, bias = -54;
    constexpr uint64_t kRootHalf = std::bit_cast<uint64_t>(0x1.6a09e667f3bcdp-1);
    const uint64_t bits = std::bit_cast<uint64_t>(x);
    const int exponent = static_cast<int>(static_cast<int64_t>(bits - kRootHalf) >> 52);
    return {std::bit_cast<double>(bits - (static_cast<uint64_t>(exponent) << 52)), exponent + bias};
}

/// ln m for m in [√½, √2), relative error below 2^-64: with s = (m - 1)/(m + 1), ln m = 2 atanh s =
/// 2 (s + s³ (1/3 + s² L(s²))); the error of L weighs 2^-66.
inline Dd log_mantissa(double m) {
    constexpr std::array kL{0x1.999999999999ap-3, 0x1.2492492492491p-3, 0x1.c71c71c71cfdep-4,
                            0x1.745d174512f5ep-4, 0x1.3b13b1bcae4fap-4, 0x1.1110df9bb9145p-4,
                            0x1.e1f80050fe02dp-5, 0x1.ac4a0689e4f11p-5, 0x1.b8d8d83f51283p-5};
    constexpr Dd kThird{0x1.5555555555555p-2, 0x1.5555555555555p-56};
    const Dd s = divide({m - 1, 0}, two_sum(m, 1));
    const Dd u = multiply(s, s);
    const Dd series = add(kThird, {u.hi * polynomial(kL, u.hi), 0});
    const Dd half = add(s, multiply(s, multiply(u, series)));
    return {2 * half.hi, 2 * half.lo};
}

/// ln x for positive finite x.
inline Dd log_of(double x) {
    const Split parts = split(x);
    const Dd m = log_mantissa(parts.m);
    const double n = parts.exponent;
    const Dd sum = two_sum(n * kLn2[0], m.hi);
    return quick_sum(sum.hi, sum.lo + ((n * kLn2[1] + m.lo) + n * kLn2[2]));
}

// --- Inverse trigonometry --------------------------------------------------------------------------------------------

/// arctan(i/16).
constexpr std::array<Dd, 17> kArctan{{
    {0, 0},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
}};

/// The angle of (x, y) in the first quadrant, [0, π/2]; not both zero, both within [2^-700, 2^700] or zero.
/// arctan q = arctan c + arctan((q - c)/(1 + q c)) with c a multiple of 1/16; arctan r = r + r³ A(r²), |r| <= 3/32;
/// weighted error 2^-61.
Dd first_quadrant_angle(Dd y, Dd x) {
    constexpr std::array kA{-0x1.5555555555555p-2, 0x1.9999999997978p-3,  -0x1.2492491b69f22p-3,
                            0x1.c71c533664d6dp-4,  -0x1.744601bef0a01p-4, 0x1.3304c5b857745p-4};
    const bool steep = y.hi > x.hi;
    const Dd q = steep ? divide(x, y) : divide(y, x);
    const int index = q.hi <= 0.09375 ? 0 : static_cast<int>(q.hi * 16 + 0.5);
    const double c = index * 0.0625;
    const double denominator = 1 + q.hi * c;
    const double r = (q.hi - c) / denominator;
    const double u = r * r;
    const Dd angle = add(kArctan[static_cast<size_t>(index)], {r, r * u * polynomial(kA, u) + q.lo / denominator});
    return steep ? add(kHalfPi, negate(angle)) : angle;
}

/// √(1 - x²) for |x| <= 1.
Dd root_of_one_minus_square(double x) {
    const Dd square = two_product(x, x);
    const Dd rest = add(quick_sum(1, -square.hi), {-square.lo, 0});
    const double root = std::sqrt(rest.hi);
    if (root == 0) return {0, 0};
    const Dd p = two_product(root, root);
    return {root, (((rest.hi - p.hi) - p.lo) + rest.lo) / (2 * root)};
}

}  // namespace

double sin(double x) {
    const double size = std::fabs(x);
    if (!(size <= 0x1p52)) return kNan;
    if (size < 0x1p-27) return x;
    const Quadrant q = reduce(x);
    const double y = value(q.index & 1 ? cos_quadrant(q.r) : sin_quadrant(q.r));
    return q.index & 2 ? -y : y;
}

double cos(double x) {
    if (!(std::fabs(x) <= 0x1p52)) return kNan;
    const Quadrant q = reduce(x);
    const double y = value(q.index & 1 ? sin_quadrant(q.r) : cos_quadrant(q.r));
    return (q.index + 1) & 2 ? -y : y;
}

SinCos sin_cos(double x) {
    const double size = std::fabs(x);
    if (!(size <= 0x1p52)) return {kNan, kNan};
    const Quadrant q = reduce(x);
    const double s = value(sin_quadrant(q.r)), c = value(cos_quadrant(q.r));
    const double sine = q.index & 1 ? c : s, cosine = q.index & 1 ? s : c;
    return {size < 0x1p-27 ? x : q.index & 2 ? -sine : sine, (q.index + 1) & 2 ? -cosine : cosine};
}

double tan(double x) {
    const double size = std::fabs(x);
    if (!(size <= 0x1p52)) return kNan;
    if (size < 0x1p-27) return x;
    const Quadrant q = reduce(x);
    const Dd sin_parts = sin_quadrant(q.r), cos_parts = cos_quadrant(q.r);
    const Dd s = quick_sum(sin_parts.hi, sin_parts.lo), c = quick_sum(cos_parts.hi, cos_parts.lo);
    return value(q.index & 1 ? divide(negate(c), s) : divide(s, c));
}

double exp(double x) {
    if (std::isnan(x)) return x;
    if (x > 750) return kInf;
    if (x < -750) return 0;
    return exp_of({x, 0});
}

double log(double x) {
    if (!(x > 0)) return x == 0 ? -kInf : kNan;
    if (x == kInf) return x;
    return value(log_of(x));
}

double log2(double x) {
    if (!(x > 0)) return x == 0 ? -kInf : kNan;
    if (x == kInf) return x;
    const Split parts = split(x);
    const Dd m = multiply(log_mantissa(parts.m), kOneOverLn2);
    return value(add({static_cast<double>(parts.exponent), 0}, m));
}

namespace {

enum class Parity { none, even, odd };

/// Of y as an integer; none when it is not one.
Parity parity(double y) {
    const double size = std::fabs(y);
    if (size >= 0x1p53) return Parity::even;
    const int64_t whole = static_cast<int64_t>(size);
    if (static_cast<double>(whole) != size) return Parity::none;
    return whole & 1 ? Parity::odd : Parity::even;
}

/// |x|^y for x not 0, 1, infinite or NaN and y finite, not 0.
double positive_power(double x, double y) {
    const Dd l = log_of(x);
    const double estimate = l.hi * y;
    if (estimate > 750) return kInf;
    if (estimate < -750) return 0;
    if (std::fabs(estimate) < 0x1p-60) return 1;
    return exp_of(multiply(l, {y, 0}));
}

}  // namespace

double pow(double x, double y) {
    if (y == 0 || x == 1) return 1;
    if (std::isnan(x) || std::isnan(y)) return kNan;
    const double size = std::fabs(x);
    if (std::isinf(y)) return size == 1 ? 1 : (size > 1) == (y > 0) ? kInf : 0;
    const Parity integer = parity(y);
    const bool negative = std::signbit(x) && integer == Parity::odd;
    double result;
    if (size == 0 || size == kInf)
        result = (size == 0) == (y < 0) ? kInf : 0;
    else if (x < 0 && integer == Parity::none)
        return kNan;
    else
        result = size == 1 ? 1 : positive_power(size, y);
    return negative ? -result : result;
}

double atan2(double y, double x) {
    if (std::isnan(x) || std::isnan(y)) return kNan;
    double height = std::fabs(y), width = std::fabs(x);
    const bool left = std::signbit(x);
    if (height == 0) return left ? std::copysign(kPi.hi, y) : y;
    if (std::isinf(height) && std::isinf(width)) height = width = 1;
    if (height < width * 0x1p-60) return left ? std::copysign(kPi.hi, y) : y / width;
    if (width < height * 0x1p-60) return std::copysign(kHalfPi.hi, y);
    // The ratio is moderate by now: bring both to where nothing overflows or vanishes.
    const double larger = height > width ? height : width;
    const double factor = larger > 0x1p500 ? 0x1p-600 : larger < 0x1p-500 ? 0x1p600 : 1;
    Dd angle = first_quadrant_angle({height * factor, 0}, {width * factor, 0});
    if (left) angle = add(kPi, negate(angle));
    return std::copysign(value(angle), y);
}

double asin(double x) {
    const double size = std::fabs(x);
    if (!(size <= 1)) return kNan;
    if (size < 0x1p-27) return x;
    return std::copysign(value(first_quadrant_angle({size, 0}, root_of_one_minus_square(size))), x);
}

double acos(double x) {
    const double size = std::fabs(x);
    if (!(size <= 1)) return kNan;
    const Dd angle = first_quadrant_angle(root_of_one_minus_square(size), {size, 0});
    return value(std::signbit(x) ? add(kPi, negate(angle)) : angle);
}

}  // namespace steradian::math
