// A binary tree over lights, to choose one by how much it may contribute at a point (see light_bounds.h).
//
// A light is chosen with 32 bits and no rounding: a node has a run of the 2^32 values, its children divide it by their
// importance, and the probability of a light is the length of its run. So probabilities are exact and sum to 1, and
// they are computed a second time, for a light that was found otherwise, to the same bits. No child that counts at all
// gets less than one value for each light below it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "shading/light_bounds.h"

namespace steradian {

/// As many as 32 bits have.
inline constexpr uint64_t kLightValues = uint64_t{1} << 32;

struct ChosenLight {
    uint32_t light = 0;
    double probability = 0;  ///< a multiple of 2^-32
};

class LightTree {
public:
    LightTree() = default;
    /// Over the elements of `lights` that have a strength; a light is called by its index. At most 2^31 of them. The
    /// same tree on every machine. May throw std::bad_alloc.
    explicit LightTree(std::span<const LightBounds> lights);

    bool empty() const noexcept { return nodes_.empty(); }
    uint64_t bytes() const noexcept { return nodes_.size() * sizeof(LightNode) + trails_.size() * sizeof(uint64_t); }
    static constexpr uint64_t kBytesPerLight = 2 * sizeof(LightNode) + sizeof(uint64_t);

    /// Not whether there is a light, but whether their bounds as a whole let any contribute.
    bool reaches(const LightReceiver& at) const noexcept {
        return !empty() && light_importance(nodes_[0], at).numerator > 0;
    }

    /// `choice`: uniform in [0, values), values at least the number of lights and at most 2^32. Nothing where no light
    /// can reach the receiver, and sometimes where one could: bounds of many lights promise more than those of each.
    std::optional<ChosenLight> choose(const LightReceiver& at, uint32_t choice,
                                      uint64_t values = kLightValues) const noexcept;

    /// With which choose() finds `light`. 0 where it cannot contribute.
    double probability(const LightReceiver& at, uint32_t light, uint64_t values = kLightValues) const noexcept;

    const std::vector<LightNode>& nodes() const noexcept { return nodes_; }

private:
    friend class LightTreeBuilder;
    std::vector<LightNode> nodes_;  ///< siblings are neighbours; the root is the first
    /// Of each light the way down from the root: bit k is 1 where step k goes to the second child.
    std::vector<uint64_t> trails_;
};

}  // namespace steradian
