#include "sequence.h"

#include <fmt/format.h>

#include <charconv>

#include "base/text.h"

namespace steradian::cli {
namespace {

constexpr uint32_t kLastFrame = 999'999;
constexpr uint32_t kMostTurns = 36'000;
constexpr double kDefaultFps = 24;

struct FrameRange {
    uint32_t first = 0, last = 0;
};

/// "7", "1:24" or "1-24", both ends included.
Result<FrameRange> parse_frames(const std::string& text) {
    const auto wrong = [&] {
        return usage_error(
            fmt::format("--frames: '{}' is not FIRST:LAST", escape_for_display(text)),
            fmt::format("whole numbers from 0 to {}, both included, for example --frames 1:48", kLastFrame));
    };
    const char* const end = text.data() + text.size();
    FrameRange out;
    auto [p, error] = std::from_chars(text.data(), end, out.first);
    if (error != std::errc()) return wrong();
    out.last = out.first;
    if (p != end) {
        if (*p != ':' && *p != '-') return wrong();
        const auto [q, second_error] = std::from_chars(p + 1, end, out.last);
        if (second_error != std::errc() || q != end) return wrong();
    }
    if (out.first > out.last || out.last > kLastFrame) return wrong();
    return out;
}

}  // namespace

std::string Shot::describe(size_t which, size_t count) const {
    const std::string what = time ? fmt::format("frame {}, {:.6g} s", number, *time)
                                  : fmt::format("picture {}, turned by {:.6g} degrees", number, *turn);
    return fmt::format("{} ({} of {})", what, which, count);
}

Result<std::vector<Shot>> parse_sequence(const SequenceOptions& o, const SettingsOptions& settings) {
    std::vector<Shot> out;
    if (o.fps && o.frames.empty()) return usage_error("--fps is for --frames");
    if (!o.frames.empty() && o.turns) return usage_error("--frames and --turntable are two different rows of pictures");
    if (!o.frames.empty()) {
        if (settings.frame_time)
            return usage_error("--frames says which moments are shown, and --frame-time does too",
                               "leave one of them out");
        const auto range = parse_frames(o.frames);
        if (!range) return range.error();
        const double fps = o.fps.value_or(kDefaultFps);
        for (uint32_t k = range->first; k <= range->last; ++k) out.push_back({k, k / fps, std::nullopt});
    } else if (o.turns) {
        if (settings.turn)
            return usage_error("--turntable says how the model is turned, and --turn does too",
                               "leave one of them out");
        for (uint32_t k = 0; k < *o.turns; ++k) out.push_back({k, std::nullopt, 360.0 * k / *o.turns});
    }
    return out;
}

SettingsOptions settings_of(const Shot& shot, const SettingsOptions& settings) {
    SettingsOptions out = settings;
    if (shot.time) out.frame_time = shot.time;
    if (shot.turn) out.turn = shot.turn;
    return out;
}

std::string numbered(const std::string& path, uint32_t number) {
    const size_t name = path.find_last_of('/') == std::string::npos ? 0 : path.find_last_of('/') + 1;
    const size_t last = path.find_last_of('#');
    if (last != std::string::npos && last >= name) {
        size_t first = last;
        while (first > name && path[first - 1] == '#') --first;
        return path.substr(0, first) + fmt::format("{:0{}}", number, last + 1 - first) + path.substr(last + 1);
    }
    const size_t extension = path.size() - extension_of(path).size();
    return path.substr(0, extension) + fmt::format("_{:04}", number) + path.substr(extension);
}

void add_sequence_options(CLI::App* c, SequenceOptions& options) {
    add_text(c, "--frames", options.frames, "for example --frames 1:48",
             "Frames of an animation, the first and the last one included: 1:48 or 1-48. Frame k is the moment\n"
             "k / FPS. Each goes to a file of its own: #### in its name becomes the number (out.####.exr), and\n"
             "without that out.png becomes out_0001.png; each has the bits of --frame-time alone")
        ->type_name("FIRST:LAST")
        ->group("Sequence");
    add_real(c, "--fps", options.fps, 1e-3, 1e6, "Frames a second, for --frames")
        ->default_str(fmt::format("{}", kDefaultFps))
        ->group("Sequence");
    add_count<uint32_t>(
        c, "--turntable", options.turns, 1, kMostTurns,
        "So many pictures of the model as it turns once about the vertical through its middle, in equal\n"
        "steps, counter-clockwise seen from above, with numbers from 0. The camera is chosen so that the\n"
        "model stays in view; it stands still, and so do the environment, the sun and the studio")
        ->group("Sequence");
}

}  // namespace steradian::cli
