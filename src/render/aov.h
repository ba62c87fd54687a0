// From sums to the channels of a picture.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/sums.h"
#include "steradian/image.h"
#include "steradian/settings.h"

namespace steradian {

/// The channels of a picture with these AOVs: colour first, all in the order in which files list them.
class PictureChannels {
public:
    explicit PictureChannels(AovSet aovs);

    size_t count() const noexcept { return channels_.size(); }
    /// Names and types.
    void describe(Image& image) const;
    /// The values of a pixel, count() of them.
    void develop(const PixelSums& sums, float* out) const;

private:
    struct Channel {
        std::string name;
        ChannelType type = ChannelType::by_options;
        std::function<float(const PixelSums&)> value;
    };
    std::vector<Channel> channels_;
};

}  // namespace steradian
