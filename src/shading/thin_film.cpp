#include "shading/thin_film.h"

#include "math/elementary.h"
#include "shading/fresnel.h"
#include "shading/spectrum.h"

namespace steradian {
namespace {

/// The little that is needed; std::complex would call the C library.
struct Complex {
    double re = 0, im = 0;
    Complex operator+(Complex b) const { return {re + b.re, im + b.im}; }
    Complex operator-(Complex b) const { return {re - b.re, im - b.im}; }
    Complex operator*(Complex b) const { return {re * b.re - im * b.im, re * b.im + im * b.re}; }
    Complex operator/(Complex b) const {
        const double d = b.re * b.re + b.im * b.im;
        return {(re * b.re + im * b.im) / d, (im * b.re - re * b.im) / d};
    }
    double norm() const { return re * re + im * im; }
};

/// With both parts not negative, as long as b.im is not.
Complex root(Complex b) {
    const double size = std::sqrt(b.norm());
    return {std::sqrt(max_of((size + b.re) / 2, 0.0)), std::sqrt(max_of((size - b.re) / 2, 0.0))};
}

/// The amplitudes that a boundary reflects, by the index n and n cos θ of either side.
struct Amplitudes {
    Complex s, p;
    Amplitudes(Complex n1, Complex nc1, Complex n2, Complex nc2) {
        s = (nc1 - nc2) / (nc1 + nc2);
        const Complex a = n2 * n2 * nc1, b = n1 * n1 * nc2;
        p = (a - b) / (a + b);
    }
};

/// What the film and its base do whatever the wavelength, for light from one direction.
struct FilmStack {
    Amplitudes upper, lower;
    Complex film_cosine;  ///< times the film's index
    FilmStack(Complex n1, Complex nc1, Complex n2, Complex nc2, Complex n3, Complex nc3)
        : upper(n1, nc1, n2, nc2), lower(n2, nc2, n3, nc3), film_cosine(nc2) {}

    static FilmStack make(double cos_i, const FilmIndices& n) {
        const double mu = clamp_to(cos_i, 1e-6, 1.0), along = n.outside * n.outside * (1 - mu) * (1 + mu);
        const Complex n2{n.film, 0}, n3{n.base, n.base_k}, shift{along, 0};
        return {{n.outside, 0}, {n.outside * mu, 0}, n2, root(n2 * n2 - shift), n3, root(n3 * n3 - shift)};
    }

    double reflectance(double thickness, double wavelength) const {
        const double turn = 4 * std::numbers::pi * thickness / wavelength;
        const double size = math::exp(-turn * film_cosine.im), angle = turn * film_cosine.re;
        const Complex phase{size * math::cos(angle), size * math::sin(angle)};
        const auto airy = [&](Complex r12, Complex r23) {
            const Complex again = r23 * phase;
            return ((r12 + again) / (Complex{1, 0} + r12 * again)).norm();
        };
        return clamp_to((airy(upper.s, lower.s) + airy(upper.p, lower.p)) / 2, 0.0, 1.0);
    }
};

/// The wavelengths at which the spectrum is looked at, and what each adds to the channels of white light.
struct Wavelengths {
    std::vector<double> at;
    std::vector<Vec3d> weight;
    explicit Wavelengths(double thickness) {
        const auto count = static_cast<size_t>(140 * max_of(1.0, thickness));
        Vec3d sum;
        for (size_t i = 0; i < count; ++i) {
            const double t = (double(i) + 0.5) / double(count);
            at.push_back(kShortestWavelength + (kLongestWavelength - kShortestWavelength) * t);
            weight.push_back(rgb_response(at.back()));
            sum = sum + weight.back();
        }
        for (Vec3d& w : weight) w = {w.x / sum.x, w.y / sum.y, w.z / sum.z};
    }
    Vec3d color(const FilmStack& stack, double thickness) const {
        Vec3d out;
        for (size_t i = 0; i < at.size(); ++i) out = out + weight[i] * stack.reflectance(thickness, at[i]);
        return out;
    }
};

float clamped(double x) { return static_cast<float>(clamp_to(x, 0.0, 1.0)); }

/// Entries are dense towards grazing angles.
double cosine_of(size_t entry, size_t entries) {
    const double t = double(entry) / double(entries - 1);
    return t * t;
}

struct Between {
    size_t first;
    float f;
    Between(double t, size_t entries) {
        const double p = clamp_to(t, 0.0, 1.0) * double(entries - 1);
        first = min_of(static_cast<size_t>(p), entries - 2);
        f = static_cast<float>(p - double(first));
    }
    Rgb operator()(const Rgb* table) const { return table[first] * (1 - f) + table[first + 1] * f; }
};

double at_82_of(double normal, double tint) {
    constexpr double kRest = 6.0 / 7;
    return tint * (normal + (1 - normal) * kRest * kRest * kRest * kRest * kRest);
}

}  // namespace

double film_reflectance(double cos_i, const FilmIndices& n, double thickness, double wavelength) noexcept {
    return FilmStack::make(cos_i, n).reflectance(thickness, wavelength);
}

MetalIndex metal_index_of(double normal, double at_82) noexcept {
    const double r = clamp_to(normal, 0.0, 0.999), root_r = std::sqrt(r);
    const double least = (1 - r) / (1 + r), most = (1 + root_r) / (1 - root_r);
    MetalIndex best;
    double nearest = kInfinity;
    constexpr int kSteps = 256;
    for (int i = 0; i <= kSteps; ++i) {
        // Most of what changes does so at small n.
        const double t = static_cast<double>(i) / kSteps, n = least + (most - least) * t * t * t;
        const double squared = (r * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - r);
        const MetalIndex index{n, std::sqrt(max_of(squared, 0.0))};
        const double error = std::fabs(fresnel_conductor(1 / 7.0, index.n, index.k) - at_82);
        if (error < nearest) nearest = error, best = index;
    }
    return best;
}

FilmOnDielectric::FilmOnDielectric(const FilmIndices& n, double thickness, double weight, double bare, bool refracts) {
    const Wavelengths wavelengths(thickness);
    for (size_t i = 0; i < table_.size(); ++i) {
        const double mu = cosine_of(i, table_.size());
        const double inside = std::sqrt(1 - (1 - mu) * (1 + mu) / (n.outside * n.outside));
        const Vec3d color = wavelengths.color(FilmStack::make(refracts ? inside : mu, n), thickness);
        const double rest = (1 - weight) * fresnel_dielectric(mu, bare);
        table_[i] = {clamped(rest + weight * clamped(color.x)), clamped(rest + weight * clamped(color.y)),
                     clamped(rest + weight * clamped(color.z))};
    }
}

Rgb FilmOnDielectric::reflectance(double mu) const noexcept {
    return Between(std::sqrt(clamp_to(mu, 0.0, 1.0)), table_.size())(table_.data());
}

FilmOnMetal::FilmOnMetal(double outside, double film, double thickness, Rgb tint_82) {
    const Wavelengths wavelengths(thickness);
    table_.resize(kNormals * kCosines);
    for (size_t i = 0; i < kNormals; ++i) {
        const double normal = double(i) / double(kNormals - 1);
        for (int c = 0; c < 3; ++c) {
            const MetalIndex metal = metal_index_of(normal, at_82_of(normal, tint_82[c]));
            const bool known = c > 0 && tint_82[c] == tint_82[c - 1];
            static constexpr double Vec3d::*kChannel[] = {&Vec3d::x, &Vec3d::y, &Vec3d::z};
            for (size_t j = 0; j < kCosines; ++j) {
                Rgb& entry = table_[i * kCosines + j];
                if (known && tint_82.g == tint_82.r) continue;
                const double mu = cosine_of(j, kCosines);
                const double inside = std::sqrt(1 - (1 - mu) * (1 + mu) / (outside * outside));
                const FilmStack stack = FilmStack::make(inside, {outside, film, metal.n * outside, metal.k * outside});
                const Vec3d color = wavelengths.color(stack, thickness);
                if (c == 0) entry = {clamped(color.x), clamped(color.y), clamped(color.z)};
                entry[c] = clamped(color.*kChannel[c]);
            }
        }
        double sum[3] = {};
        for (int k = 0; k < 256; ++k)
            for (int c = 0; c < 3; ++c) {
                const double mu = (k + 0.5) / 256;
                sum[c] += 2 * mu / 256 * Between(std::sqrt(mu), kCosines)(table_.data() + i * kCosines)[c];
            }
        mean_[i] = {clamped(sum[0]), clamped(sum[1]), clamped(sum[2])};
    }
}

Rgb FilmOnMetal::reflectance(double mu, Rgb normal) const noexcept {
    const Between cosine(std::sqrt(clamp_to(mu, 0.0, 1.0)), kCosines);
    Rgb out;
    for (int c = 0; c < 3; ++c) {
        const Between row(static_cast<double>(normal[c]), kNormals);
        const Rgb* first = table_.data() + row.first * kCosines;
        out[c] = cosine(first)[c] * (1 - row.f) + cosine(first + kCosines)[c] * row.f;
    }
    return out;
}

Rgb FilmOnMetal::mean(Rgb normal) const noexcept {
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = Between(static_cast<double>(normal[c]), kNormals)(mean_.data())[c];
    return out;
}

}  // namespace steradian
