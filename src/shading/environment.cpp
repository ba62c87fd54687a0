#include "shading/environment.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "shading/texture.h"

namespace steradian {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
/// Of the light, above the mean: a sky that has less is even, and compensation would only make it coarse.
constexpr double kLeastCompensated = 1e-3;
/// Of a surface's irradiance, from what is above the mean: where it has less, the rest is worth its light samples.
constexpr double kLeastShare = 0.25;
/// A sky is about this many parts wide and half as many high, for the irradiance it casts.
constexpr size_t kParts = 64;

/// Texels as light: nothing below zero (texel() has already made 0 of what is not finite).
Rgb light_texel(const RawImage& image, ColorSpace space, uint32_t x, uint32_t y) {
    const Rgb c = texel(image, space, x, y);
    return {max_of(c.r, 0.0f), max_of(c.g, 0.0f), max_of(c.b, 0.0f)};
}

/// The mean over a texel of the interpolation between its own value and its neighbours'.
double tent_mean(double before, double own, double after) { return 0.125 * before + 0.75 * own + 0.125 * after; }

/// The index of the first cumulative value above x, or the last. By halves without a branch, which would be guessed
/// wrong every other time.
size_t find_interval(const double* begin, size_t count, double x) {
    const double* at = begin;
    for (size_t left = count; left > 1;) {
        const size_t half = left / 2;
        at += at[half - 1] <= x ? half : 0;
        left -= half;
    }
    return static_cast<size_t>(at - begin);
}

/// 24 uniform bits, refined by 16 more.
double refine(float u, uint32_t bits16) { return static_cast<double>(u) + (bits16 + 0.5) * 0x1p-40; }

}  // namespace

std::shared_ptr<const EnvironmentTable> EnvironmentTable::make(const Scene& scene, const EnvironmentLight& light,
                                                               Diagnostics& diagnostics) {
    auto table = std::make_shared<EnvironmentTable>();
    const Affine turn = rotation_degrees(light.rotation, {0, 1, 0});
    table->cos_rotation_ = turn.m[0][0];
    table->sin_rotation_ = turn.m[0][2];
    table->scale_ = light.radiance;
    table->image_ = light.image;
    table->color_space_ = light.color_space;
    table->empty_ = steradian::is_black(light.radiance);
    if (!light.image) return table;

    const RawImage& image = scene.images[index(*light.image)];
    if (const uint64_t bad = count_bad_texels(image, /*negative_too=*/true); bad > 0)
        diagnostics.warn("environment image: texels that are not finite or are negative count as 0", {}, bad);
    table->tabulate(image);
    return table;
}

void EnvironmentTable::tabulate(const RawImage& image) {
    width_ = image.width;
    height_ = image.height;
    const size_t w = width_, h = height_;
    cos_theta_.resize(h + 1);
    for (size_t y = 0; y <= h; ++y)
        cos_theta_[y] = math::cos(std::numbers::pi * static_cast<double>(y) / static_cast<double>(h));
    cos_theta_[0] = 1;
    cos_theta_[h] = -1;
    complete_.cells.resize(w * h);
    parallel_for(h, 16, [&](size_t begin, size_t end) {
        // Luminance of the row above, the row itself and the row below, averaged along the row.
        std::array<std::vector<double>, 3> window;
        std::vector<double> raw(w);
        const auto read_row = [&](size_t y, std::vector<double>& out) {
            for (size_t x = 0; x < w; ++x)
                raw[x] = static_cast<double>(luminance(
                    light_texel(image, color_space_, static_cast<uint32_t>(x), static_cast<uint32_t>(y)) * scale_));
            out.resize(w);
            for (size_t x = 0; x < w; ++x)
                out[x] = tent_mean(raw[x > 0 ? x - 1 : w - 1], raw[x], raw[x + 1 < w ? x + 1 : 0]);
        };
        read_row(begin > 0 ? begin - 1 : 0, window[0]);
        read_row(begin, window[1]);
        for (size_t y = begin; y < end; ++y) {
            read_row(y + 1 < h ? y + 1 : y, window[2]);
            const double band = cos_theta_[y] - cos_theta_[y + 1];
            double sum = 0;
            for (size_t x = 0; x < w; ++x) {
                sum += tent_mean(window[0][x], window[1][x], window[2][x]) * band;
                complete_.cells[y * w + x] = sum;
            }
            std::swap(window[0], window[1]);
            std::swap(window[1], window[2]);
        }
    });
    const double total = complete_.finish(w);
    // A total that is not finite or is vanishing cannot be divided by.
    if (!(total > 1e-300) || !std::isfinite(total)) empty_ = true;
    if (!empty_) compensate();
}

/// To what lies above the mean over the sphere.
void EnvironmentTable::compensate() {
    const size_t w = width_, h = height_;
    const double mean = complete_.rows.back() / (2.0 * static_cast<double>(w));
    compensated_.cells.resize(w * h);
    parallel_for(h, 16, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) {
            const double even = mean * (cos_theta_[y] - cos_theta_[y + 1]);
            double sum = 0;
            for (size_t x = 0; x < w; ++x) {
                sum += max_of(complete_.cell(width_, uint32_t(x), uint32_t(y)) - even, 0.0);
                compensated_.cells[y * w + x] = sum;
            }
        }
    });
    if (!(compensated_.finish(w) > kLeastCompensated * complete_.rows.back())) compensated_ = {};
    if (!compensated_.rows.empty()) above_ = share_above();
}

namespace {

/// Neighbouring texels as one part, or a texel as several: about `wanted` parts along one side of an image.
struct Division {
    size_t texels, per_texel, parts;

    Division(size_t along, size_t wanted)
        : texels(along), per_texel((wanted + along - 1) / along), parts(per_texel > 1 ? along * per_texel : wanted) {}
    /// Where a part begins and the one before it ends, in texels; between texels where none is divided.
    double border(size_t part) const {
        return per_texel > 1 ? double(part) / double(per_texel) : double(first_texel(part));
    }
    size_t first_texel(size_t part) const { return part * texels / parts; }
    size_t end_texel(size_t part) const { return max_of(first_texel(part + 1), first_texel(part) + 1); }
};

}  // namespace

IrradianceShare EnvironmentTable::share_above() const {
    const Division columns(width_, kParts), rows(height_, kParts / 2);
    std::vector<SkyPart> parts(columns.parts * rows.parts);
    parallel_for(rows.parts, 1, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row) {
            const size_t y0 = rows.first_texel(row), y1 = rows.end_texel(row);
            const double top = math::cos(std::numbers::pi * rows.border(row) / height_);
            const double bottom = math::cos(std::numbers::pi * rows.border(row + 1) / height_);
            // Of its texels' light: by height, as within a texel.
            const double part_of_texels =
                (top - bottom) / (cos_theta_[y0] - cos_theta_[y1]) / double(columns.per_texel);
            const double height = 0.5 * (top + bottom), radius = std::sqrt(max_of(1 - height * height, 0.0));
            for (size_t column = 0; column < columns.parts; ++column) {
                const size_t x0 = columns.first_texel(column), x1 = columns.end_texel(column);
                const double middle = 0.5 * (columns.border(column) + columns.border(column + 1)) / width_;
                const math::SinCos phi = math::sin_cos(kTwoPi * (middle - 0.5));
                SkyPart& part = parts[row * columns.parts + column];
                part.direction = from_map({radius * phi.sin, height, -radius * phi.cos});
                for (size_t y = y0; y < y1; ++y) {
                    part.all += part_of_texels * complete_.run(width_, y, x0, x1);
                    part.above += part_of_texels * compensated_.run(width_, y, x0, x1);
                }
            }
        }
    });
    return IrradianceShare(parts);
}

EnvironmentDensity EnvironmentTable::at_surface(EnvironmentDensity wanted, Vec3 n, bool both_sides) const noexcept {
    if (wanted == EnvironmentDensity::complete || compensated_.rows.empty()) return EnvironmentDensity::complete;
    return above_.of(n, both_sides) < kLeastShare ? EnvironmentDensity::complete : EnvironmentDensity::compensated;
}

double EnvironmentTable::CellMasses::finish(size_t width) {
    rows.resize(cells.size() / width);
    double total = 0;
    for (size_t y = 0; y < rows.size(); ++y) rows[y] = total += cells[(y + 1) * width - 1];
    return total;
}

MapPoint EnvironmentTable::map_point(Vec3 d) const noexcept {
    // The map is turned by the rotation; the direction is turned back.
    const double x = cos_rotation_ * d.x - sin_rotation_ * d.z;
    const double z = sin_rotation_ * d.x + cos_rotation_ * d.z;
    const double y = d.y;
    const double s = 0.5 + math::atan2(x, -z) / kTwoPi;
    const double t = math::atan2(std::sqrt(x * x + z * z), y) / std::numbers::pi;
    return {clamp_to(s, 0.0, 1.0), clamp_to(t, 0.0, 1.0)};  // NaN becomes 0
}

Rgb EnvironmentTable::radiance_at(const Scene& scene, MapPoint at) const noexcept {
    const RawImage& image = scene.images[index(*image_)];
    const double fx = at.s * image.width - 0.5, fy = at.t * image.height - 0.5;
    const double x_floor = std::floor(fx), y_floor = std::floor(fy);
    const auto w = static_cast<int64_t>(image.width), h = static_cast<int64_t>(image.height);
    const auto x0 = static_cast<int64_t>(x_floor), y0 = static_cast<int64_t>(y_floor);
    const auto wx = static_cast<float>(fx - x_floor), wy = static_cast<float>(fy - y_floor);
    const auto read = [&](int64_t x, int64_t y) {
        const int64_t column = x < 0 ? x + w : x >= w ? x - w : x;
        return light_texel(image, color_space_, static_cast<uint32_t>(column),
                           static_cast<uint32_t>(clamp_to<int64_t>(y, 0, h - 1)));
    };
    const Rgb upper = read(x0, y0) * (1 - wx) + read(x0 + 1, y0) * wx;
    const Rgb lower = read(x0, y0 + 1) * (1 - wx) + read(x0 + 1, y0 + 1) * wx;
    return (upper * (1 - wy) + lower * wy) * scale_;
}

EnvironmentSample EnvironmentTable::sample(uint32_t choice, Vec2 u, EnvironmentDensity density) const noexcept {
    const CellMasses& of = masses(density);
    const double at_row = refine(u.y, choice >> 16) * of.rows.back();
    const auto y = static_cast<uint32_t>(find_interval(of.rows.data(), height_, at_row));
    const double in_row = at_row - (y > 0 ? of.rows[y - 1] : 0.0);
    const double* row = of.cells.data() + static_cast<size_t>(y) * width_;
    const double at_cell = refine(u.x, choice & 0xffffu) * row[width_ - 1];
    const auto x = static_cast<uint32_t>(find_interval(row, width_, at_cell));
    const double mass = of.cell(width_, x, y);
    const double in_cell = at_cell - (x > 0 ? row[x - 1] : 0.0);

    // What is left of both numbers is uniform within the cell: in the angle about +Y and in the height.
    const double fx = clamp_to(in_cell / mass, 0.0, 1.0), fy = clamp_to(in_row / of.row(y), 0.0, 1.0);
    const double height = cos_theta_[y] + (cos_theta_[y + 1] - cos_theta_[y]) * fy;
    const math::SinCos phi = math::sin_cos(kTwoPi * ((x + fx) / width_ - 0.5));
    const double radius = std::sqrt(max_of((1 - height) * (1 + height), 0.0));
    EnvironmentSample out;
    out.direction = normalize(static_cast<Vec3>(from_map({radius * phi.sin, height, -radius * phi.cos})));
    out.pdf = cell_pdf(of, x, y);
    return out;
}

double EnvironmentTable::cell_pdf(const CellMasses& of, uint32_t x, uint32_t y) const noexcept {
    const double band = cos_theta_[y] - cos_theta_[y + 1];
    return of.cell(width_, x, y) / (of.rows.back() * band) * (width_ / kTwoPi);
}

double EnvironmentTable::pdf_at(MapPoint at, EnvironmentDensity density) const noexcept {
    const double x = clamp_to(std::floor(at.s * width_), 0.0, width_ - 1.0);
    const double y = clamp_to(std::floor(at.t * height_), 0.0, height_ - 1.0);
    return cell_pdf(masses(density), static_cast<uint32_t>(x), static_cast<uint32_t>(y));
}

}  // namespace steradian
