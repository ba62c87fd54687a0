#include "image/codec.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"

namespace steradian::codec {

void Source::fail(std::string message, std::optional<uint64_t> byte) const {
    throw Failure{{ErrorCode::bad_input, std::move(message), {name, 0, 0, byte}, {}, {}}};
}

void Source::fail_limit(std::string message, std::string hint) const {
    throw Failure{{ErrorCode::resources, std::move(message), {name, 0, 0, {}}, {}, std::move(hint)}};
}

void Source::check_size(uint64_t width, uint64_t height, uint64_t decoded_bytes) const {
    if (width == 0 || height == 0)
        fail(fmt::format("the picture is {} × {} pixels, expected at least one", width, height));
    if (height > limits.max_pixels / width)
        fail_limit(
            fmt::format("the picture is {} × {} pixels, the limit is {} in all", width, height, limits.max_pixels));
    if (decoded_bytes > kFreeBytes && decoded_bytes / kMaxExpansion > bytes.size())
        fail_limit(
            fmt::format("{} bytes that claim to be {} × {} pixels: expanding a file more than {} times is refused "
                        "beyond {} MiB",
                        bytes.size(), width, height, kMaxExpansion, kFreeBytes >> 20));
}

ColourChannels colour_channels(const Image& image, std::string_view format, bool with_alpha, const std::string& path,
                               Diagnostics& diagnostics) {
    const auto find = [&](std::string_view name) -> std::optional<size_t> {
        const auto at = std::find(image.channels.begin(), image.channels.end(), name);
        if (at == image.channels.end()) return std::nullopt;
        return static_cast<size_t>(at - image.channels.begin());
    };
    ColourChannels found;
    const auto r = find("R"), g = find("G"), b = find("B"), y = find("Y");
    if (with_alpha) found.alpha = find("A");
    if (r && g && b) {
        found.count = 3;
        found.index[0] = *r, found.index[1] = *g, found.index[2] = *b;
    } else if (y || image.channels.size() == 1) {
        found.count = 1;
        found.index[0] = y.value_or(0);
        if (image.channels.size() == 1) found.alpha.reset();
    } else {
        throw Failure{{ErrorCode::usage,
                       fmt::format("{} needs channels R, G and B, or Y, or a single one; the picture has {}", format,
                                   join(image.channels)),
                       {path, 0, 0, {}},
                       {},
                       "EXR takes any channels"}};
    }
    std::vector<std::string> dropped;
    for (size_t c = 0; c < image.channels.size(); ++c)
        if (std::find(found.index, found.index + found.count, c) == found.index + found.count && found.alpha != c)
            dropped.push_back(image.channels[c]);
    if (!dropped.empty())
        diagnostics.warn(fmt::format("{} does not hold the channels {}: left out", format, join(dropped)),
                         {path, 0, 0, {}});
    return found;
}

bool channel_before(std::string_view a, std::string_view b) noexcept {
    const auto split = [](std::string_view name) {
        const size_t dot = name.rfind('.');
        return dot == name.npos ? std::pair(std::string_view(), name)
                                : std::pair(name.substr(0, dot), name.substr(dot + 1));
    };
    const auto rank = [](std::string_view last) {
        return last.size() == 1 ? std::min(std::string_view("RGBA").find(last), size_t(4)) : size_t(4);
    };
    const auto [layer_a, last_a] = split(a);
    const auto [layer_b, last_b] = split(b);
    if (layer_a != layer_b) return layer_a < layer_b;
    if (rank(last_a) != rank(last_b)) return rank(last_a) < rank(last_b);
    return a < b;
}

std::string join(const std::vector<std::string>& names) {
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + escape_for_display(name, 64);
    return out.empty() ? "none" : out;
}

}  // namespace steradian::codec
