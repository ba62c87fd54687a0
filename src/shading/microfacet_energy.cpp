#include "shading/microfacet_energy.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "shading/bsdf/specular.h"
#include "shading/fresnel.h"

namespace steradian {
namespace {

constexpr int kIndices = 4, kLevels = 16, kAzimuths = 9, kPolar = 32;
/// Of tables over every grain, which are many.
constexpr int kGrains = 4, kGrainLevels = 8, kGrainAzimuths = 5, kGrainPolar = 20;
constexpr float kLongestGrain = 1e-3f;  ///< α across over α along, of the first
constexpr int kPsiNodes = 12;           // for each quarter turn
constexpr int kSlopeNodes = 64;

/// Nodes and weights of Gauss and Legendre on [0, 1], the roots found by Newton's method.
template <int N>
struct GaussLegendre {
    std::array<double, N> x{}, w{};
    GaussLegendre() {
        for (int i = 0; i < N; ++i) {
            double z = math::cos(std::numbers::pi * (i + 0.75) / (N + 0.5)), slope = 1;
            for (int step = 0; step < 8; ++step) {
                double p = 1, before = 0;
                for (int k = 0; k < N; ++k) {
                    const double next = ((2 * k + 1) * z * p - k * before) / (k + 1);
                    before = p;
                    p = next;
                }
                slope = N * (z * p - before) / (z * z - 1);
                z -= p / slope;
            }
            x[size_t(i)] = (1 - z) / 2;
            w[size_t(i)] = 1 / ((1 - z * z) * slope * slope);
        }
    }
};

/// A weighted sum over four neighbours of an axis with n >= 4 entries: the cubic through them (Lagrange).
struct Cubic {
    int first = 0, count = 1;
    std::array<double, 4> w{1, 0, 0, 0};
    Cubic(double t, int n) {
        if (n == 1) return;
        const double p = clamp_to(t, 0.0, 1.0) * (n - 1);
        first = clamp_to(static_cast<int>(p) - 1, 0, n - 4);
        count = 4;
        const double f = p - first, f1 = f - 1, f2 = f - 2, f3 = f - 3;
        w = {-f1 * f2 * f3 / 6, f * f2 * f3 / 2, -f * f1 * f3 / 2, f * f1 * f2 / 6};
    }
};

/// Entries are dense at both ends, where the loss is like c log c and like the sine. The same map serves for the
/// squared sine of the azimuth: a strong grain is seen from a narrow range of directions at either end.
double polar_from_cosine(double c) {
    const double a = std::sqrt(max_of(c, 0.0)), b = std::sqrt(max_of(1 - c, 0.0));
    return a / (a + b);
}
double cosine_from_polar(double t) { return t * t / (t * t + (1 - t) * (1 - t)); }

/// The direction with the cosine c and the squared sine q of the azimuth in the space that is scaled by `stretch` along
/// x and y.
Vec3d unstretched(Vec2 stretch, double c, double q) {
    const double s = std::sqrt((1 - c) * (1 + c));
    return normalize(Vec3d{s * std::sqrt(1 - q) / stretch.x, s * std::sqrt(q) / stretch.y, c});
}

/// The nodes of ∫ (o · h) D / o.z over microfacet normals h: `visit(weight, h, o · h)`, where the weight lacks (o · h)
/// / h.z, and after some of them `close(factor)`, by which theirs are to be multiplied. With slopes m (αx cos ψ, αy sin
/// ψ), m = tan β, the density of normals is 2 sin β cos β dβ dψ / 2π. For each ψ those that reflect upwards are an
/// interval that begins at 0, those that are seen from o a longer one; the integral is divided there, and in azimuth
/// where o · h changes its behaviour.
template <class Visit, class Close>
void for_each_facet(const Ggx& ggx, Vec3d o, bool beyond_reflection, const Visit& visit, const Close& close) {
    static const GaussLegendre<kPsiNodes> psi_rule;
    static const GaussLegendre<kSlopeNodes> slope_rule;
    const double psi_o = math::atan2(ggx.ay * o.y, ggx.ax * o.x), quarter = std::numbers::pi / 2;
    const bool symmetric = ggx.ax == ggx.ay;  // on both sides of o
    for (int q = 0; q < (symmetric ? 2 : 4); ++q)
        for (size_t i = 0; i < psi_rule.x.size(); ++i) {
            const double psi = psi_o + quarter * (q + psi_rule.x[i]);
            const double sx = ggx.ax * math::cos(psi), sy = ggx.ay * math::sin(psi);
            const double a = std::sqrt(sx * sx + sy * sy), along = (o.x * sx + o.y * sy) / a;
            // The angle of o in this plane, and of the facets that reflect and that are seen at the most.
            const double angle = math::atan2(along, o.z), steepest = (quarter + angle) / 2;
            const double last = min_of(quarter, quarter + angle);
            const double ends[] = {0, math::atan2(math::sin(steepest), a * math::cos(steepest)),
                                   math::atan2(math::sin(last), a * math::cos(last))};
            for (size_t part = 0; part < (beyond_reflection ? 2u : 1u); ++part) {
                for (size_t j = 0; j < slope_rule.x.size(); ++j) {
                    const double beta = ends[part] + (ends[part + 1] - ends[part]) * slope_rule.x[j];
                    const double sb = math::sin(beta), cb = math::cos(beta);
                    const double m = sb / cb, hz = 1 / std::sqrt(1 + m * m * a * a);
                    const Vec3d h{m * sx * hz, m * sy * hz, hz};
                    const double oh = dot(o, h);
                    if (oh > 0) visit(slope_rule.w[j] * 2 * sb * cb, h, oh);
                }
                close(psi_rule.w[i] / (symmetric ? 2 : 4) * (ends[part + 1] - ends[part]));
            }
        }
}

/// The integral of the part `bounce(h, o · h)` that leaves.
template <class Bounce>
double integrate_facets(const Ggx& ggx, Vec3d o, bool beyond_reflection, const Bounce& bounce) {
    double sum = 0, inner = 0;
    for_each_facet(
        ggx, o, beyond_reflection,
        [&](double weight, Vec3d h, double oh) { inner += weight * bounce(h, oh) * oh / h.z; },
        [&](double factor) {
            sum += factor * inner;
            inner = 0;
        });
    return sum;
}

double reflecting_albedo(const Ggx& ggx, Vec3d o) {
    return integrate_facets(ggx, o, false, [&](Vec3d h, double) {
        const Vec3d wi = reflect(o, h);
        return wi.z > 0 ? ggx.masking_over_cosine(o, wi) : 0;
    });
}

double coating_albedo(const Ggx& ggx, Vec3d o, double eta) {
    return integrate_facets(ggx, o, false, [&](Vec3d h, double oh) {
        const Vec3d wi = reflect(o, h);
        return wi.z > 0 ? fresnel_dielectric(oh, eta) * ggx.masking_over_cosine(o, wi) : 0;
    });
}

/// How much each entry of a table of reflectances has of what leaves towards o: what leaves is linear in them.
std::vector<double> coating_shares(const Ggx& ggx, Vec3d o, size_t entries) {
    std::vector<double> sum(entries), inner(entries);
    for_each_facet(
        ggx, o, false,
        [&](double weight, Vec3d h, double oh) {
            const Vec3d wi = reflect(o, h);
            if (!(wi.z > 0)) return;
            const double leaves = weight * ggx.masking_over_cosine(o, wi) * oh / h.z;
            const double t = std::sqrt(min_of(oh, 1.0)) * double(entries - 1);
            const size_t first = min_of(static_cast<size_t>(t), entries - 2);
            inner[first] += leaves * (double(first + 1) - t);
            inner[first + 1] += leaves * (t - double(first));
        },
        [&](double factor) {
            for (size_t i = 0; i < entries; ++i) sum[i] += factor * inner[i];
            std::fill(inner.begin(), inner.end(), 0.0);
        });
    return sum;
}

/// eta: the far side's index over that of the side of o.
double transmitting_albedo(const Ggx& ggx, Vec3d o, double eta) {
    return integrate_facets(ggx, o, true, [&](Vec3d h, double oh) {
        const double reflectance = fresnel_dielectric(oh, eta);
        const Vec3d reflected = reflect(o, h);
        const std::optional<Vec3d> refracted = refract(o, h, eta);
        double leaves = 0;
        if (reflected.z > 0) leaves += reflectance * ggx.masking_over_cosine(o, reflected);
        if (refracted && refracted->z < 0) leaves += (1 - reflectance) * ggx.masking_over_cosine(o, *refracted);
        return leaves;
    });
}

Vec2 alphas(const Roughness& roughness, float scale) {
    const auto alpha = [&](float value) {
        const float r = clamp_to(value * scale, 0.0f, 1.0f);
        return roughness.squared ? r * r : r;
    };
    return {alpha(roughness.value.x), alpha(roughness.value.y)};
}

Microfacets clamped(Vec2 alpha, float level) {
    if (alpha.x == 0 && alpha.y == 0) return {0, 0, level};
    return {max_of(alpha.x, kMinAlpha), max_of(alpha.y, kMinAlpha), level};
}

}  // namespace

std::vector<Vec3d> middle_azimuths(double range, size_t parts) {
    std::vector<Vec3d> out(parts);
    for (size_t i = 0; i < parts; ++i) {
        const double phi = range * (double(i) + 0.5) / double(parts);
        out[i] = {math::cos(phi), math::sin(phi), 0};
    }
    return out;
}

Microfacets microfacets(const Roughness& roughness, float texture) noexcept {
    if (!roughness.texture) return clamped(alphas(roughness, 1), 1);
    const float scale = clamp_to(texture, 0.0f, 1.0f);
    return clamped(alphas(roughness, scale), roughness.squared ? scale : std::sqrt(scale));
}

MicrofacetEnergy::MicrofacetEnergy(const TabulatedRoughness& roughness, int sides, int indices)
    : indices_(indices),
      sides_(sides),
      levels_(roughness.texture ? kLevels : 1),
      azimuths_(roughness.value.x == roughness.value.y ? 1 : kAzimuths),
      polar_(kPolar) {
    if (roughness.grains) levels_ = kGrainLevels, grains_ = kGrains, azimuths_ = kGrainAzimuths, polar_ = kGrainPolar;
}

Microfacets MicrofacetEnergy::at_row(const TabulatedRoughness& roughness, int row) const {
    if (levels_ == 1) return microfacets(roughness, 1);
    const float t = static_cast<float>(row / grains_) / static_cast<float>(levels_ - 1);
    // Instead of the perfectly smooth surface at level 0 one that is almost so: the limit of rough ones.
    const float scale = max_of(t, 0.01f);
    Microfacets out = clamped(alphas(roughness, roughness.squared ? scale : scale * scale), t);
    if (grains_ == 1) return out;
    out.across = static_cast<float>(row % grains_) / static_cast<float>(grains_ - 1);
    out.alpha_y = max_of(out.alpha_y * max_of(out.across, kLongestGrain), kMinAlpha);
    return out;
}

Vec2 MicrofacetEnergy::stretch(const Microfacets& m, Side side) const {
    return side == as_they_are_ ? Vec2{1, 1} : Vec2{m.alpha_x, m.alpha_y};
}

template <class Albedo>
void MicrofacetEnergy::fill(const TabulatedRoughness& roughness, Side side, const Albedo& albedo) {
    fill_losses(roughness, side, albedo);
    fill_means(roughness, side, 0);
}

template <class Albedo>
void MicrofacetEnergy::fill_losses(const TabulatedRoughness& roughness, Side side, const Albedo& albedo) {
    const size_t before = loss_.size();
    loss_.resize(before + directions());
    for_each_direction(roughness, side, [&](size_t i, const Microfacets& m, Vec3d o) {
        const double lost = m.smooth() ? 0 : 1 - albedo(m.ggx(), o);
        loss_[before + i] = static_cast<float>(max_of(lost, 0.0));
    });
}

template <class Visit>
void MicrofacetEnergy::for_each_direction(const TabulatedRoughness& roughness, Side side, const Visit& visit) const {
    const size_t row_size = size_t(azimuths_) * size_t(polar_);
    parallel_for(directions(), size_t(polar_), [&](size_t begin, size_t end) {
        for (size_t entry = begin; entry < end; ++entry) {
            const Microfacets m = at_row(roughness, static_cast<int>(entry / row_size));
            const size_t azimuth = entry % row_size / size_t(polar_), polar = entry % size_t(polar_);
            const double c = cosine_from_polar(static_cast<double>(polar) / (polar_ - 1));
            const double a = azimuths_ == 1 ? 0 : static_cast<double>(azimuth) / (azimuths_ - 1);
            visit(entry, m, unstretched(stretch(m, side), max_of(c, 1e-6), cosine_from_polar(a)));
        }
    });
}

void MicrofacetEnergy::fill_losses(const TabulatedRoughness& roughness, std::span<const Rgb> tables, size_t entries) {
    loss_.resize(directions() * size_t(indices_));
    for_each_direction(roughness, Side::outside, [&](size_t direction, const Microfacets& m, Vec3d o) {
        const std::vector<double> share = coating_shares(m.ggx(), o, entries);
        for (size_t table = 0; table * entries < tables.size(); ++table) {
            Vec3d leaves;
            for (size_t i = 0; i < entries; ++i) {
                const Rgb r = tables[table * entries + i];
                leaves = leaves + Vec3d{r.r, r.g, r.b} * share[i];
            }
            const double channels[] = {leaves.x, leaves.y, leaves.z};
            for (size_t c = 0; c < 3; ++c)
                loss_[(table * 3 + c) * directions() + direction] = static_cast<float>(max_of(1 - channels[c], 0.0));
        }
    });
}

/// The mean of what the table says, so that what is added to it makes it whole.
void MicrofacetEnergy::fill_means(const TabulatedRoughness& roughness, Side side, float index) {
    constexpr int kSteps = 256;
    const std::vector<Vec3d> turns = middle_azimuths(std::numbers::pi / 2, azimuths_ == 1 ? 1 : 64);
    const size_t before = mean_.size();
    mean_.resize(before + size_t(rows()));
    parallel_for(size_t(rows()), 1, [&](size_t row, size_t) {
        const Microfacets m = at_row(roughness, static_cast<int>(row));
        double sum = 0;
        for (int i = 0; i < kSteps; ++i)
            for (const Vec3d turn : turns) {
                const double mu = (i + 0.5) / kSteps, s = std::sqrt((1 - mu) * (1 + mu));
                sum += 2 * mu * loss(m, {s * turn.x, s * turn.y, mu}, side, index) / (kSteps * double(turns.size()));
            }
        mean_[before + row] = static_cast<float>(sum);
    });
}

std::shared_ptr<const MicrofacetEnergy> MicrofacetEnergy::reflecting(const TabulatedRoughness& roughness) {
    const std::shared_ptr<MicrofacetEnergy> out(new MicrofacetEnergy(roughness, 1));
    out->fill(roughness, Side::outside, reflecting_albedo);
    return out;
}

/// What refracts is most of the loss and depends on the direction itself. Almost all directions are at one place of a
/// space that is stretched for a polished surface, and different ones where the roughness varies.
static std::optional<Side> coating_as_it_is(const TabulatedRoughness& roughness) {
    constexpr float kPolished = 0.05f;
    const Microfacets m = microfacets(roughness, 1);
    const bool as_it_is = roughness.texture || max_of(m.alpha_x, m.alpha_y) < kPolished;
    return as_it_is ? std::optional(Side::outside) : std::nullopt;
}

std::shared_ptr<const MicrofacetEnergy> MicrofacetEnergy::coating(const TabulatedRoughness& roughness, double eta) {
    const std::shared_ptr<MicrofacetEnergy> out(new MicrofacetEnergy(roughness, 1));
    out->as_they_are_ = coating_as_it_is(roughness);
    out->fill(roughness, Side::outside, [&](const Ggx& ggx, Vec3d o) { return coating_albedo(ggx, o, eta); });
    return out;
}

std::shared_ptr<const MicrofacetEnergy> MicrofacetEnergy::coating(const TabulatedRoughness& roughness,
                                                                  std::span<const Rgb> tables, size_t entries) {
    const int channels = static_cast<int>(tables.size() / entries) * 3;
    const std::shared_ptr<MicrofacetEnergy> out(new MicrofacetEnergy(roughness, 1, channels));
    out->as_they_are_ = coating_as_it_is(roughness);
    out->fill_losses(roughness, tables, entries);
    return out;
}

std::shared_ptr<const MicrofacetEnergy> MicrofacetEnergy::transmitting(const TabulatedRoughness& roughness,
                                                                       IndexRange eta) {
    const int indices = eta.first == eta.last ? 1 : kIndices;
    const auto at = [&](int i) { return indices == 1 ? 0 : static_cast<double>(i) / (indices - 1); };
    const std::shared_ptr<MicrofacetEnergy> out(new MicrofacetEnergy(roughness, 2, indices));
    out->as_they_are_ = eta.first > 1 ? Side::inside : Side::outside;
    for (int i = 0; i < indices; ++i)
        for (const Side side : {Side::outside, Side::inside}) {
            const double n = eta.first + (eta.last - eta.first) * at(i);
            out->fill_losses(roughness, side, [&](const Ggx& ggx, Vec3d o) {
                return transmitting_albedo(ggx, o, side == Side::outside ? n : 1 / n);
            });
        }
    for (int i = 0; i < indices; ++i)
        for (const Side side : {Side::outside, Side::inside})
            out->fill_means(roughness, side, static_cast<float>(at(i)));
    return out;
}

/// The neighbours of a direction and a roughness.
struct MicrofacetEnergy::Stencil {
    Cubic level, grain, azimuth, polar;
};

MicrofacetEnergy::Stencil MicrofacetEnergy::stencil(const Microfacets& m, Vec3d w, Side side) const {
    const Vec2 scale = stretch(m, side);
    const double x = scale.x * w.x, y = scale.y * w.y, z = w.z;
    const double across = x * x + y * y;
    const double q = across > 0 ? y * y / across : 0;
    return {Cubic(m.level, levels_), Cubic(m.across, grains_), Cubic(polar_from_cosine(q), azimuths_),
            Cubic(polar_from_cosine(z / std::sqrt(across + z * z)), polar_)};
}

void MicrofacetEnergy::add_loss(double& sum, double weight, size_t index, Side side, const Stencil& s) const {
    const auto& [l, g, a, p] = s;
    const float* table = loss_.data() + (index * size_t(sides_) + size_t(side)) * directions();
    for (int i = 0; i < l.count; ++i)
        for (int h = 0; h < g.count; ++h)
            for (int j = 0; j < a.count; ++j) {
                const int at = (l.first + i) * grains_ + g.first + h;
                const float* row = table + (at * azimuths_ + a.first + j) * polar_ + p.first;
                double inner = 0;
                for (int k = 0; k < p.count; ++k) inner += p.w[size_t(k)] * row[k];
                sum += weight * l.w[size_t(i)] * g.w[size_t(h)] * a.w[size_t(j)] * inner;
            }
}

double MicrofacetEnergy::loss(const Microfacets& m, Vec3d w, Side side, float index) const noexcept {
    if (m.smooth()) return 0;
    const Stencil s = stencil(m, w, side);
    const Cubic e(static_cast<double>(index), indices_);
    double sum = 0;
    for (int n = 0; n < e.count; ++n) add_loss(sum, e.w[size_t(n)], size_t(e.first + n), side, s);
    return clamp_to(sum, 0.0, 1.0);
}

void MicrofacetEnergy::losses(const Microfacets& m, Vec3d w, size_t first, std::span<Vec3d> out) const noexcept {
    const Stencil s = stencil(m, w, Side::outside);
    for (size_t i = 0; i < out.size(); ++i) {
        double sum[3] = {};
        for (size_t c = 0; c < 3; ++c) add_loss(sum[c], 1, (first + i) * 3 + c, Side::outside, s);
        out[i] = {clamp_to(sum[0], 0.0, 1.0), clamp_to(sum[1], 0.0, 1.0), clamp_to(sum[2], 0.0, 1.0)};
    }
}

double MicrofacetEnergy::mean_loss(const Microfacets& m, Side side, float index) const noexcept {
    const Cubic e(static_cast<double>(index), indices_), l(m.level, levels_), g(m.across, grains_);
    double sum = 0;
    for (int n = 0; n < e.count; ++n)
        for (int i = 0; i < l.count; ++i)
            for (int h = 0; h < g.count; ++h) {
                const int level = ((e.first + n) * sides_ + int(side)) * levels_ + l.first + i;
                sum += e.w[size_t(n)] * l.w[size_t(i)] * g.w[size_t(h)] * mean_[size_t(level * grains_ + g.first + h)];
            }
    return clamp_to(sum, 0.0, 1.0);
}

WideLobe::WideLobe(const Microfacets& m)
    : alpha2(static_cast<double>(m.alpha_x) * m.alpha_y), log_range(math::log(1 + 1 / alpha2)) {}

Vec3d WideLobe::sample(Vec2 u) const {
    const double mu2 = alpha2 * (math::exp(warp::cell_middle(u.x) * log_range) - 1);
    const double phi = 2 * std::numbers::pi * warp::cell_middle(u.y), s = std::sqrt(max_of(1 - mu2, 0.0));
    return {s * math::cos(phi), s * math::sin(phi), std::sqrt(mu2)};
}

double WideLobe::pdf(double cosine) const {
    return cosine / (std::numbers::pi * (cosine * cosine + alpha2) * log_range);
}

}  // namespace steradian
