#include <algorithm>

#include "steradian/image.h"

namespace steradian {

Image color_channels(const Image& image) {
    const char* const names[] = {"R", "G", "B"};
    size_t from[3];
    for (int c = 0; c < 3; ++c) {
        const auto at = std::find(image.channels.begin(), image.channels.end(), names[c]);
        if (at == image.channels.end()) return {};
        from[c] = static_cast<size_t>(at - image.channels.begin());
    }
    Image out;
    out.width = image.width;
    out.height = image.height;
    out.channels.assign(std::begin(names), std::end(names));
    out.metadata = image.metadata;
    std::erase_if(out.metadata, [](const auto& attribute) { return attribute.first.starts_with("cryptomatte/"); });
    const size_t channels = image.channels.size(), pixels = image.pixels.size() / channels;
    out.pixels.reserve(pixels * 3);
    for (size_t i = 0; i < pixels; ++i)
        for (const size_t c : from) out.pixels.push_back(image.pixels[i * channels + c]);
    return out;
}

}  // namespace steradian
