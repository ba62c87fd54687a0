// Choosing one of the scene's lights for a point. As in the tree (light_tree.h) 32 bits are divided into runs, so that
// probabilities are exact: a light's is the number of values that choose it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "shading/light_tree.h"
#include "steradian/settings.h"

namespace steradian {

struct ShadingScene;

/// With `bvh` and `power`, half of the values are for lights that are infinitely far away (directional ones and the
/// environment), one as likely as the other, and half for the rest; all where there is only one kind, or where `bvh`
/// knows that none of the rest reaches the point. With `uniform` all lights are alike.
class LightSelection {
public:
    LightSelection() = default;
    /// Of a scene whose `lights` are made. May throw std::bad_alloc.
    explicit LightSelection(const ShadingScene& scene);

    uint32_t lights() const noexcept { return lights_; }
    uint64_t bytes() const noexcept;

    /// `choice`: 32 uniform bits. Nothing where no light can contribute, or where bounds promised too much.
    std::optional<ChosenLight> choose(LightChoice by, const LightReceiver& at, uint32_t choice) const noexcept;
    /// The same as a question, which LightTree::answer() can answer together with others; answered already where no
    /// tree is needed.
    LightQuery query(LightChoice by, const LightReceiver& at, uint32_t choice) const noexcept;
    /// With which choose() finds `light`.
    double probability(LightChoice by, const LightReceiver& at, uint32_t light) const noexcept;

private:
    uint64_t distant_values(LightChoice by, const LightReceiver& at) const noexcept;

    uint32_t lights_ = 0;
    LightTree tree_;                  ///< over the lights that are somewhere
    std::vector<uint32_t> distant_;   ///< the others, ascending
    std::vector<double> cumulative_;  ///< flux of the lights that are somewhere, ascending by index
};

}  // namespace steradian
