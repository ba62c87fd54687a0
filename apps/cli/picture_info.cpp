#include "picture_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <vector>

#include "base/file.h"
#include "base/text.h"
#include "command.h"
#include "image/decode.h"

namespace steradian::cli {
namespace {

constexpr uint64_t kMaxFileBytes = uint64_t(8) << 30;

struct ChannelSummary {
    float min = std::numeric_limits<float>::infinity(), max = -min;
    double sum = 0;
    uint64_t finite = 0, nan = 0, inf = 0;
    double mean() const { return sum / static_cast<double>(finite); }
};

std::vector<ChannelSummary> summarize(const Image& image) {
    std::vector<ChannelSummary> channels(image.channels.size());
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        ChannelSummary& c = channels[i % channels.size()];
        const float v = image.pixels[i];
        if (std::isnan(v))
            ++c.nan;
        else if (std::isinf(v))
            ++c.inf;
        else
            ++c.finite, c.sum += v, c.min = std::min(c.min, v), c.max = std::max(c.max, v);
    }
    return channels;
}

const char* name_of(ImageFileKind kind) {
    switch (kind) {
        case ImageFileKind::png:
            return "PNG";
        case ImageFileKind::jpeg:
            return "JPEG";
        case ImageFileKind::exr:
            return "EXR";
        case ImageFileKind::hdr:
            return "HDR";
        case ImageFileKind::pfm:
            return "PFM";
        case ImageFileKind::webp:
            return "WebP";
        case ImageFileKind::unknown:
            break;
    }
    return "unknown";
}

void print_text(const std::string& path, ImageFileKind kind, const Image& image, std::ostream& out) {
    out << fmt::format("{}: a picture ({})\n", escape_for_display(path, 4096), name_of(kind));
    out << fmt::format("  hash       {}\n", image_hash(image));
    out << fmt::format("  size       {}x{}\n", image.width, image.height);
    const std::vector<ChannelSummary> channels = summarize(image);
    size_t longest = 9;  // so that the columns stand where those of the lines above do
    for (const std::string& name : image.channels)
        longest = std::max(longest, std::min<size_t>(escape_for_display(name, 40).size(), 40));
    out << fmt::format("  {:<{}}  {:>12} {:>12} {:>12}\n", "channel", longest, "min", "mean", "max");
    for (size_t i = 0; i < channels.size(); ++i) {
        const ChannelSummary& c = channels[i];
        out << fmt::format("  {:<{}}", escape_for_display(image.channels[i], 40), longest);
        if (c.finite)
            out << fmt::format("  {:>12.6g} {:>12.6g} {:>12.6g}", c.min, c.mean(), c.max);
        else
            out << fmt::format("  {:>12} {:>12} {:>12}", "-", "-", "-");
        if (c.nan) out << fmt::format("  {} NaN", c.nan);
        if (c.inf) out << fmt::format("  {} infinite", c.inf);
        out << '\n';
    }
    for (const auto& [key, text] : image.metadata)
        out << fmt::format("  {} = {}\n", escape_for_display(key, 80), escape_for_display(text, 400));
}

void print_json(const std::string& path, ImageFileKind kind, const Image& image, std::ostream& out) {
    rapidjson::StringBuffer buffer;
    JsonWriter w(buffer);
    w.StartObject();
    write_field(w, "file", path);
    w.Key("kind"), w.String("picture");
    w.Key("format"), w.String(name_of(kind));
    w.Key("hash"), w.String(image_hash(image).c_str());
    w.Key("width"), w.Uint(image.width);
    w.Key("height"), w.Uint(image.height);
    w.Key("channels"), w.StartArray();
    const std::vector<ChannelSummary> channels = summarize(image);
    for (size_t i = 0; i < channels.size(); ++i) {
        const ChannelSummary& c = channels[i];
        const auto number = [&](const char* key, double value) { w.Key(key), c.finite ? w.Double(value) : w.Null(); };
        w.StartObject();
        write_field(w, "name", image.channels[i]);
        number("min", c.min), number("mean", c.mean()), number("max", c.max);
        w.Key("nan"), w.Uint64(c.nan);
        w.Key("infinite"), w.Uint64(c.inf);
        w.EndObject();
    }
    w.EndArray();
    w.Key("metadata"), w.StartObject();
    for (const auto& [key, text] : image.metadata) {
        const std::string safe = escape_for_display(key, 256);
        w.Key(safe.data(), static_cast<rapidjson::SizeType>(safe.size()));
        write_text(w, text);
    }
    w.EndObject();
    w.EndObject();
    out << buffer.GetString() << '\n';
}

}  // namespace

Status print_picture_info(const std::string& path, bool json, std::ostream& out) {
    const auto bytes = read_file(path, kMaxFileBytes);
    if (!bytes) return bytes.error();
    const auto image = decode_image(*bytes, path, {});
    if (!image) return image.error();
    const ImageFileKind kind = image_kind(*bytes);
    json ? print_json(path, kind, *image, out) : print_text(path, kind, *image, out);
    return Ok{};
}

}  // namespace steradian::cli
