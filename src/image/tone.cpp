#include "image/tone.h"

#include <bit>
#include <cmath>

#include "image/view.h"
#include "math/elementary.h"

namespace steradian {
namespace {

constexpr std::string_view kNames[] = {"srgb", "agx", "aces", "neutral", "reinhard"};

using Matrix = double[3][3];

Rgb multiply(const Matrix& m, Rgb c) {
    const auto row = [&](int i) { return static_cast<float>(m[i][0] * c.r + m[i][1] * c.g + m[i][2] * c.b); };
    return {row(0), row(1), row(2)};
}

template <class F>
Rgb each(Rgb c, F f) {
    return {f(c.r), f(c.g), f(c.b)};
}

/// 2^stops, exact for whole stops.
float exposure_scale(float stops) {
    const float whole = std::floor(clamp_to(stops, -256.0f, 256.0f));
    const float rest = clamp_to(stops, -256.0f, 256.0f) - whole;
    const double fraction = rest == 0 ? 1.0 : math::pow(2.0, static_cast<double>(rest));
    return static_cast<float>(std::ldexp(fraction, static_cast<int>(whole)));
}

// AgX (Troy Sobotka), base look, as fitted by Benjamin Wrensch, "Minimal AgX Implementation" (2023): inset matrix, a
// log2 range of [-12.47393, 4.026069] stops, a sixth-order polynomial for the sigmoid (mean squared error 3.7e-6),
// outset matrix; the result is display-encoded with a power of 2.2, undone here.
float agx_curve(float x) {
    const double v = x;
    const double y = ((((((15.5 * v - 40.14) * v + 31.96) * v - 6.868) * v + 0.4298) * v + 0.1191) * v) - 0.00232;
    return static_cast<float>(y);
}

Rgb agx(Rgb c) {
    static constexpr Matrix kInset = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                      {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                      {0.0423756549057051, 0.0784336, 0.879142973793104}};
    static constexpr Matrix kOutset = {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                                       {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                                       {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
    constexpr double kMinStops = -12.47393, kMaxStops = 4.026069;
    const Rgb encoded = each(multiply(kInset, c), [](float x) {
        const double stops = math::log2(max_of(static_cast<double>(x), 1e-10));
        const double range = clamp_to((stops - kMinStops) / (kMaxStops - kMinStops), 0.0, 1.0);
        return agx_curve(static_cast<float>(range));
    });
    return each(multiply(kOutset, encoded),
                [](float x) { return static_cast<float>(math::pow(max_of(static_cast<double>(x), 0.0), 2.2)); });
}

// The fit of ACES' RRT and sRGB ODT by Stephen Hill (BakingLab, 2016): saturation and primaries in two matrices, the
// curve as a quotient of quadratics.
Rgb aces(Rgb c) {
    static constexpr Matrix kInput = {
        {0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}};
    static constexpr Matrix kOutput = {
        {1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}};
    const Rgb curved = each(multiply(kInput, c), [](float x) {
        const double v = x;
        return static_cast<float>((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
    });
    return multiply(kOutput, curved);
}

// Khronos PBR Neutral (specification 1.0, 2024).
Rgb neutral(Rgb c) {
    constexpr float kStartCompression = 0.8f - 0.04f;
    constexpr float kDesaturation = 0.15f;
    const float x = min_of(c.r, min_of(c.g, c.b));
    const float offset = x < 0.08f ? x - 6.25f * x * x : 0.04f;
    c = c + Rgb{-offset, -offset, -offset};
    const float peak = max_component(c);
    if (peak < kStartCompression) return c;
    const float d = 1 - kStartCompression;
    const float new_peak = 1 - d * d / (peak + d - kStartCompression);
    c = c * (new_peak / peak);
    const float g = 1 - 1 / (kDesaturation * (peak - new_peak) + 1);
    return c * (1 - g) + Rgb{new_peak, new_peak, new_peak} * g;
}

// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equation 3, on the luminance.
Rgb reinhard(Rgb c) { return c * (1 / (1 + luminance(c))); }

}  // namespace

std::span<const std::string_view> view_names() noexcept { return kNames; }

float srgb_encode(float linear) noexcept {
    const double x = clamp_to(linear, 0.0f, 1.0f);
    const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * math::pow(x, 1 / 2.4) - 0.055;
    return static_cast<float>(y);
}

float srgb_decode(float encoded) noexcept {
    const double x = encoded;
    const double y = x <= 0.04045 ? x / 12.92 : math::pow((x + 0.055) / 1.055, 2.4);
    return static_cast<float>(y);
}

Rgb View::operator()(Rgb scene_linear) const noexcept {
    // The views are made for what light can be: nothing below 0, and finite sums of three.
    const auto limit = [&](float x) { return clamp_to(x * scale, 0.0f, 1e30f); };
    Rgb c = each(scene_linear, limit);
    switch (kind) {
        case ViewKind::srgb:
            break;
        case ViewKind::agx:
            c = agx(c);
            break;
        case ViewKind::aces:
            c = aces(c);
            break;
        case ViewKind::neutral:
            c = neutral(c);
            break;
        case ViewKind::reinhard:
            c = reinhard(c);
            break;
    }
    return each(c, [](float x) { return clamp_to(x, 0.0f, 1.0f); });
}

std::optional<View> find_view(std::string_view name, float exposure) noexcept {
    for (size_t i = 0; i < std::size(kNames); ++i)
        if (kNames[i] == name) return View{static_cast<ViewKind>(i), exposure_scale(exposure)};
    return std::nullopt;
}

Rgb apply_view(std::string_view view, Rgb scene_linear, float exposure) noexcept {
    return find_view(view, exposure).value_or(View{})(scene_linear);
}

SrgbQuantizer::SrgbQuantizer() noexcept {
    step_[0] = 0;
    // Bisection over the bit patterns of the floats in [0, 1], which are ordered as their values are.
    uint32_t low = 0;
    for (int k = 1; k < 256; ++k) {
        uint32_t below = low, reached = std::bit_cast<uint32_t>(1.0f);
        while (reached - below > 1) {
            const uint32_t middle = below + (reached - below) / 2;
            const float quantized = std::floor(srgb_encode(std::bit_cast<float>(middle)) * 255.0f + 0.5f);
            (quantized >= static_cast<float>(k) ? reached : below) = middle;
        }
        step_[k] = std::bit_cast<float>(reached);
        low = below;
    }
}

uint8_t SrgbQuantizer::operator()(float linear) const noexcept {
    int k = 0;
    for (int bit = 128; bit > 0; bit >>= 1)
        if (linear >= step_[k + bit]) k += bit;
    return static_cast<uint8_t>(k);
}

}  // namespace steradian
