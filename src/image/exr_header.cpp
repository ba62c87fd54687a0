#include "image/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

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

/// What of the required attributes has been seen.
struct Seen {
    bool channels = false, data = false, display = false, compression = false, tiles = false;
};

void expect_type(const Cursor& value, std::string_view name, std::string_view type, std::string_view expected) {
    if (type != expected)
        value.fail(
            fmt::format("the EXR attribute {} has type {}, expected {}", name, escape_for_display(type, 40), expected));
}

/// One attribute that we know; the others are OpenEXR's business.
void read_attribute(std::string_view name, std::string_view type, Cursor value, ExrPart& part, Seen& seen) {
    if (name == "channels") {
        expect_type(value, name, type, "chlist");
        part.channels = read_channels(value);
        seen.channels = true;
    } else if (name == "dataWindow" || name == "displayWindow") {
        expect_type(value, name, type, "box2i");
        (name == "dataWindow" ? part.data : part.display) = read_window(value);
        (name == "dataWindow" ? seen.data : seen.display) = true;
    } else if (name == "compression") {
        expect_type(value, name, type, "compression");
        part.compression = value.value<uint8_t>();
        seen.compression = true;
    } else if (name == "tiles") {
        expect_type(value, name, type, "tiledesc");
        part.tile_width = value.value<uint32_t>();
        part.tile_height = value.value<uint32_t>();
        seen.tiles = true;
    } else if (name == "chromaticities" && type == "chromaticities") {
        std::array<float, 8> xy{};
        for (float& v : xy) v = value.value<float>();
        part.chromaticities = xy;
    } else if (name == "type" && !part.kind_by_flags) {
        expect_type(value, name, type, "string");
        const std::string_view kind = value.take(value.left());
        part.deep = kind.starts_with("deep");
        part.tiled = kind == "tiledimage" || kind == "deeptile";
    } else if (type == "string") {
        part.strings.emplace(name, value.take(value.left()));
    }
}

/// Nothing when the list of headers ends here.
std::optional<ExrPart> read_part(Cursor& cursor, uint32_t version) {
    ExrPart part;
    part.kind_by_flags = !(version & (kMultipart | kNonImage));
    part.tiled = version & kTiled;
    part.deep = version & kNonImage;
    Seen seen;
    for (bool first = true;; first = false) {
        const std::string name(cursor.name());
        if (name.empty() && first) return std::nullopt;
        if (name.empty()) break;
        const std::string_view type = cursor.name();
        const auto size = cursor.value<int32_t>();
        if (size < 0 || static_cast<size_t>(size) > cursor.left())
            cursor.fail(fmt::format("the EXR attribute {} claims {} bytes, the file has {} left",
                                    escape_for_display(name, 80), size, cursor.left()));
        const size_t begin = cursor.position();
        cursor.take(static_cast<size_t>(size));
        read_attribute(name, type, Cursor(cursor.source(), begin, begin + static_cast<size_t>(size)), part, seen);
    }
    for (const auto& [there, name] : {std::pair(seen.channels, "channels"),
                                      {seen.data, "dataWindow"},
                                      {seen.display, "displayWindow"},
                                      {seen.compression, "compression"},
                                      {seen.tiles || !part.tiled, "tiles"}})
        if (!there) cursor.fail(fmt::format("the EXR file has no attribute {}", name));
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

std::vector<ExrPart> scan_exr(const Source& source) {
    Cursor cursor(source, 0, source.bytes.size());
    if (cursor.value<uint32_t>() != 0x01312f76) source.fail("expected an EXR file", 0);
    const auto version = cursor.value<uint32_t>();
    if ((version & kVersionMask) != 2 || (version & ~(kVersionMask | kKnownFlags)) != 0)
        source.fail(fmt::format("the EXR file has version {:#x}, which is not known", version), 4);
    std::vector<ExrPart> parts;
    while (auto part = read_part(cursor, version)) {
        check_part(source, *part);
        parts.push_back(std::move(*part));
        if (!(version & kMultipart)) return parts;
        if (parts.size() > kMaxParts) source.fail_limit(fmt::format("the EXR file has more than {} parts", kMaxParts));
    }
    if (parts.empty()) cursor.fail("the EXR file has no header");
    return parts;
}

}  // namespace steradian::codec
