#include "formats/obj/records.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "base/text.h"
#include "formats/mesh/parse_failure.h"
#include "formats/obj/lines.h"
#include "math/vector.h"

namespace steradian::obj {
namespace {

/// How many v, vt and vn there are: in the whole file, or before some place.
struct Counts {
    size_t positions = 0, uvs = 0, normals = 0;

    Counts& operator+=(const Counts& other) {
        positions += other.positions;
        uvs += other.uvs;
        normals += other.normals;
        return *this;
    }
};

std::string_view keyword_of(std::string_view line) { return Words(line).peek(); }

Counts count_elements(std::string_view text, size_t begin, size_t end) {
    Counts counts;
    Lines lines(text, begin, end);
    for (std::string_view line; lines.next(line);) {
        if (line.front() != 'v') continue;
        const std::string_view keyword = keyword_of(line);
        counts.positions += keyword == "v";
        counts.uvs += keyword == "vt";
        counts.normals += keyword == "vn";
    }
    return counts;
}

constexpr std::array<std::string_view, 15> kFreeForm{"vp",   "deg",  "bmat", "step", "cstype", "curv", "curv2", "surf",
                                                     "parm", "trim", "hole", "scrv", "sp",     "end",  "con"};
/// Display attributes and old statements without an influence on the surface.
constexpr std::array<std::string_view, 12> kQuiet{"mg",     "bevel", "c_interp", "d_interp",   "lod",       "usemap",
                                                  "maplib", "ctech", "stech",    "shadow_obj", "trace_obj", "bsp"};

bool among(std::span<const std::string_view> words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Reads the lines of one chunk. Element lists are written in place, faces are kept in runs.
class ChunkReader {
public:
    ChunkReader(std::string_view text, Records& all, Counts before, Counts total)
        : first_position(before.positions), text_(text), all_(all), seen_(before), total_(total) {}

    void read(size_t begin, size_t end) {
        Lines lines(text_, begin, end);
        for (std::string_view line; lines.next(line);) read_line(line);
    }

    const size_t first_position;  ///< of this chunk
    std::vector<Run> runs;
    std::vector<Library> libraries;
    std::vector<Rgb> colors;  ///< of this chunk's positions, up to the last that has one; white for those without
    Notes<Remark> notes;
    State state;  ///< what this chunk said last

private:
    size_t offset_of(const char* p) const { return static_cast<size_t>(p - text_.data()); }
    [[noreturn]] void fail(const char* at, std::string message, std::string hint = {}) const {
        throw ParseFailure{offset_of(at), std::move(message), std::move(hint)};
    }

    void read_line(std::string_view line);
    void read_other(std::string_view keyword, Words& words);
    void read_position(Words& words);
    void read_uv(Words& words);
    void read_normal(Words& words);
    void read_face(std::string_view keyword, Words& words);
    void read_smoothing(Words& words);
    float required(Words& words, std::string_view expected) const;
    Corner read_corner(std::string_view word);
    int32_t read_index(const char*& at, const char* end, size_t seen, size_t total, const char* kind,
                       const char* keyword) const;
    Run& run();

    std::string_view text_;
    Records& all_;
    Counts seen_, total_;
    bool state_changed_ = true;
    std::vector<Corner> face_;
};

float ChunkReader::required(Words& words, std::string_view expected) const {
    if (const auto value = words.number()) return *value;
    const bool end = !words.more();
    fail(words.position(), (end ? std::string("the line ends here") : quoted(words.peek()) + " is not a number") +
                               ", expected " + std::string(expected));
}

void ChunkReader::read_position(Words& words) {
    constexpr std::string_view kExpected = "three coordinates";
    Vec3& p = all_.positions[seen_.positions++];
    p.x = required(words, kExpected);
    p.y = required(words, kExpected);
    p.z = required(words, kExpected);
    // A weight (for rational curves only), or a colour, or both may follow.
    words.more();
    const char* const first = words.position();
    int extra = 0;
    Rgb color;
    for (; words.more(); ++extra) {
        const float value = required(words, "a weight or a colour after the coordinates");
        color = {color.g, color.b, value > 0 && is_finite(value) ? value : 0};
    }
    if (extra > 4) fail(first, "too many numbers, expected three coordinates and at most a weight or a colour");
    if (extra < 3) return;
    colors.resize(seen_.positions - first_position, {1, 1, 1});
    colors.back() = color;
}

void ChunkReader::read_uv(Words& words) {
    constexpr std::string_view kExpected = "one to three texture coordinates";
    Vec2& uv = all_.uvs[seen_.uvs++];
    uv.x = required(words, kExpected);
    if (words.more()) uv.y = required(words, kExpected);
    if (words.more()) required(words, kExpected);
    if (words.more()) fail(words.position(), "too many numbers, expected one to three texture coordinates");
}

void ChunkReader::read_normal(Words& words) {
    constexpr std::string_view kExpected = "the three components of a normal";
    Vec3& n = all_.normals[seen_.normals++];
    n.x = required(words, kExpected);
    n.y = required(words, kExpected);
    n.z = required(words, kExpected);
    if (words.more()) fail(words.position(), "too many numbers, expected the three components of a normal");
}

/// One index at `at`: counted from 1, or backwards from the last element before this line. May refer to later lines.
int32_t ChunkReader::read_index(const char*& at, const char* end, size_t seen, size_t total, const char* kind,
                                const char* keyword) const {
    const char* const begin = at;
    int64_t value = 0;
    const auto [stop, error] = std::from_chars(at + (at < end && *at == '+'), end, value);
    if (error == std::errc::invalid_argument || (stop != end && *stop != '/'))
        fail(begin, quoted({begin, static_cast<size_t>(end - begin)}) + " is not a corner of a face",
             "corners are v, v/vt, v//vn or v/vt/vn, with whole numbers");
    at = stop;
    const bool in_range =
        error == std::errc() && (value > 0 ? uint64_t(value) <= total : value < 0 && uint64_t(-(value + 1)) < seen);
    if (in_range) return static_cast<int32_t>(value > 0 ? value - 1 : static_cast<int64_t>(seen) + value);
    const std::string number = escape_for_display({begin, static_cast<size_t>(stop - begin)}, 40);
    std::string expected =
        total == 0 ? std::string("the file has no ") + keyword + " lines" : "expected 1 to " + std::to_string(total);
    if (total != 0 && seen != 0) expected += ", or -" + std::to_string(seen) + " to -1";
    fail(begin, std::string(kind) + " index " + number + " is out of range: " + expected);
}

Corner ChunkReader::read_corner(std::string_view word) {
    const char* at = word.data();
    const char* const end = at + word.size();
    Corner corner;
    corner.position = read_index(at, end, seen_.positions, total_.positions, "vertex", "v");
    // Normals or texture coordinates that were stripped from the file are not missed, but said.
    const auto attribute = [&](size_t seen, size_t total, const char* kind, const char* keyword, Remark remark) {
        ++at;  // the '/'
        if (at == end || *at == '/') return kNone;
        if (total != 0) return read_index(at, end, seen, total, kind, keyword);
        notes.add(remark, {}, offset_of(word.data()));
        while (at < end && *at != '/') ++at;
        return kNone;
    };
    if (at < end) corner.uv = attribute(seen_.uvs, total_.uvs, "texture", "vt", Remark::uvs_missing);
    if (at < end) corner.normal = attribute(seen_.normals, total_.normals, "normal", "vn", Remark::normals_missing);
    if (at < end) fail(at, quoted(word) + " is not a corner of a face", "corners are v, v/vt, v//vn or v/vt/vn");
    return corner;
}

Run& ChunkReader::run() {
    if (state_changed_) runs.push_back({state, {}, {}});
    state_changed_ = false;
    return runs.back();
}

void ChunkReader::read_face(std::string_view keyword, Words& words) {
    face_.clear();
    while (words.more()) face_.push_back(read_corner(words.word()));
    if (face_.size() < 3)
        fail(keyword.data(), "a face of " + std::to_string(face_.size()) +
                                 (face_.size() == 1 ? " corner" : " corners") + ", expected at least 3");
    if (face_.size() > std::numeric_limits<uint32_t>::max())
        throw ParseFailure{offset_of(keyword.data()), "a face of more than 2^32 - 1 corners", {}, ErrorCode::resources};
    Run& target = run();
    target.sizes.push_back(static_cast<uint32_t>(face_.size()));
    target.corners.insert(target.corners.end(), face_.begin(), face_.end());
}

void ChunkReader::read_smoothing(Words& words) {
    words.more();
    const char* const at = words.position();
    const std::string_view word = words.word();
    uint32_t group = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), group);
    if (word == "on")
        group = 1;
    else if (word != "off" && (error != std::errc() || stop != word.data() + word.size())) {
        group = 0;
        notes.add(Remark::bad_smoothing, {}, offset_of(at));
    }
    state.smoothing = group;
    state_changed_ = true;
}

void ChunkReader::read_other(std::string_view keyword, Words& words) {
    const size_t offset = offset_of(keyword.data());
    if (keyword == "usemtl") {
        state.material = words.rest();
        state_changed_ = true;
    } else if (keyword == "g" || keyword == "o") {
        state.group = words.rest();
        state_changed_ = true;
    } else if (keyword == "s") {
        read_smoothing(words);
    } else if (keyword == "mtllib") {
        const std::string_view names = words.rest();
        if (names.empty()) fail(keyword.data(), "mtllib without a file name");
        libraries.push_back({names, offset_of(names.data())});
    } else if (keyword == "p") {
        notes.add(Remark::points, {}, offset);
    } else if (keyword == "l") {
        notes.add(Remark::lines, {}, offset);
    } else if (among(kFreeForm, keyword)) {
        notes.add(Remark::free_form, {}, offset);
    } else if (!among(kQuiet, keyword)) {
        notes.add(Remark::unknown_keyword, keyword, offset);
    }
}

void ChunkReader::read_line(std::string_view line) {
    Words words(line);
    const std::string_view keyword = words.word();
    if (keyword == "v")
        read_position(words);
    else if (keyword == "vt")
        read_uv(words);
    else if (keyword == "vn")
        read_normal(words);
    else if (keyword == "f" || keyword == "fo")
        read_face(keyword, words);
    else
        read_other(keyword, words);
}

/// Offsets at which chunks begin, and the end: after line ends that no backslash precedes, so that no logical line is
/// cut.
std::vector<size_t> cut(std::string_view text, size_t chunk_bytes) {
    std::vector<size_t> bounds{text.substr(0, 3) == "\xef\xbb\xbf" ? size_t(3) : size_t(0)};
    while (text.size() - bounds.back() > chunk_bytes) {
        size_t at = bounds.back() + std::max<size_t>(chunk_bytes, 1);
        for (; at < text.size(); ++at) {
            const char c = text[at - 1];
            if (c != '\n' && c != '\r') continue;
            const bool crlf = c == '\n' && at >= 2 && text[at - 2] == '\r';
            const bool split_crlf = c == '\r' && text[at] == '\n';
            const size_t before = at - (crlf ? 2 : 1);
            if (!split_crlf && (before == 0 || text[before - 1] != '\\')) break;
        }
        bounds.push_back(at);
    }
    if (bounds.back() != text.size()) bounds.push_back(text.size());
    return bounds;
}

/// Joins what the chunks found, in order: what a chunk did not say is as the chunks before it said.
void join(std::vector<ChunkReader>& chunks, Records& all) {
    State carried;
    const auto complete = [&](State& state) {
        if (!state.material) state.material = carried.material;
        if (!state.group) state.group = carried.group;
        if (!state.smoothing) state.smoothing = carried.smoothing;
    };
    for (ChunkReader& chunk : chunks) {
        for (Run& run : chunk.runs) {
            complete(run.state);
            all.runs.push_back(std::move(run));
        }
        complete(chunk.state);
        carried = chunk.state;
        all.libraries.insert(all.libraries.end(), chunk.libraries.begin(), chunk.libraries.end());
        all.notes.append(chunk.notes);
        if (chunk.colors.empty()) continue;
        all.colors.resize(all.positions.size(), {1, 1, 1});
        std::copy(chunk.colors.begin(), chunk.colors.end(),
                  all.colors.begin() + static_cast<std::ptrdiff_t>(chunk.first_position));
    }
}

}  // namespace

Records read_records(std::string_view text, size_t chunk_bytes) {
    refuse_foreign_encoding(text);
    const std::vector<size_t> bounds = cut(text, chunk_bytes);
    const size_t chunks = bounds.size() - 1;

    std::vector<Counts> counts(chunks);
    parallel_for(chunks, 1, [&](size_t i, size_t) { counts[i] = count_elements(text, bounds[i], bounds[i + 1]); });
    Counts total;
    for (const Counts& c : counts) total += c;
    for (const size_t n : {total.positions, total.uvs, total.normals})
        if (n > size_t(std::numeric_limits<int32_t>::max()))
            throw ParseFailure{0, "more than 2^31 - 1 vertices", {}, ErrorCode::resources};

    Records all;
    all.positions.resize(total.positions);
    all.uvs.resize(total.uvs);
    all.normals.resize(total.normals);
    std::vector<ChunkReader> readers;
    readers.reserve(chunks);
    Counts before;
    for (size_t i = 0; i < chunks; ++i) {
        readers.emplace_back(text, all, before, total);
        before += counts[i];
    }
    std::vector<std::optional<ParseFailure>> failures(chunks);
    parallel_for(chunks, 1, [&](size_t i, size_t) {
        try {
            readers[i].read(bounds[i], bounds[i + 1]);
        } catch (const ParseFailure& failure) {
            failures[i] = failure;
        }
    });
    for (const auto& failure : failures)
        if (failure) throw *failure;
    join(readers, all);
    return all;
}

Records read_records(std::string_view text) { return read_records(text, size_t(1) << 20); }

}  // namespace steradian::obj
