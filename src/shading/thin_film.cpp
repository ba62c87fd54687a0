#include "shading/thin_film.h"

#include <array>

#include "base/parallel.h"
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

/// What the film and its base do whatever the wavelength and the thickness, for light from one direction.
struct FilmStack {
    Amplitudes upper, lower;
    double film_cosine;  ///< times the film's index; 0 and more where light gets into it
    double decay;        ///< likewise where it does not

    static FilmStack make(double cos_i, const FilmIndices& n) {
        const double mu = clamp_to(cos_i, 1e-6, 1.0), along = n.outside * n.outside * (1 - mu) * (1 + mu);
        const Complex n1{n.outside, 0}, n2{n.film, 0}, n3{n.base, n.base_k}, shift{along, 0};
        const Complex nc1{n.outside * mu, 0}, nc2 = root(n2 * n2 - shift), nc3 = root(n3 * n3 - shift);
        return {{n1, nc1, n2, nc2}, {n2, nc2, n3, nc3}, nc2.re, nc2.im};
    }

    double reflectance(double thickness, double wavelength) const {
        const double turn = 4 * std::numbers::pi * thickness / wavelength;
        const double size = math::exp(-turn * decay), angle = turn * film_cosine;
        const Complex phase{size * math::cos(angle), size * math::sin(angle)};
        const auto airy = [&](Complex r12, Complex r23) {
            const Complex again = r23 * phase;
            return ((r12 + again) / (Complex{1, 0} + r12 * again)).norm();
        };
        return clamp_to((airy(upper.s, lower.s) + airy(upper.p, lower.p)) / 2, 0.0, 1.0);
    }
};

/// Of one polarisation, where light gets into the film: with the amplitudes a, real, and b of its two sides and the
/// phase φ that the way through the film adds, Airy's sum is 1 - (1 - a²) (1 - |b|²) / (1 + a² |b|² + 2 a Re(b e^iφ)).
struct Fringes {
    double passed, twice, re, im;
    Fringes(Complex a, Complex b)
        : passed((1 - a.re * a.re) * (1 - b.norm())),
          twice(a.re * a.re * b.norm()),
          re(2 * a.re * b.re),
          im(2 * a.re * b.im) {}
    double at(Complex phase) const { return passed > 0 ? 1 - passed / (1 + twice + re * phase.re - im * phase.im) : 1; }
    /// The mean over all phases.
    double mean() const { return passed > 0 ? 1 - passed / (1 - twice) : 1; }
};

/// The spectrum at wave numbers that are evenly spaced, and what each adds to the channels of white light.
class Spectrum {
public:
    /// Beyond this difference between paths, in micrometres, interference changes no channel by more than a thousandth
    /// of the difference between fringes.
    static constexpr double kLongestPath = 16;
    /// Fine enough for that path, or the longest one.
    explicit Spectrum(double path) {
        const double count = 128 * std::ceil(clamp_to(path / 4, 1.0, kLongestPath / 4));
        first_ = 1 / kLongestWavelength, step_ = (1 / kShortestWavelength - first_) / count;
        first_ += step_ / 2;
        Vec3d sum;
        for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
            const double wavelength = 1 / (first_ + step_ * double(i));
            weight_.push_back(rgb_response(wavelength) * (wavelength * wavelength));
            sum = sum + weight_.back();
        }
        for (Vec3d& w : weight_) w = {w.x / sum.x, w.y / sum.y, w.z / sum.z};
        phase_.resize(weight_.size());
    }

    /// Of light that gets into the film. `path` is longer by this for the light that has gone through it.
    Vec3d color(const FilmStack& stack, double path) {
        const Fringes s(stack.upper.s, stack.lower.s), p(stack.upper.p, stack.lower.p);
        if (path > kLongestPath) {
            const double mean = (s.mean() + p.mean()) / 2;
            return {mean, mean, mean};
        }
        turn(path);
        Vec3d out;
        for (size_t i = 0; i < weight_.size(); ++i) out = out + weight_[i] * ((s.at(phase_[i]) + p.at(phase_[i])) / 2);
        return out;
    }

private:
    void turn(double path) {
        if (path == path_) return;
        path_ = path;
        const auto unit = [&](double turns) {
            const double angle = 2 * std::numbers::pi * path * turns;
            return Complex{math::cos(angle), math::sin(angle)};
        };
        const Complex by = unit(step_);
        phase_[0] = unit(first_);
        for (size_t i = 1; i < phase_.size(); ++i) phase_[i] = phase_[i - 1] * by;
    }

    double first_, step_;  ///< wave numbers
    std::vector<Vec3d> weight_;
    std::vector<Complex> phase_;
    double path_ = -1;  ///< of the phases
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

/// The cosine in a medium of light from vacuum with that cosine.
double refracted_into(double index, double mu) { return std::sqrt(1 - (1 - mu) * (1 + mu) / (index * index)); }

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

namespace {

constexpr double kFade = 3;  // micrometres of path

/// Paths in the scale in which thicknesses are evenly spaced, and back.
double scale_of(double path) { return path <= kFade ? path : kFade * (2 - kFade / path); }
double path_of(double scale) { return scale <= kFade ? scale : kFade / (2 - scale / kFade); }

}  // namespace

FilmThicknesses::FilmThicknesses(double film_index, double a, double b)
    : path_(2 * film_index), thinnest_(min_of(a, b)), thickest_(max_of(a, b)), first_(scale_of(path_ * thinnest_)) {
    constexpr double kBlue = 0.45;
    const double size = scale_of(path_ * thickest_) - first_;
    if (!(size > 0)) return;
    const double steps = std::ceil(size / kBlue * kFilmsPerFringe);
    step_ = size / steps;
    count_ = static_cast<size_t>(steps) + 1;
}

double FilmThicknesses::operator[](size_t i) const noexcept {
    if (i == 0) return thinnest_;
    return i + 1 == count_ ? thickest_ : path_of(first_ + step_ * double(i)) / path_;
}

FilmPlace FilmThicknesses::place(double thickness) const noexcept {
    if (count_ == 1) return {};
    const double t = clamp_to((scale_of(path_ * thickness) - first_) / step_, 0.0, double(count_ - 1));
    const auto first = static_cast<uint32_t>(min_of(t, double(count_ - 2)));
    return {first, static_cast<float>(t - first)};
}

FilmOnDielectric::FilmOnDielectric(const FilmIndices& n, const FilmThicknesses& thicknesses, bool refracts) {
    table_.resize(thicknesses.count() * kCosines);
    parallel_for(thicknesses.count(), 1, [&](size_t k, size_t) {
        const double path = 2 * thicknesses[k];
        Spectrum spectrum(path * n.film);
        for (size_t i = 0; i < kCosines; ++i) {
            const double mu = cosine_of(i, kCosines);
            const FilmStack stack = FilmStack::make(refracts ? refracted_into(n.outside, mu) : mu, n);
            const Vec3d color = spectrum.color(stack, path * stack.film_cosine);
            table_[k * kCosines + i] = {clamped(color.x), clamped(color.y), clamped(color.z)};
        }
    });
}

Rgb FilmOnDielectric::reflectance(double mu, FilmPlace place) const noexcept {
    const Between cosine(std::sqrt(clamp_to(mu, 0.0, 1.0)), kCosines);
    const Rgb* row = table_.data() + place.first * kCosines;
    const Rgb thinner = cosine(row);
    return place.f > 0 ? thinner * (1 - place.f) + cosine(row + kCosines) * place.f : thinner;
}

FilmOnMetal::FilmOnMetal(double outside, double film, const FilmThicknesses& thicknesses, Rgb tint_82) {
    const bool grey = tint_82.r == tint_82.g && tint_82.g == tint_82.b;
    std::array<std::array<FilmIndices, 3>, kNormals> n;
    for (size_t i = 0; i < kNormals; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double normal = double(i) / double(kNormals - 1);
            const MetalIndex metal = metal_index_of(normal, at_82_of(normal, tint_82[int(c)]));
            n[i][c] = {outside, film, metal.n * outside, metal.k * outside};
        }
    table_.resize(thicknesses.count() * kNormals * kCosines);
    mean_.resize(thicknesses.count() * kNormals);
    parallel_for(thicknesses.count(), 1, [&](size_t k, size_t) {
        const double path = 2 * thicknesses[k];
        Spectrum spectrum(path * film);
        for (size_t j = 0; j < kCosines; ++j) {
            const double inside = refracted_into(outside, cosine_of(j, kCosines));
            for (size_t i = 0; i < kNormals; ++i) {
                const auto color = [&](size_t c) {
                    const FilmStack stack = FilmStack::make(inside, n[i][c]);
                    return spectrum.color(stack, path * stack.film_cosine);
                };
                const Vec3d r = color(0), g = grey ? r : color(1), b = grey ? r : color(2);
                table_[(k * kNormals + i) * kCosines + j] = {clamped(r.x), clamped(g.y), clamped(b.z)};
            }
        }
        for (size_t row = k * kNormals; row < (k + 1) * kNormals; ++row) mean_[row] = mean_of(row);
    });
}

Rgb FilmOnMetal::mean_of(size_t row) const {
    constexpr int kSteps = 256;
    double sum[3] = {};
    for (int k = 0; k < kSteps; ++k) {
        const double mu = (k + 0.5) / kSteps;
        const Rgb color = Between(std::sqrt(mu), kCosines)(table_.data() + row * kCosines);
        for (int c = 0; c < 3; ++c) sum[c] += 2 * mu / kSteps * color[c];
    }
    return {clamped(sum[0]), clamped(sum[1]), clamped(sum[2])};
}

Rgb FilmOnMetal::reflectance(double mu, Rgb normal, FilmPlace place) const noexcept {
    const Between cosine(std::sqrt(clamp_to(mu, 0.0, 1.0)), kCosines);
    const auto of = [&](size_t thickness) {
        Rgb out;
        for (int c = 0; c < 3; ++c) {
            const Between row(static_cast<double>(normal[c]), kNormals);
            const Rgb* first = table_.data() + (thickness * kNormals + row.first) * kCosines;
            out[c] = cosine(first)[c] * (1 - row.f) + cosine(first + kCosines)[c] * row.f;
        }
        return out;
    };
    const Rgb thinner = of(place.first);
    return place.f > 0 ? thinner * (1 - place.f) + of(place.first + 1) * place.f : thinner;
}

Rgb FilmOnMetal::mean(Rgb normal, FilmPlace place) const noexcept {
    const auto of = [&](size_t thickness) {
        Rgb out;
        for (int c = 0; c < 3; ++c)
            out[c] = Between(static_cast<double>(normal[c]), kNormals)(mean_.data() + thickness * kNormals)[c];
        return out;
    };
    const Rgb thinner = of(place.first);
    return place.f > 0 ? thinner * (1 - place.f) + of(place.first + 1) * place.f : thinner;
}

}  // namespace steradian
