// What the film keeps of a tile: the sums of the colour, and those of the AOVs that were asked for. All of them are
// added up in the order of the samples and folded block by block, so none depends on who computed what when.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <vector>

#include "math/vector.h"
#include "render/cryptomatte.h"
#include "steradian/settings.h"

namespace steradian {

struct RgbSum {
    double r = 0, g = 0, b = 0;
    void add(Rgb value, float weight) {
        r += double(value.r) * double(weight);
        g += double(value.g) * double(weight);
        b += double(value.b) * double(weight);
    }
    RgbSum& operator+=(const RgbSum& other) {
        r += other.r, g += other.g, b += other.b;
        return *this;
    }
    RgbSum& operator*=(double times) {
        r *= times, g *= times, b *= times;
        return *this;
    }
};

/// Of samples X = filter weight × radiance, X² per channel.
struct SquareSum : RgbSum {
    void add(Rgb value, float weight) {
        const auto square = [&](float v) { return double(v) * double(weight) * (double(v) * double(weight)); };
        r += square(value.r), g += square(value.g), b += square(value.b);
    }
};

/// What camera rays have met first, averaged through the filter over its own weights: where all samples agree, the mean
/// is what they agree on, with any filter.
struct FeatureSum {
    double weight = 0, alpha = 0;
    RgbSum albedo, normal;
    FeatureSum& operator+=(const FeatureSum& other) {
        weight += other.weight, alpha += other.alpha;
        albedo += other.albedo, normal += other.normal;
        return *this;
    }
    FeatureSum& operator*=(double times) {
        weight *= times, alpha *= times;
        albedo *= times, normal *= times;
        return *this;
    }
};

/// What makes no sense as an average is taken from one sample: the one nearest to the pixel's centre, of equally near
/// ones the first.
struct CentreSample {
    float distance2 = std::numeric_limits<float>::infinity();  ///< pixels²; infinite: no sample yet
    float depth = kFarDepth;
    Vec3 position;
    Vec2 uv;
    uint32_t object = 0, material = 0, primitive = 0;  ///< from 1; 0: nothing was met

    /// Where nothing was met: beyond everything, in metres. The number that Blender writes.
    static constexpr float kFarDepth = 1e10f;

    CentreSample& operator+=(const CentreSample& later) {
        if (later.distance2 < distance2) *this = later;
        return *this;
    }
    CentreSample& operator*=(double) { return *this; }
};

/// Radiance is divided by the first surface of its path, into the AOVs from `emission` to `transmission_indirect`.
inline constexpr Aov kFirstLightPart = Aov::emission, kLastLightPart = Aov::transmission_indirect;
constexpr size_t light_part(Aov aov) { return static_cast<size_t>(aov) - static_cast<size_t>(kFirstLightPart); }
inline constexpr size_t kLightParts = light_part(kLastLightPart) + 1;

struct LightSum {
    std::array<RgbSum, kLightParts> parts;
    LightSum& operator+=(const LightSum& other) {
        for (size_t i = 0; i < kLightParts; ++i) parts[i] += other.parts[i];
        return *this;
    }
    LightSum& operator*=(double times) {
        for (RgbSum& part : parts) part *= times;
        return *this;
    }
};

/// Which sums a set of AOVs needs.
struct SumKinds {
    bool features = false, squares = false, centres = false, light = false;
    bool object_mattes = false, material_mattes = false;

    SumKinds() = default;
    explicit SumKinds(AovSet aovs)
        : features(aovs.has_any({Aov::alpha, Aov::albedo, Aov::normal})),
          squares(aovs.has(Aov::variance)),
          centres(aovs.has_any({Aov::depth, Aov::position, Aov::uv, Aov::object, Aov::material, Aov::primitive})),
          light(aovs.has_any({Aov::emission, Aov::background, Aov::diffuse_direct, Aov::diffuse_indirect,
                              Aov::specular_direct, Aov::specular_indirect, Aov::transmission_direct,
                              Aov::transmission_indirect})),
          object_mattes(aovs.has(Aov::crypto_object)),
          material_mattes(aovs.has(Aov::crypto_material)) {}
    /// Whether anything is to be known of the surfaces that camera rays meet.
    bool first_hits() const { return features || centres || object_mattes || material_mattes; }
    uint64_t bytes_per_pixel() const {
        return sizeof(RgbSum) + features * sizeof(FeatureSum) + squares * sizeof(SquareSum) +
               centres * sizeof(CentreSample) + light * sizeof(LightSum) +
               (object_mattes + material_mattes) * MatteCounts::typical_bytes();
    }
};

/// All that is known of one pixel.
struct PixelSums {
    uint64_t samples = 0;
    double weight = 0;       ///< how many samples the sums stand for; more than there are where some count twice
    RgbSum color, variance;  ///< the latter of the mean of the colour
    FeatureSum features;
    CentreSample centre;
    LightSum light;
    MatteCounts::Ranking objects, materials;
};

/// Each array has an element for each pixel of the tile, row by row, or none where nobody asked.
struct TileSums {
    std::vector<RgbSum> color;
    std::vector<FeatureSum> features;
    std::vector<SquareSum> squares;
    std::vector<CentreSample> centres;
    std::vector<LightSum> light;
    std::vector<MatteCounts> objects, materials;

    TileSums() = default;
    TileSums(size_t pixels, SumKinds kinds)
        : color(pixels),
          features(kinds.features ? pixels : 0),
          squares(kinds.squares ? pixels : 0),
          centres(kinds.centres ? pixels : 0),
          light(kinds.light ? pixels : 0),
          objects(kinds.object_mattes ? pixels : 0),
          materials(kinds.material_mattes ? pixels : 0) {}

    /// Adds what comes after it in the order of the samples.
    TileSums& operator+=(const TileSums& later) {
        const auto fold = [](auto& sums, const auto& more) {
            for (size_t i = 0; i < sums.size(); ++i) sums[i] += more[i];
        };
        fold(color, later.color), fold(features, later.features);
        fold(squares, later.squares), fold(centres, later.centres);
        fold(light, later.light), fold(objects, later.objects), fold(materials, later.materials);
        return *this;
    }
};

/// A share of a pixel's sums; each of its samples counts so many times.
struct SumPart {
    const TileSums* sums = nullptr;
    uint32_t times = 1;
};

/// Pixel `i` of the parts together, in their order; without what is known of the colour.
inline PixelSums features_of(std::initializer_list<SumPart> parts, size_t i) {
    PixelSums out;
    MatteCounts objects, materials;
    for (const SumPart& part : parts) {
        const auto take = [&](auto& into, const auto& sums) {
            if (sums.empty()) return;
            auto sum = sums[i];
            sum *= part.times;
            into += sum;
        };
        take(out.features, part.sums->features), take(out.centre, part.sums->centres);
        take(out.light, part.sums->light);
        take(objects, part.sums->objects), take(materials, part.sums->materials);
    }
    out.objects = objects.ranking(), out.materials = materials.ranking();
    return out;
}

}  // namespace steradian
