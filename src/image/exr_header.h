// The headers of an EXR file, read by ourselves: OpenEXR takes memory for whatever a header claims, and reads some
// attributes by their content, not by their stated size. So every claim is checked against the file first, and OpenEXR
// sees only the attributes that it needs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/codec.h"

namespace steradian::codec {

enum class ExrType : uint8_t { uint32, half, single };

struct ExrChannel {
    std::string name;
    ExrType type = ExrType::half;
    uint32_t x_sampling = 1, y_sampling = 1;
};

/// Inclusive bounds, as the format has them.
struct ExrWindow {
    int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    uint64_t width() const { return static_cast<uint64_t>(x1 - x0 + 1); }
    uint64_t height() const { return static_cast<uint64_t>(y1 - y0 + 1); }
    bool operator==(const ExrWindow&) const = default;
};

struct ExrPart {
    std::vector<ExrChannel> channels;  ///< sorted by name in a valid file; kept as they come
    ExrWindow data, display;
    bool kind_by_flags = true;  ///< of the file, which is then not multipart; otherwise by the attribute "type"
    bool deep = false;
    bool tiled = false;
    uint32_t tile_width = 0, tile_height = 0;
    uint8_t compression = 0;
    std::optional<std::array<float, 8>> chromaticities;  ///< x, y of red, green, blue and white
    std::map<std::string, std::string> strings;

    bool subsampled() const;
    const ExrChannel* find(std::string_view name) const;
    /// Of all channels, as if none were subsampled.
    uint64_t pixel_bytes() const;
};

struct ExrHeaders {
    /// All parts, each checked: sizes, tiles and the table of offsets can be true for a file of this length.
    std::vector<ExrPart> parts;
    /// What to show to OpenEXR in place of the beginning of the file: equal to it in length and structure, but
    /// attributes that OpenEXR does not need have a type that it does not know, which it skips.
    std::string safe_bytes;
};
ExrHeaders scan_exr(const Source& source);

}  // namespace steradian::codec
