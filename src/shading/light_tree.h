// A tree over lights, to choose one by how much it may contribute at a point (see light_bounds.h). Its nodes have up to
// eight children, which are looked at four at a time.
//
// A light is chosen with 32 bits and no rounding: a node has a run of the 2^32 values, its children divide it by their
// importance, and the probability of a light is the length of its run. So probabilities are exact and sum to 1, and
// they are computed a second time, for a light that was found otherwise, to the same bits. A child that counts at all
// gets one value for each light below it, and its share of the rest.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/large_array.h"
#include "shading/light_bounds.h"

namespace steradian {

/// As many as 32 bits have.
inline constexpr uint64_t kLightValues = uint64_t{1} << 32;

struct ChosenLight {
    uint32_t light = 0;
    double probability = 0;  ///< a multiple of 2^-32
};

class LightTree;

/// A choice among the lights of a tree as LightTree::choose() makes it, and the answer.
struct LightQuery {
    const LightTree* tree = nullptr;  ///< null: there is nothing to choose, or it is answered
    LightReceiver at;
    uint32_t choice = 0;
    uint64_t values = kLightValues;
    std::optional<ChosenLight> chosen;
};

struct alignas(64) LightNode {
    static constexpr int kWidth = 8;
    FourLights children[kWidth / 4];
    uint32_t lights[kWidth] = {};  ///< below each child: 0 where there is none, 1 for a leaf
    uint32_t child[kWidth] = {};   ///< the light's index for a leaf, else the node's
};

class LightTree {
public:
    LightTree() = default;
    /// Over the elements of `lights` that have a strength; a light is called by its index. At most 2^31 of them. The
    /// same tree on every machine. May throw std::bad_alloc.
    explicit LightTree(std::span<const LightBounds> lights);

    bool empty() const noexcept { return nodes_.empty(); }
    uint64_t bytes() const noexcept {
        return nodes_.size() * (sizeof(LightNode) + sizeof(Place)) + places_.size() * sizeof(Place);
    }
    /// At most: nodes that are not full have leaves only, so there are no more than 4/7 as many as lights, and one.
    static constexpr uint64_t bytes(uint64_t lights) {
        return (lights * 4 / 7 + 1) * (sizeof(LightNode) + sizeof(Place)) + lights * sizeof(Place);
    }

    /// Not whether there is a light, but whether their bounds as a whole let any contribute.
    bool reaches(const LightReceiver& at) const noexcept;

    /// `choice`: uniform in [0, values), values at least the number of lights and at most 2^32. Nothing where no light
    /// can reach the receiver, and sometimes where one could: bounds of many lights promise more than those of each.
    std::optional<ChosenLight> choose(const LightReceiver& at, uint32_t choice,
                                      uint64_t values = kLightValues) const noexcept;

    /// Answers all queries, each as choose() does, and many at a time: while one waits for its node, others compute.
    static void answer(std::span<LightQuery> queries) noexcept;

    /// With which choose() finds `light`. 0 where it cannot contribute.
    double probability(const LightReceiver& at, uint32_t light, uint64_t values = kLightValues) const noexcept;

    const LargeArray<LightNode>& nodes() const noexcept { return nodes_; }

private:
    friend class LightTreeBuilder;
    struct Place {
        uint32_t node = kNowhere, child = 0;
    };
    static constexpr uint32_t kNowhere = ~0u;  ///< above the root, and of lights that are not in the tree

    FourLights whole_;             ///< of all, in the first lane
    LargeArray<LightNode> nodes_;  ///< the root is the first
    std::vector<Place> parents_;   ///< of each node
    std::vector<Place> places_;    ///< of each light
};

}  // namespace steradian
