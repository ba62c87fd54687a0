#include "shading/open_pbr_tables.h"

#include <algorithm>

#include "base/parallel.h"
#include "math/elementary.h"
#include "shading/fresnel.h"

namespace steradian {
namespace {

/// Entries are dense towards grazing angles.
double from_entry(double t) { return t * t; }
double to_entry(double mu) { return std::sqrt(clamp_to(mu, 0.0, 1.0)); }

/// As far as tables go: α of a roughness of 1, which the texture scales by its square.
Roughness table_roughness(Vec2 alpha, bool textured) {
    Roughness out;
    const auto value = [](float a) { return max_of(std::sqrt(a), 0.01f); };
    out.value = {min_of(value(alpha.x), 1.0f), min_of(value(alpha.y), 1.0f)};
    if (textured) out.texture = TextureId{};
    return out;
}

/// The index whose normal reflectance is `weight` times that of eta.
double weighted_index(double eta, double weight) {
    const double f = (eta - 1) / (eta + 1);
    const double e = min_of(std::sqrt(weight) * std::fabs(f), 0.999) * (eta < 1 ? -1 : 1);
    return (1 + e) / (1 - e);
}

double mean_fresnel(double eta) {
    constexpr int kSteps = 256;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps;
        sum += 2 * mu * fresnel_dielectric(mu, eta) / kSteps;
    }
    return sum;
}

}  // namespace

namespace {

double fuzz_inverse(double roughness) { return 1 / clamp_to(roughness, 0.07, 1.0); }

/// f cos θ_i
double eval_fuzz(double inverse, double scale, Vec3d wo, Vec3d wi) {
    const Vec3d h = normalize(wo + wi);
    const double sine2 = max_of((1 - h.z) * (1 + h.z), 0.0);
    const double d = sine2 > 0 ? (2 + inverse) * math::pow(sine2, inverse / 2) / (2 * std::numbers::pi) : 0;
    return scale * d * wi.z / (4 * (wo.z + wi.z - wo.z * wi.z));
}

}  // namespace

FuzzTable::Level FuzzTable::make_level(double roughness) {
    const double inverse = fuzz_inverse(roughness);
    Level out;
    constexpr size_t kSteps = 96;
    const std::vector<Vec3d> turns = middle_azimuths(std::numbers::pi, kSteps);
    parallel_for(out.albedo.size(), 1, [&](size_t entry, size_t) {
        const double mu = max_of(from_entry(double(entry) / double(out.albedo.size() - 1)), 1e-4);
        const Vec3d wo{std::sqrt((1 - mu) * (1 + mu)), 0, mu};
        double sum = 0;
        for (size_t i = 0; i < kSteps; ++i)
            for (const Vec3d turn : turns) {
                const double t = (double(i) + 0.5) / kSteps, z = t * t, s = std::sqrt((1 - z) * (1 + z));
                const Vec3d wi{s * turn.x, s * turn.y, z};
                sum += static_cast<float>(eval_fuzz(inverse, 1, wo, wi)) * 2 * t * 2 * std::numbers::pi;
            }
        out.albedo[entry] = sum / (kSteps * kSteps);
    });
    const double most = *std::max_element(out.albedo.begin(), out.albedo.end());
    // This masking is not derived from the distribution, so nothing else keeps it from making energy.
    if (most > 1) {
        out.scale = 1 / most;
        for (double& a : out.albedo) a *= out.scale;
    }
    return out;
}

FuzzTable::FuzzTable(const FloatInput& roughness) {
    constexpr size_t kLevels = 17;
    if (!roughness.texture) levels_.push_back(make_level(roughness.value));
    for (size_t i = 0; roughness.texture && i < kLevels; ++i)
        levels_.push_back(make_level(double(i) / double(kLevels - 1)));
}

FuzzTable::Position FuzzTable::position(float roughness) const noexcept {
    if (levels_.size() == 1) return {0, 0};
    const double t = clamp_to(static_cast<double>(roughness), 0.0, 1.0) * double(levels_.size() - 1);
    const size_t first = min_of(static_cast<size_t>(t), levels_.size() - 2);
    return {first, t - double(first)};
}

Rgb FuzzTable::eval(float roughness, Vec3d wo, Vec3d wi) const noexcept {
    const Position at = position(roughness);
    double scale = levels_[at.first].scale;
    if (at.fraction > 0) scale = scale * (1 - at.fraction) + levels_[at.first + 1].scale * at.fraction;
    const auto f = static_cast<float>(eval_fuzz(fuzz_inverse(roughness), scale, wo, wi));
    return {f, f, f};
}

double FuzzTable::albedo(float roughness, double mu) const noexcept {
    const Position at = position(roughness);
    const double t = to_entry(mu) * double(levels_[0].albedo.size() - 1);
    const size_t i = min_of(static_cast<size_t>(t), levels_[0].albedo.size() - 2);
    const double f = t - double(i);
    const auto of = [&](const Level& l) { return min_of(l.albedo[i] * (1 - f) + l.albedo[i + 1] * f, 1.0); };
    const double first = of(levels_[at.first]);
    return at.fraction > 0 ? first * (1 - at.fraction) + of(levels_[at.first + 1]) * at.fraction : first;
}

Vec2 open_pbr_alpha(float roughness, float anisotropy, GrainShape shape) noexcept {
    const double across = 1 - static_cast<double>(anisotropy), r2 = static_cast<double>(roughness) * roughness;
    if (shape == GrainShape::gltf) {
        const double a2 = static_cast<double>(anisotropy) * anisotropy;
        return {static_cast<float>(r2 + (1 - r2) * a2), static_cast<float>(r2)};
    }
    const double along = r2 * std::sqrt(2 / (1 + across * across));
    return {static_cast<float>(along), static_cast<float>(across * along)};
}

float open_pbr_roughness(const OpenPbrMaterial& m, float specular_roughness, float coat_roughness) noexcept {
    if (m.coat_weight == 0) return specular_roughness;
    const auto fourth = [](double x) { return x * x * x * x; };
    const double r = specular_roughness, sum = fourth(r) + 2 * fourth(coat_roughness);
    const double rougher = std::sqrt(std::sqrt(min_of(sum, 1.0)));
    return static_cast<float>(r + (rougher - r) * m.coat_weight);
}

std::shared_ptr<const MicrofacetEnergy> SharedTables::energy(Kind kind, const TabulatedRoughness& r, double eta,
                                                             double last_eta) {
    auto& known = energy_[Key{kind, r.value.x, r.value.y, r.squared, r.texture.has_value(), r.grains, eta, last_eta}];
    if (known) return known;
    switch (kind) {
        case Kind::reflecting:
            return known = MicrofacetEnergy::reflecting(r);
        case Kind::coating:
            return known = MicrofacetEnergy::coating(r, eta);
        case Kind::transmitting:
            return known = MicrofacetEnergy::transmitting(r, {eta, last_eta});
    }
    return known;
}

std::shared_ptr<const FuzzTable> SharedTables::fuzz(const FloatInput& roughness) {
    const bool textured = roughness.texture.has_value();
    auto& known = fuzz_[{textured ? 1 : roughness.value, textured}];
    if (!known) known = std::make_shared<const FuzzTable>(roughness);
    return known;
}

FilmTables SharedTables::film(const Film& of) {
    const FilmKey key{{of.above, of.film, of.thinnest, of.thickest, of.below, of.eta},
                      {of.metal, of.glass, of.opaque},
                      {of.tint[0], of.tint[1], of.tint[2]},
                      of.base.value.x,
                      of.base.value.y,
                      of.base.squared,
                      of.base.texture.has_value(),
                      of.base.grains};
    const auto known = films_.find(key);
    if (known != films_.end()) return known->second;
    FilmTables out;
    out.thicknesses = FilmThicknesses(of.film, of.thinnest, of.thickest);
    if (of.metal)
        out.metal = std::make_shared<const FilmOnMetal>(of.above, of.film, out.thicknesses,
                                                        Rgb{of.tint[0], of.tint[1], of.tint[2]});
    if (of.glass)
        out.glass = std::make_shared<const FilmOnDielectric>(FilmIndices{1, of.film, of.eta}, out.thicknesses, false);
    if (of.opaque) {
        const FilmIndices n{of.above, of.film, of.below * of.above};
        out.dielectric = std::make_shared<const FilmOnDielectric>(n, out.thicknesses, true);
        out.energy = MicrofacetEnergy::coating(of.base, out.dielectric->table(), FilmOnDielectric::kCosines);
    }
    return films_[key] = out;
}

namespace {

SharedTables::Film film_of(const OpenPbrMaterial& m, const TabulatedRoughness& base, double below,
                           const OpenPbrTables& tables) {
    SharedTables::Film out;
    out.above = 1 + (static_cast<double>(m.coat_ior) - 1) * m.coat_weight;
    out.film = m.thin_film_ior;
    const FilmThickness& t = m.thin_film_thickness;
    out.thinnest = t.texture ? min_of(t.minimum, t.maximum) : t.maximum;
    out.thickest = t.texture ? max_of(t.minimum, t.maximum) : t.maximum;
    out.below = below, out.eta = tables.eta;
    out.metal = m.base_metalness.value > 0, out.glass = m.transmission_weight.value > 0;
    out.opaque = m.transmission_weight.value != 1 || m.transmission_weight.texture.has_value();
    if (out.metal)
        for (int c = 0; c < 3; ++c) out.tint[c] = m.specular_color.value[c];
    out.base = base;
    return out;
}

}  // namespace

/// The scale divides the Abbe number: 0 is no dispersion.
double open_pbr_abbe(const OpenPbrMaterial& m) noexcept {
    const double scale = m.transmission_dispersion_scale;
    return scale > 0 ? m.transmission_dispersion_abbe_number / scale : 0;
}

OpenPbrTables make_open_pbr_tables(const OpenPbrMaterial& m, SharedTables& shared) {
    OpenPbrTables out;
    out.coat_textured = m.coat_weight > 0 && m.coat_roughness.texture;
    out.textured = m.specular_roughness.texture || out.coat_textured;
    const float roughness =
        out.textured ? 1 : open_pbr_roughness(m, m.specular_roughness.value, m.coat_roughness.value);
    const FloatInput& grain = m.specular_roughness_anisotropy;
    // glTF's shape has not the same ratio of the two at all roughnesses.
    const bool shapes_differ = m.specular_grain_shape == GrainShape::gltf && grain.value > 0 && out.textured;
    out.every_grain = grain.texture || shapes_differ;
    const TabulatedRoughness base =
        out.every_grain ? TabulatedRoughness::every_grain()
                        : TabulatedRoughness(table_roughness(
                              open_pbr_alpha(roughness, grain.value, m.specular_grain_shape), out.textured));
    out.base = base;
    out.coat_eta = m.coat_ior;
    // Under a coat the index is relative to the coat's. Seen from outside it reflects like its inverse: what would be
    // totally reflected has not got through the coat.
    const double below = m.specular_ior / (1 + (static_cast<double>(m.coat_ior) - 1) * m.coat_weight);
    const double weighted = weighted_index(below, m.specular_weight);
    out.eta_outside = weighted < 1 ? 1 / weighted : weighted;
    out.eta = static_cast<float>(weighted_index(m.specular_ior, m.specular_weight));
    if (!refracts_visibly(out.eta)) out.eta = kLeastVisibleIndex;
    out.metal = shared.reflecting(base);
    out.dielectric = shared.coating(base, out.eta_outside);
    out.glass_index = GlassIndex(out.eta, 0);
    if (m.transmission_weight.value > 0 && !m.geometry_thin_walled) {
        out.glass_index = GlassIndex(out.eta, open_pbr_abbe(m));
        out.glass = shared.transmitting(base, out.glass_index.range());
    }
    if (m.thin_film_weight.value > 0) out.film = shared.film(film_of(m, base, weighted, out));
    if (m.coat_weight > 0) {
        const Vec2 alpha = open_pbr_alpha(out.coat_textured ? 1 : m.coat_roughness.value, m.coat_roughness_anisotropy);
        out.coat = shared.coating(table_roughness(alpha, out.coat_textured), out.coat_eta);
        out.coat_normal_reflectance = fresnel_dielectric(1, out.coat_eta);
        out.coat_inner_reflectance = 1 - (1 - mean_fresnel(out.coat_eta)) / (out.coat_eta * out.coat_eta);
    }
    if (m.fuzz_weight.value > 0) out.fuzz = shared.fuzz(m.fuzz_roughness);
    return out;
}

}  // namespace steradian
