#include "image/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "base/text.h"

namespace steradian::codec {
namespace {

constexpr size_t kMaxName = 255;
constexpr size_t kMaxChannels = 1024;
constexpr size_t kMaxParts = 1024;
constexpr int64_t kMaxCoordinate = int64_t(1) << 30;

/// Bits of the version field.
constexpr uint32_t kVersionMask = 0xff, kTiled = 0x200, kNonImage = 0x800, kMultipart = 0x1000, kKnownFlags = 0x1e00;

class Cursor {
public:
    Cursor(const Source& source, size_t position, size_t end) : source_(source), position_(position), end_(end) {}

    size_t position() const { return position_; }
    size_t left() const { return end_ - position_; }
    const Source& source() const { return source_; }
    [[noreturn]] void fail(std::string message) const { source_.fail(std::move(message), position_); }

    std::string_view take(size_t size) {
        if (size > left()) fail("the EXR header is cut short");
        const std::string_view out = source_.bytes.substr(position_, size);
        position_ += size;
        return out;
    }
    template <class T>
    T value() {
        T out;
        std::memcpy(&out, take(sizeof out).data(), sizeof out);
        return out;
    }
    std::string_view name() {
        const size_t end = source_.bytes.substr(position_, std::min(left(), kMaxName + 1)).find('\0');
        if (end == std::string_view::npos) fail("a name in the EXR header is cut short or too long");
        const std::string_view out = take(end);
        take(1);
        return out;
    }

private:
    const Source& source_;
    size_t position_, end_;
};

ExrWindow read_window(Cursor& cursor) {
    ExrWindow window;
    window.x0 = cursor.value<int32_t>();
    window.y0 = cursor.value<int32_t>();
    window.x1 = cursor.value<int32_t>();
    window.y1 = cursor.value<int32_t>();
    for (const int64_t bound : {window.x0, window.y0, window.x1, window.y1})
        if (bound < -kMaxCoordinate || bound > kMaxCoordinate) cursor.fail("a window of the EXR file is out of range");
    if (window.x1 < window.x0 || window.y1 < window.y0) cursor.fail("a window of the EXR file is empty");
    return window;
}

std::vector<ExrChannel> read_channels(Cursor& cursor) {
    std::vector<ExrChannel> channels;
    for (;;) {
        ExrChannel channel;
        channel.name = cursor.name();
        if (channel.name.empty()) return channels;
        if (std::any_of(channels.begin(), channels.end(), [&](const ExrChannel& c) { return c.name == channel.name; }))
            cursor.fail("the EXR file has two channels of one name");
        const auto type = cursor.value<int32_t>();
        if (type < 0 || type > 2) cursor.fail("a channel of the EXR file has an unknown type");
        channel.type = static_cast<ExrType>(type);
        cursor.take(4);  // "linear" and three reserved bytes
        const auto x = cursor.value<int32_t>(), y = cursor.value<int32_t>();
        if (x < 1 || y < 1) cursor.fail("a channel of the EXR file has an impossible sampling rate");
        channel.x_sampling = static_cast<uint32_t>(x);
        channel.y_sampling = static_cast<uint32_t>(y);
        channels.push_back(std::move(channel));
        if (channels.size() > kMaxChannels)
            cursor.source().fail_limit(fmt::format("the EXR file has more than {} channels", kMaxChannels));
    }
}

/// The attributes that OpenEXR may need, with their types and sizes; 0: any.
struct Needed {
    std::string_view name, type;
    size_t size;
    bool ours;  ///< we read it too, so that nothing else may stand under its name
};
constexpr Needed kNeeded[] = {{"channels", "chlist", 0, true},
                              {"chunkCount", "int", 4, false},
                              {"compression", "compression", 1, true},
                              {"dataWindow", "box2i", 16, true},
                              {"displayWindow", "box2i", 16, true},
                              {"lineOrder", "lineOrder", 1, false},
                              {"maxSamplesPerPixel", "int", 4, false},
                              {"name", "string", 0, false},
                              {"pixelAspectRatio", "float", 4, false},
                              {"screenWindowCenter", "v2f", 8, false},
                              {"screenWindowWidth", "float", 4, false},
                              {"tiles", "tiledesc", 9, true},
                              {"type", "string", 0, true},
                              {"version", "int", 4, false}};

const Needed* find_needed(std::string_view name) {
    const auto at =
        std::find_if(std::begin(kNeeded), std::end(kNeeded), [&](const Needed& n) { return n.name == name; });
    return at == std::end(kNeeded) ? nullptr : at;
}

struct Attribute {
    std::string_view name, type;
    Cursor value;
};

/// Whether OpenEXR may see it: an attribute that it knows, in the shape that it expects.
bool is_needed(const Attribute& attribute) {
    const Needed* needed = find_needed(attribute.name);
    if (!needed) return false;
    const bool right = attribute.type == needed->type && (!needed->size || attribute.value.left() == needed->size);
    if (!right && needed->ours)
        attribute.value.fail(fmt::format("the EXR attribute {} has type {} and {} bytes, which is not right for it",
                                         attribute.name, escape_for_display(attribute.type, 40),
                                         attribute.value.left()));
    return right;
}

void read_type(Attribute& attribute, ExrPart& part) {
    const std::string_view kind = attribute.value.take(attribute.value.left());
    if (part.kind_by_flags) return;
    const bool known = kind == "scanlineimage" || kind == "tiledimage" || kind == "deepscanline" || kind == "deeptile";
    if (!known)
        attribute.value.fail(fmt::format("the EXR file has a part of unknown type {}", escape_for_display(kind, 40)));
    part.deep = kind.starts_with("deep");
    part.tiled = kind == "tiledimage" || kind == "deeptile";
}

/// One attribute that we know.
void read_attribute(Attribute attribute, ExrPart& part) {
    const std::string_view name = attribute.name;
    Cursor& value = attribute.value;
    if (name == "channels") {
        part.channels = read_channels(value);
        if (value.left()) value.fail("the list of channels of the EXR file is not as long as it says");
    } else if (name == "dataWindow") {
        part.data = read_window(value);
    } else if (name == "displayWindow") {
        part.display = read_window(value);
    } else if (name == "compression") {
        part.compression = value.value<uint8_t>();
    } else if (name == "tiles") {
        part.tile_width = value.value<uint32_t>();
        part.tile_height = value.value<uint32_t>();
    } else if (name == "type") {
        read_type(attribute, part);
    } else if (name == "chromaticities" && attribute.type == "chromaticities") {
        std::array<float, 8> xy{};
        for (float& v : xy) v = value.value<float>();
        part.chromaticities = xy;
    } else if (attribute.type == "string") {
        part.strings.emplace(name, value.take(value.left()));
    }
}

/// Nothing when the list of headers ends here.
std::optional<ExrPart> read_part(Cursor& cursor, uint32_t version, std::vector<std::string_view>& hidden) {
    ExrPart part;
    part.kind_by_flags = !(version & (kMultipart | kNonImage));
    part.tiled = version & kTiled;
    part.deep = version & kNonImage;
    std::set<std::string_view> seen;
    for (bool first = true;; first = false) {
        const std::string_view name = cursor.name();
        if (name.empty() && first) return std::nullopt;
        if (name.empty()) break;
        const std::string_view type = cursor.name();
        const auto size = cursor.value<int32_t>();
        if (size < 0 || static_cast<size_t>(size) > cursor.left())
            cursor.fail(fmt::format("the EXR attribute {} claims {} bytes, the file has {} left",
                                    escape_for_display(name, 80), size, cursor.left()));
        const size_t begin = cursor.position();
        cursor.take(static_cast<size_t>(size));
        const Attribute attribute{name, type, Cursor(cursor.source(), begin, cursor.position())};
        if (!is_needed(attribute)) hidden.push_back(type);
        if (!seen.insert(name).second)
            cursor.fail(fmt::format("the EXR attribute {} is there twice", escape_for_display(name, 80)));
        read_attribute(attribute, part);
    }
    for (const char* name : {"channels", "dataWindow", "displayWindow", "compression"})
        if (!seen.contains(name)) cursor.fail(fmt::format("the EXR file has no attribute {}", name));
    if (part.tiled && !seen.contains("tiles")) cursor.fail("the EXR file has no attribute tiles");
    return part;
}

/// Rows of a compressed block, by the number of the compression method.
uint64_t block_rows(const Source& source, uint8_t compression) {
    static constexpr uint64_t kRows[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    if (compression >= std::size(kRows))
        source.fail(fmt::format("the EXR file uses an unknown compression ({})", compression));
    return kRows[compression];
}

/// OpenEXR allocates whole blocks and the table of offsets from what the header says.
void check_part(const Source& source, const ExrPart& part) {
    const uint64_t width = part.data.width(), height = part.data.height();
    source.check_size(width, height, 0);
    source.check_size(part.display.width(), part.display.height(), 0);
    if (part.channels.empty()) source.fail("the EXR file has no channels");
    uint64_t columns = 1, block_width = width, block_height = block_rows(source, part.compression);
    if (part.tiled) {
        constexpr uint32_t kMaxTile = 1u << 16;
        if (part.tile_width == 0 || part.tile_height == 0 || part.tile_width > kMaxTile || part.tile_height > kMaxTile)
            source.fail(
                fmt::format("the EXR file has impossible tiles of {} × {} pixels", part.tile_width, part.tile_height));
        columns = (width + part.tile_width - 1) / part.tile_width;
        block_width = columns * part.tile_width;  // OpenEXR keeps a row of tiles
        block_height = part.tile_height;
    }
    const uint64_t blocks = columns * ((height + block_height - 1) / block_height);
    if (blocks > source.bytes.size() / 8)
        source.fail(
            fmt::format("{} × {} pixels cannot be in an EXR file of {} bytes", width, height, source.bytes.size()));
    // Keeps the product below 2^64: times 2^16 rows of 1024 channels of 4 bytes.
    if (block_width > (uint64_t(1) << 31)) source.fail_limit("the EXR file has too wide rows");
    const uint64_t block_bytes = block_width * block_height * part.pixel_bytes();
    if (block_bytes > kFreeBytes && block_bytes / kMaxExpansion > source.bytes.size())
        source.fail_limit(fmt::format("a block of the EXR file takes {} MiB, too much for a file of {} bytes",
                                      block_bytes >> 20, source.bytes.size()));
}

}  // namespace

bool ExrPart::subsampled() const {
    return std::any_of(channels.begin(), channels.end(),
                       [](const ExrChannel& c) { return c.x_sampling != 1 || c.y_sampling != 1; });
}

const ExrChannel* ExrPart::find(std::string_view name) const {
    const auto at = std::find_if(channels.begin(), channels.end(), [&](const ExrChannel& c) { return c.name == name; });
    return at == channels.end() ? nullptr : &*at;
}

uint64_t ExrPart::pixel_bytes() const {
    uint64_t bytes = 0;
    for (const ExrChannel& channel : channels) bytes += channel.type == ExrType::half ? 2 : 4;
    return bytes;
}

ExrHeaders scan_exr(const Source& source) {
    Cursor cursor(source, 0, source.bytes.size());
    if (cursor.value<uint32_t>() != 0x01312f76) source.fail("expected an EXR file", 0);
    const auto version = cursor.value<uint32_t>();
    if ((version & kVersionMask) != 2 || (version & ~(kVersionMask | kKnownFlags)) != 0)
        source.fail(fmt::format("the EXR file has version {:#x}, which is not known", version), 4);
    ExrHeaders headers;
    std::vector<std::string_view> hidden;  // the types that OpenEXR is not to know
    while (auto part = read_part(cursor, version, hidden)) {
        check_part(source, *part);
        headers.parts.push_back(std::move(*part));
        if (!(version & kMultipart)) break;
        if (headers.parts.size() > kMaxParts)
            source.fail_limit(fmt::format("the EXR file has more than {} parts", kMaxParts));
    }
    if (headers.parts.empty()) cursor.fail("the EXR file has no header");
    headers.safe_bytes = source.bytes.substr(0, cursor.position());
    for (const std::string_view type : hidden)
        std::fill_n(headers.safe_bytes.begin() + (type.data() - source.bytes.data()), type.size(), '?');
    return headers;
}

}  // namespace steradian::codec
