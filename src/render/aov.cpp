#include "render/aov.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/names.h"
#include "image/codec.h"

namespace steradian {
namespace {

using Sums = PixelSums;

/// 0 of no samples.
float mean(double sum, double n) { return n > 0 ? static_cast<float>(sum / n) : 0; }

/// Of what was averaged over its own weights; 0 where those of a filter with negative lobes happen to cancel.
float feature(double sum, const Sums& s) {
    return s.features.weight != 0 ? static_cast<float>(sum / s.features.weight) : 0;
}

struct Row {
    Aov aov;
    const char* name;
    ChannelType type;
    float (*value)(const Sums&);
};

constexpr ChannelType kAny = ChannelType::by_options, kWhole = ChannelType::uint32;

/// The channels of one light part.
void add_part(size_t part, const std::string& layer, auto& channels) {
    const auto of = [part](double RgbSum::*channel) {
        return [part, channel](const Sums& s) { return mean(s.light.parts[part].*channel, s.weight); };
    };
    channels.push_back({layer + ".R", ChannelType::by_options, of(&RgbSum::r)});
    channels.push_back({layer + ".G", ChannelType::by_options, of(&RgbSum::g)});
    channels.push_back({layer + ".B", ChannelType::by_options, of(&RgbSum::b)});
}

/// Two ranks to a layer: id and coverage, id and coverage. A file must keep every bit of an id.
void add_mattes(MatteCounts::Ranking Sums::*ranking, const std::string& name, auto& channels) {
    for (uint32_t rank = 0; rank < kMatteRanks; ++rank) {
        const std::string layer = fmt::format("{}{:02}", name, rank / 2);
        channels.push_back({layer + (rank % 2 == 0 ? ".R" : ".B"), ChannelType::single,
                            [=](const Sums& s) { return std::bit_cast<float>((s.*ranking)[rank].id); }});
        channels.push_back({layer + (rank % 2 == 0 ? ".G" : ".A"), ChannelType::single,
                            [=](const Sums& s) { return (s.*ranking)[rank].coverage; }});
    }
}

/// docs/aovs.md has them with their reasons. What is no whole number and yet never half is so by its name, in files.
constexpr Row kRows[] = {
    {Aov::alpha, "A", kAny, [](const Sums& s) { return clamp_to(feature(s.features.alpha, s), 0.0f, 1.0f); }},
    {Aov::albedo, "albedo.R", kAny, [](const Sums& s) { return feature(s.features.albedo.r, s); }},
    {Aov::albedo, "albedo.G", kAny, [](const Sums& s) { return feature(s.features.albedo.g, s); }},
    {Aov::albedo, "albedo.B", kAny, [](const Sums& s) { return feature(s.features.albedo.b, s); }},
    {Aov::normal, "N.X", kAny, [](const Sums& s) { return feature(s.features.normal.r, s); }},
    {Aov::normal, "N.Y", kAny, [](const Sums& s) { return feature(s.features.normal.g, s); }},
    {Aov::normal, "N.Z", kAny, [](const Sums& s) { return feature(s.features.normal.b, s); }},
    {Aov::depth, "Z", kAny, [](const Sums& s) { return s.centre.depth; }},
    {Aov::position, "P.X", kAny, [](const Sums& s) { return s.centre.position.x; }},
    {Aov::position, "P.Y", kAny, [](const Sums& s) { return s.centre.position.y; }},
    {Aov::position, "P.Z", kAny, [](const Sums& s) { return s.centre.position.z; }},
    {Aov::uv, "uv.U", kAny, [](const Sums& s) { return s.centre.uv.x; }},
    {Aov::uv, "uv.V", kAny, [](const Sums& s) { return s.centre.uv.y; }},
    {Aov::object, "object.id", kWhole, [](const Sums& s) { return static_cast<float>(s.centre.object); }},
    {Aov::material, "material.id", kWhole, [](const Sums& s) { return static_cast<float>(s.centre.material); }},
    {Aov::primitive, "primitive.id", kWhole, [](const Sums& s) { return static_cast<float>(s.centre.primitive); }},
    {Aov::variance, "variance.R", kAny, [](const Sums& s) { return static_cast<float>(s.variance.r); }},
    {Aov::variance, "variance.G", kAny, [](const Sums& s) { return static_cast<float>(s.variance.g); }},
    {Aov::variance, "variance.B", kAny, [](const Sums& s) { return static_cast<float>(s.variance.b); }},
    {Aov::samples, "samples.count", kWhole, [](const Sums& s) { return static_cast<float>(s.samples); }},
};

}  // namespace

PictureChannels::PictureChannels(AovSet aovs) {
    channels_.push_back({"R", kAny, [](const Sums& s) { return mean(s.color.r, s.weight); }});
    channels_.push_back({"G", kAny, [](const Sums& s) { return mean(s.color.g, s.weight); }});
    channels_.push_back({"B", kAny, [](const Sums& s) { return mean(s.color.b, s.weight); }});
    for (const Row& row : kRows)
        if (aovs.has(row.aov)) channels_.push_back({row.name, row.type, row.value});
    for (size_t i = 0; i < kLightParts; ++i)
        if (const auto aov = static_cast<Aov>(static_cast<size_t>(kFirstLightPart) + i); aovs.has(aov))
            add_part(i, std::string(name_of(aov)), channels_);
    if (aovs.has(Aov::crypto_object)) add_mattes(&Sums::objects, "CryptoObject", channels_);
    if (aovs.has(Aov::crypto_material)) add_mattes(&Sums::materials, "CryptoMaterial", channels_);
    std::sort(channels_.begin(), channels_.end(),
              [](const Channel& a, const Channel& b) { return codec::channel_before(a.name, b.name); });
}

void PictureChannels::describe(Image& image) const {
    const bool plain = std::all_of(channels_.begin(), channels_.end(), [](const Channel& c) { return c.type == kAny; });
    for (const Channel& c : channels_) {
        image.channels.push_back(c.name);
        if (!plain) image.types.push_back(c.type);
    }
}

void PictureChannels::develop(const PixelSums& sums, float* out) const {
    for (const Channel& c : channels_) *out++ = c.value(sums);
}

}  // namespace steradian
