// How a picture is to be made, as plain data. Together with the scene and the seed it determines every bit of it,
// except for the fields of Execution, which never change a pixel.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

namespace steradian {

/// All light; light without detours; ambient occlusion; and what camera rays find, to look for faults in a scene.
enum class IntegratorKind : uint8_t { path, direct, ao, normals, albedo, uv, depth, primitive, cost };
/// How `path` finds lights with an extent: by directions that they are asked for and directions that surfaces prefer,
/// put together by multiple importance sampling, or by one of the two alone (for comparisons; the mean is the same).
enum class LightSampling : uint8_t { mis, light, bsdf };
/// How `path` chooses one of many lights: by what each may bring to a point, by their flux, or all alike. The mean is
/// the same.
enum class LightChoice : uint8_t { bvh, power, uniform };
enum class SamplerKind : uint8_t { sobol, independent };
enum class FilterKind : uint8_t { box, tent, gaussian, mitchell };

/// What a picture may have beside its colour, each in channels of its own; docs/aovs.md says what they hold.
enum class Aov : uint8_t {
    alpha,
    albedo,
    normal,
    depth,
    position,
    uv,
    object,
    material,
    primitive,
    emission,
    background,
    diffuse_direct,
    diffuse_indirect,
    specular_direct,
    specular_indirect,
    transmission_direct,
    transmission_indirect,
    variance,
    samples,
    crypto_object,
    crypto_material
};
inline constexpr uint32_t kAovs = 21;

class AovSet {
public:
    constexpr AovSet() = default;
    constexpr AovSet(std::initializer_list<Aov> aovs) {
        for (const Aov aov : aovs) add(aov);
    }
    static constexpr AovSet all() {
        AovSet out;
        out.bits_ = (1u << kAovs) - 1;
        return out;
    }
    constexpr void add(Aov aov) { bits_ |= 1u << static_cast<uint32_t>(aov); }
    constexpr bool has(Aov aov) const { return (bits_ >> static_cast<uint32_t>(aov) & 1) != 0; }
    constexpr bool has_any(AovSet other) const { return (bits_ & other.bits_) != 0; }
    constexpr bool empty() const { return bits_ == 0; }
    bool operator==(const AovSet&) const = default;

private:
    uint32_t bits_ = 0;
};

/// Radius in pixels. The Gaussian has a standard deviation of a third of its radius and is shifted down to reach 0
/// at the radius; Mitchell has B = C = 1/3.
struct Filter {
    FilterKind kind = FilterKind::gaussian;
    float radius = 1.5f;
    bool operator==(const Filter&) const = default;
};

/// Pixels [x0, x1) × [y0, y1) of the full picture, from its top left corner.
struct Crop {
    uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool operator==(const Crop&) const = default;
};

struct RenderSettings {
    uint32_t width = 512;
    uint32_t height = 512;
    std::optional<Crop> crop;
    IntegratorKind integrator = IntegratorKind::path;
    uint32_t max_depth = 16;          ///< bounces, specular ones too: 0 emission, 1 direct light; at most kMaxDepth
    uint64_t samples_per_pixel = 64;  ///< 1 … kMaxSamplesPerPixel
    SamplerKind sampler = SamplerKind::sobol;
    uint64_t seed = 0;
    LightSampling light_sampling = LightSampling::mis;
    LightChoice light_choice = LightChoice::bvh;
    uint32_t roulette_depth = 4;  ///< bounces that Russian roulette lets pass; from max_depth on there is none
    /// Most that one connection to a light adds as indirect light (`path`; 0: no limit). Makes the picture biased.
    float clamp = 0;
    float ao_distance = 0;  ///< metres; `ao` counts what is nearer. 0: anything
    Filter filter;
    uint32_t camera = 0;  ///< index into Scene::cameras
    AovSet aovs;          ///< of `path` and `direct`; the colour stays the same to the bit
    /// The error √mean(Var / (I + 0.01)²) over pixels and channels up to which the picture is sampled, each 8 × 8
    /// pixels as much as they need; 0: all pixels alike. samples_per_pixel is then the most that a pixel gets. Samples
    /// are spread over kReplicates independent sequences, so such a picture is another one than without a target. Not
    /// together with Execution::time_limit, for what a pixel gets must not depend on the time.
    float target_error = 0;
};

/// Sequences of a pixel from which the error is estimated: sample i belongs to number i mod kReplicates.
inline constexpr uint32_t kReplicates = 8;
inline constexpr double kMinTargetError = 1e-5, kMaxTargetError = 10;
/// The most samples of a pixel where there is a target and nobody says how many.
inline constexpr uint64_t kDefaultMostSamples = 65536;
/// At least two for each replicate.
inline constexpr uint64_t kLeastMostSamples = 2 * kReplicates;

inline constexpr uint64_t kMaxSamplesPerPixel = 1'000'000'000;
inline constexpr uint32_t kMaxDepth = 65535;  ///< bounces
inline constexpr double kMaxClamp = 1e30, kMaxAoDistance = 1e30;
inline constexpr double kMinFilterRadius = 0.01, kMaxFilterRadius = 32;  ///< pixels
inline constexpr uint32_t kMaxResolution = 1u << 20;                     ///< of one side
inline constexpr uint64_t kMaxPixels = uint64_t(1) << 30;                ///< width × height

/// `fast` takes about two thirds of the time of `sah` to build. `high_quality` takes about six times as long, and about
/// twice the memory meanwhile; its hierarchy is faster to trace, the more so the more the boxes of the primitives
/// overlap.
enum class BvhBuilder : uint8_t { sah, median, fast, high_quality };

/// How the hierarchy lies in memory: as it is, or in fewer bytes at the price of some speed.
enum class BvhLayout : uint8_t { full, compact };

/// Which instructions the ray kernels use; all compute the same bits. `automatic` is the best that the machine has,
/// unless the environment variable STERADIAN_ISA names another one.
enum class Isa : uint8_t { automatic, scalar, sse4, avx2, avx512, neon };

inline constexpr double kMinTimeLimit = 0.001, kMaxTimeLimit = 1e9;  ///< seconds
inline constexpr uint32_t kMaxFireflies = 10000;

/// What may differ from run to run without changing the picture.
struct Execution {
    uint32_t threads = 0;     ///< 0: as many as the machine has
    uint32_t tile_size = 16;  ///< pixels, 1 … 256
    BvhBuilder bvh = BvhBuilder::sah;
    uint32_t bvh_max_depth = 64;
    Isa isa = Isa::automatic;
    BvhLayout bvh_layout = BvhLayout::full;
    /// Seconds after which the render ends by itself, in whole passes over the picture and after one at least; 0: none.
    /// It decides how many samples a pixel gets and nothing else: samples_per_pixel, when that is not reached before,
    /// becomes that number.
    double time_limit = 0;
    uint32_t fireflies = 0;  ///< how many of the brightest samples the statistics list, 0 … kMaxFireflies
};

}  // namespace steradian
