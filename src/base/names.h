// The names of settings as files and the command line spell them: one table for reading, writing and suggesting.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "steradian/settings.h"

namespace steradian {

/// Specialised for every kind; names in the order of the enumerators.
template <class Kind>
constexpr std::span<const std::string_view> names_of() noexcept;

namespace detail {
inline constexpr std::array<std::string_view, 9> kIntegratorNames{"path", "direct", "ao",        "normals", "albedo",
                                                                  "uv",   "depth",  "primitive", "cost"};
inline constexpr std::array<std::string_view, 3> kLightSamplingNames{"mis", "light", "bsdf"};
inline constexpr std::array<std::string_view, 3> kLightChoiceNames{"bvh", "power", "uniform"};
inline constexpr std::array<std::string_view, 2> kSamplerNames{"sobol", "independent"};
inline constexpr std::array<std::string_view, 4> kFilterNames{"box", "tent", "gaussian", "mitchell"};
inline constexpr std::array<std::string_view, kAovs> kAovNames{"alpha",
                                                               "albedo",
                                                               "normal",
                                                               "depth",
                                                               "position",
                                                               "uv",
                                                               "object",
                                                               "material",
                                                               "primitive",
                                                               "emission",
                                                               "background",
                                                               "diffuse_direct",
                                                               "diffuse_indirect",
                                                               "specular_direct",
                                                               "specular_indirect",
                                                               "transmission_direct",
                                                               "transmission_indirect",
                                                               "variance",
                                                               "samples",
                                                               "crypto_object",
                                                               "crypto_material"};
inline constexpr std::array<std::string_view, 4> kBuilderNames{"sah", "median", "fast", "high-quality"};
inline constexpr std::array<std::string_view, 2> kLayoutNames{"full", "compact"};
inline constexpr std::array<std::string_view, 6> kIsaNames{"auto", "scalar", "sse4", "avx2", "avx512", "neon"};
}  // namespace detail

template <>
constexpr std::span<const std::string_view> names_of<IntegratorKind>() noexcept {
    return detail::kIntegratorNames;
}
template <>
constexpr std::span<const std::string_view> names_of<LightSampling>() noexcept {
    return detail::kLightSamplingNames;
}
template <>
constexpr std::span<const std::string_view> names_of<LightChoice>() noexcept {
    return detail::kLightChoiceNames;
}
template <>
constexpr std::span<const std::string_view> names_of<SamplerKind>() noexcept {
    return detail::kSamplerNames;
}
template <>
constexpr std::span<const std::string_view> names_of<FilterKind>() noexcept {
    return detail::kFilterNames;
}
template <>
constexpr std::span<const std::string_view> names_of<Aov>() noexcept {
    return detail::kAovNames;
}
template <>
constexpr std::span<const std::string_view> names_of<BvhBuilder>() noexcept {
    return detail::kBuilderNames;
}
template <>
constexpr std::span<const std::string_view> names_of<BvhLayout>() noexcept {
    return detail::kLayoutNames;
}
template <>
constexpr std::span<const std::string_view> names_of<Isa>() noexcept {
    return detail::kIsaNames;
}

template <class Kind>
constexpr std::string_view name_of(Kind kind) noexcept {
    return names_of<Kind>()[static_cast<size_t>(kind)];
}

template <class Kind>
constexpr std::optional<Kind> find_name(std::string_view name) noexcept {
    const auto names = names_of<Kind>();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return static_cast<Kind>(found - names.begin());
}

/// "albedo,normal", in the order of the enumerators.
inline std::string names_in(AovSet aovs) {
    std::string out;
    for (uint32_t i = 0; i < kAovs; ++i)
        if (const auto aov = static_cast<Aov>(i); aovs.has(aov))
            out += (out.empty() ? "" : ",") + std::string(name_of(aov));
    return out;
}

/// The radius in pixels that a filter has when nothing is said.
constexpr float default_filter_radius(FilterKind kind) noexcept {
    switch (kind) {
        case FilterKind::box:
            return 0.5f;
        case FilterKind::tent:
            return 1.0f;
        case FilterKind::gaussian:
            return 1.5f;
        case FilterKind::mitchell:
            return 2.0f;
    }
    return 1.0f;
}

}  // namespace steradian
