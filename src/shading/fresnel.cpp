#include "shading/fresnel.h"

namespace steradian {

double fresnel_dielectric(double cos_i, double eta) noexcept {
    const double ci = clamp_to(cos_i, 0.0, 1.0);
    const double cos2_t = 1 - (1 - ci) * (1 + ci) / (eta * eta);
    if (!(cos2_t > 0)) return 1;
    const double ct = std::sqrt(cos2_t);
    const double parallel = (eta * ci - ct) / (eta * ci + ct);
    const double perpendicular = (ci - eta * ct) / (ci + eta * ct);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

/// Born & Wolf, "Principles of Optics", 14.2: with a + ib the square root of (n + ik)² - sin² θ.
double fresnel_conductor(double cos_i, double n, double k) noexcept {
    const double c = clamp_to(cos_i, 0.0, 1.0), c2 = c * c, s2 = (1 - c) * (1 + c);
    const double re = n * n - k * k - s2, im = 2 * n * k;
    const double modulus = std::sqrt(re * re + im * im);  // a² + b²
    const double a = std::sqrt(max_of((modulus + re) / 2, 0.0));
    const double perpendicular = (modulus - 2 * a * c + c2) / (modulus + 2 * a * c + c2);
    const double x = modulus * c2 + s2 * s2, y = 2 * a * c * s2;
    // At grazing incidence on a lossless medium of index 1 both parts are 0 / 0; the limit is total reflection.
    if (!(modulus + c2 > 0) || !(x + y > 0)) return 1;
    return perpendicular * (1 + (x - y) / (x + y)) / 2;
}

Rgb fresnel_conductor(double cos_i, const ComplexIndex& index) noexcept {
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(fresnel_conductor(cos_i, index.n[c], index.k[c]));
    return out;
}

Rgb fresnel_schlick(double cos_i, Rgb normal, Rgb grazing) noexcept {
    const double m = 1 - clamp_to(cos_i, 0.0, 1.0), m2 = m * m;
    const auto w = static_cast<float>(m2 * m2 * m);
    return normal * (1 - w) + grazing * w;
}

Rgb mean_fresnel_conductor(const ComplexIndex& index) noexcept {
    constexpr int kSteps = 256;  // midpoints: the mean is known to about 1e-5
    double sum[3] = {};
    for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps;
        for (int c = 0; c < 3; ++c) sum[c] += 2 * mu * fresnel_conductor(mu, index.n[c], index.k[c]) / kSteps;
    }
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

/// 2 ∫ (1 - μ)⁵ μ dμ = 1/21.
Rgb mean_fresnel_schlick(Rgb normal, Rgb grazing) noexcept {
    constexpr float w = 1 / 21.0f;
    return normal * (1 - w) + grazing * w;
}

}  // namespace steradian
