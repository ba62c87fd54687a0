// A view transform looked up once and applied to many pixels.
#pragma once

#include <optional>

#include "image/tone.h"

namespace steradian {

enum class ViewKind : uint8_t { srgb, agx, aces, neutral, reinhard };

struct View {
    ViewKind kind = ViewKind::srgb;
    float scale = 1;  ///< 2^exposure

    /// Display-linear Rec. 709 in [0, 1]; NaN becomes 0.
    Rgb operator()(Rgb scene_linear) const noexcept;
};

/// Nothing when there is no such view.
std::optional<View> find_view(std::string_view name, float exposure) noexcept;

/// round(255 srgb_encode(x)) for many x: a table of the 255 steps takes the place of the power.
class SrgbQuantizer {
public:
    SrgbQuantizer() noexcept;
    uint8_t operator()(float linear) const noexcept;

private:
    float step_[256];  ///< step_[k]: the smallest float that gives k or more; step_[0] is not used
};

}  // namespace steradian
