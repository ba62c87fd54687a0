#include "base/hash.h"
#include "steradian/image.h"

namespace steradian {

// The layout, all little-endian: u32 width, u32 height, u32 number of channels, each name as u64 length and bytes, then
// the pixels as they stand.
std::string image_hash(const Image& image) {
    Hasher hasher;
    hasher.value(image.width);
    hasher.value(image.height);
    hasher.value(static_cast<uint32_t>(image.channels.size()));
    for (const std::string& name : image.channels) hasher.text(name);
    hasher.bytes(image.pixels.data(), image.pixels.size() * sizeof(float));
    return hasher.hex();
}

}  // namespace steradian
