// Cryptomatte 1.2 (Friedman & Jones 2015, "Fully automatic ID mattes with support for motion blur and transparency",
// and its specification): for each pixel the ids of what it shows with how much of it they cover, the largest share
// first.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "steradian/scene.h"
#include "steradian/settings.h"

namespace steradian {

/// Pairs of id and coverage that a file holds for each pixel, two to a layer: CryptoObject00, CryptoObject01, ….
inline constexpr uint32_t kMatteRanks = 6;

/// The bits of the float that stands for a name: its hash, MurmurHash3_x86_32 of the UTF-8 bytes with seed 0, with one
/// bit changed where it would be no normal number. Never 0.
uint32_t matte_id(std::string_view name) noexcept;

/// How many samples of a pixel, counted with the sign of their filter weights, show what: ids, and 0 for nothing. A
/// filter's weights differ in their signs alone, so that these are exact sums of them.
class MatteCounts {
public:
    struct Entry {
        uint32_t id = 0;
        int32_t samples = 0;
    };
    /// May throw std::bad_alloc.
    void add(uint32_t id, int32_t samples);
    MatteCounts& operator+=(const MatteCounts& more) {
        more.each([&](const Entry& e) { add(e.id, e.samples); });
        return *this;
    }
    MatteCounts& operator*=(uint32_t times) {
        for (Entry& e : few_) e.samples *= static_cast<int32_t>(times);
        for (Entry& e : more_) e.samples *= static_cast<int32_t>(times);
        return *this;
    }
    struct Covered {
        uint32_t id = 0;
        float coverage = 0;  ///< 0 … 1
    };
    using Ranking = std::array<Covered, kMatteRanks>;
    /// What covers most, the largest first and of equal ones the one with the smaller id; empty entries where there are
    /// fewer.
    Ranking ranking() const;

    /// Of one pixel, where most show one thing or two.
    static constexpr uint64_t typical_bytes() { return sizeof(MatteCounts) + 2 * sizeof(Entry); }

private:
    template <class Visit>
    void each(Visit visit) const {
        for (uint32_t i = 0; i < used_; ++i) visit(few_[i]);
        for (const Entry& e : more_) visit(e);
    }
    static constexpr uint32_t kFew = 2;
    uint32_t used_ = 0;
    Entry few_[kFew];
    std::vector<Entry> more_;  ///< by id
};

/// The ids of a scene's objects, and of its materials, in their order; names that are the same are one matte.
struct MatteIds {
    std::vector<uint32_t> objects, materials;
    MatteIds() = default;
    MatteIds(const Scene& scene, AovSet aovs);
};

/// What a file says of the mattes that it holds, so that readers find them and know their names.
std::map<std::string, std::string> matte_metadata(const Scene& scene, AovSet aovs);

}  // namespace steradian
