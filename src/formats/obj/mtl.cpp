#include "formats/obj/mtl.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "base/text.h"
#include "formats/mesh/asset_path.h"
#include "formats/mesh/parse_failure.h"
#include "formats/obj/lines.h"
#include "formats/obj/notes.h"
#include "math/vector.h"

namespace steradian {
namespace {

using obj::Lines;
using obj::Words;

enum class Remark : uint8_t {
    unknown_keyword,
    unknown_option,
    bad_value,      ///< word: the keyword
    clamped,        ///< word: the keyword
    spectral,       ///< Kd spectral file.rfl, Kd xyz x y z
    no_file_name,   ///< word: the keyword
    no_material,    ///< a value before the first newmtl
    duplicate,      ///< word: the material
    contradiction,  ///< d and Tr disagree
};

std::string describe(Remark kind, std::string_view word) {
    const std::string name = word.empty() ? "others" : quoted(word, 60);
    switch (kind) {
        case Remark::unknown_keyword:
            return "unknown material keyword " + name + " ignored";
        case Remark::unknown_option:
            return "unknown texture option " + name + " ignored";
        case Remark::bad_value:
            return "the value of " + name + " is not what was expected (numbers); the default is used";
        case Remark::clamped:
            return "the value of " + name + " is out of range and was clamped";
        case Remark::spectral:
            return "spectral and XYZ colours are not supported (" + name + "); the default is used";
        case Remark::no_file_name:
            return name + " without a file name ignored";
        case Remark::no_material:
            return name + " before the first newmtl ignored";
        case Remark::duplicate:
            return "material " + name + " is defined more than once; the first definition counts";
        case Remark::contradiction:
            return "d and Tr contradict each other in material " + name + "; d counts";
    }
    return {};
}

/// Keywords of Wavefront's, of the PBR extension and of common exporters that say nothing we use.
constexpr std::array<std::string_view, 47> kQuiet{
    "ka",       "ns",          "sharpness",  "map_ka",    "map_ks",   "map_ns",    "map_d",     "map_tr",
    "map_bump", "bump",        "disp",       "map_disp",  "decal",    "refl",      "map_refl",  "map_aat",
    "pr",       "pm",          "ps",         "pc",        "pcr",      "aniso",     "anisor",    "norm",
    "map_pr",   "map_pm",      "map_ps",     "map_ke",    "map_norm", "map_kn",    "km",        "fr",
    "ft",       "ia",          "map_rma",    "map_orm",   "map_ni",   "map_tf",    "map_pc",    "map_pcr",
    "map_ao",   "map_opacity", "illum_name", "refl_type", "kn",       "map_aniso", "map_anisor"};

/// One texture option: its name and how many words follow it, at least and at most.
struct OptionRule {
    std::string_view name;
    int least, most;
    bool numbers;
};
constexpr std::array<OptionRule, 14> kOptions{{{"-blendu", 1, 1, false},
                                               {"-blendv", 1, 1, false},
                                               {"-boost", 1, 1, true},
                                               {"-bm", 1, 1, true},
                                               {"-cc", 1, 1, false},
                                               {"-clamp", 1, 1, false},
                                               {"-colorspace", 1, 1, false},
                                               {"-imfchan", 1, 1, false},
                                               {"-mm", 1, 2, true},
                                               {"-o", 1, 3, true},
                                               {"-s", 1, 3, true},
                                               {"-t", 1, 3, true},
                                               {"-texres", 1, 1, true},
                                               {"-type", 1, 1, false}}};

class LibraryReader {
public:
    LibraryReader(std::string_view text, const std::string& folder, const LoadOptions& options)
        : text_(text), folder_(folder), options_(options) {}

    void read();

    std::vector<MeshMaterial> materials;
    obj::Notes<Remark> notes;

private:
    size_t offset_of(const char* p) const { return static_cast<size_t>(p - text_.data()); }
    void begin_material(std::string_view keyword, Words& words);
    void end_material();
    void read_value(std::string_view keyword, Words& words);
    void read_color(std::string_view keyword, Words& words, Rgb& color);
    std::optional<float> read_scalar(std::string_view keyword, Words& words, float low, float high);
    void read_map(std::string_view keyword, Words& words);
    bool read_option(Words& words);
    void set_number_option(std::string_view name, const std::array<float, 3>& values, int count);

    std::string_view text_;
    const std::string& folder_;
    const LoadOptions& options_;

    bool open_ = false;      ///< a newmtl has come
    bool repeated_ = false;  ///< its name was defined before
    MeshMaterial current_;
    std::string_view current_name_;
    std::optional<float> dissolve_, transparency_;
    std::set<std::string_view> names_;
};

void LibraryReader::begin_material(std::string_view keyword, Words& words) {
    end_material();
    current_ = {};
    dissolve_ = transparency_ = std::nullopt;
    current_name_ = words.rest();
    current_.name = std::string(current_name_);
    current_.where.byte = offset_of(current_name_.data());
    open_ = true;
    repeated_ = !names_.insert(current_name_).second;
    if (repeated_) notes.add(Remark::duplicate, current_name_, offset_of(keyword.data()));
}

void LibraryReader::end_material() {
    if (!open_ || repeated_) return;
    // Some exporters write Tr as another name of d: where both stand, d is the one that all of them mean alike.
    if (dissolve_)
        current_.dissolve = *dissolve_;
    else if (transparency_)
        current_.dissolve = 1 - *transparency_;
    if (dissolve_ && transparency_ && std::fabs(*dissolve_ + *transparency_ - 1) > 1e-3f)
        notes.add(Remark::contradiction, current_name_, offset_of(current_name_.data()));
    materials.push_back(std::move(current_));
}

std::optional<float> LibraryReader::read_scalar(std::string_view keyword, Words& words, float low, float high) {
    const auto value = words.number();
    if (!value || std::isnan(*value)) {
        notes.add(Remark::bad_value, keyword, offset_of(words.position()));
        return std::nullopt;
    }
    if (*value < low || *value > high) notes.add(Remark::clamped, keyword, offset_of(keyword.data()));
    return clamp_to(*value, low, high);
}

/// One number is a grey, three are a colour.
void LibraryReader::read_color(std::string_view keyword, Words& words, Rgb& color) {
    constexpr float kLargest = 1e15f;
    const std::string_view first = words.peek();
    if (first == "spectral" || first == "xyz") {
        notes.add(Remark::spectral, keyword, offset_of(first.data()));
        return;
    }
    const auto r = read_scalar(keyword, words, 0, kLargest);
    if (!r) return;
    if (!words.more()) {
        color = {*r, *r, *r};
        return;
    }
    const auto g = read_scalar(keyword, words, 0, kLargest);
    const auto b = g ? read_scalar(keyword, words, 0, kLargest) : std::nullopt;
    if (b) color = {*r, *g, *b};
}

/// Offsets and scales act on the file's coordinates, v upwards; with v' = 1 - v, (v s + o)' = v' s + (1 - s - o).
void LibraryReader::set_number_option(std::string_view name, const std::array<float, 3>& values, int count) {
    if (name == "-s") current_.map_scale = {values[0], count > 1 ? values[1] : current_.map_scale.y};
    if (name == "-o") current_.map_offset = {values[0], count > 1 ? values[1] : current_.map_offset.y};
}

/// Consumes one option with its values; false at the file name.
bool LibraryReader::read_option(Words& words) {
    const std::string_view name = words.peek();
    if (name.size() < 2 || name.front() != '-') return false;
    const auto rule =
        std::find_if(kOptions.begin(), kOptions.end(), [&](const OptionRule& o) { return iequals(o.name, name); });
    if (rule == kOptions.end()) {
        if (obj::parse_number(name) || name.find('.') != name.npos) return false;  // "-1.png"
        notes.add(Remark::unknown_option, name, offset_of(name.data()));
        words.word();
        return true;
    }
    words.word();
    if (!rule->numbers) {
        const std::string_view value = words.word();
        if (rule->name == "-clamp") current_.map_clamp = iequals(value, "on");
        return true;
    }
    constexpr float kLargest = 1e9f;  // so that sums with it stay finite
    std::array<float, 3> values{};
    int count = 0;
    for (; count < rule->most; ++count) {
        // A number is a value of the option unless it is the last word: then it is the name of a file.
        Words ahead = words;
        const auto value = ahead.number();
        if (!value || !ahead.more(false)) break;
        values[static_cast<size_t>(count)] = clamp_to(*value, -kLargest, kLargest);
        words = ahead;
    }
    if (count < rule->least)
        notes.add(Remark::bad_value, name, offset_of(name.data()));
    else
        set_number_option(rule->name, values, count);
    return true;
}

void LibraryReader::read_map(std::string_view keyword, Words& words) {
    current_.map_scale = {1, 1};
    current_.map_offset = {0, 0};
    current_.map_clamp = false;
    while (read_option(words)) {
    }
    current_.map_offset.y = 1 - current_.map_scale.y - current_.map_offset.y;
    std::string_view file = words.rest();
    if (file.size() >= 2 && file.front() == '"' && file.back() == '"') file = file.substr(1, file.size() - 2);
    if (file.empty()) {
        notes.add(Remark::no_file_name, keyword, offset_of(keyword.data()));
        return;
    }
    if (!options_.allow_outside_paths.value_or(true) && leaves_folder(file))
        throw ParseFailure{offset_of(file.data()), "the texture lies outside of the model's folder",
                           "move it there, or allow outside paths"};
    current_.diffuse_map = resolve_asset(file, folder_);
    current_.diffuse_map_where.byte = offset_of(file.data());
}

void LibraryReader::read_value(std::string_view keyword, Words& words) {
    constexpr float kLargestIndex = 1000;
    const auto is = [&](std::string_view word) { return iequals(keyword, word); };
    if (is("Kd"))
        read_color(keyword, words, current_.diffuse);
    else if (is("Ks"))
        read_color(keyword, words, current_.specular);
    else if (is("Ke"))
        read_color(keyword, words, current_.emission);
    else if (is("Tf"))
        read_color(keyword, words, current_.transmission);
    else if (is("Ni"))
        current_.ior = read_scalar(keyword, words, 0.001f, kLargestIndex).value_or(current_.ior);
    else if (is("illum"))
        current_.illum = static_cast<int>(read_scalar(keyword, words, 0, 10).value_or(2));
    else if (is("Tr"))
        transparency_ = read_scalar(keyword, words, 0, 1);
    else if (is("d")) {
        if (words.peek() == "-halo") words.word();
        dissolve_ = read_scalar(keyword, words, 0, 1);
    } else if (is("map_Kd"))
        read_map(keyword, words);
    else if (std::none_of(kQuiet.begin(), kQuiet.end(), is))
        notes.add(Remark::unknown_keyword, keyword, offset_of(keyword.data()));
}

void LibraryReader::read() {
    refuse_foreign_encoding(text_);
    Lines lines(text_, text_.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0, text_.size());
    for (std::string_view line; lines.next(line);) {
        Words words(line);
        const std::string_view keyword = words.word();
        if (iequals(keyword, "newmtl"))
            begin_material(keyword, words);
        else if (open_)
            read_value(keyword, words);
        else
            notes.add(Remark::no_material, keyword, offset_of(keyword.data()));
    }
    end_material();
}

/// Lines and columns for the byte offsets, in one walk: they come in the order of the file.
void locate(std::string_view text, const std::string& name, std::vector<MeshMaterial>& materials) {
    uint32_t line = 1;
    size_t at = 0, begin = 0;
    for (MeshMaterial& material : materials)
        for (SourceLocation* where : {&material.where, &material.diffuse_map_where}) {
            if (!where->byte) continue;
            const size_t offset = *where->byte;
            for (; at < offset; ++at)
                if (text[at] == '\n') ++line, begin = at + 1;
            *where = {name, line, static_cast<uint32_t>(offset - begin + 1), {}};
        }
}

}  // namespace

Result<MaterialLibrary> parse_mtl(std::string_view text, const std::string& name, const std::string& folder,
                                  const LoadOptions& options) {
    try {
        LibraryReader reader(text, folder, options);
        reader.read();
        MaterialLibrary library;
        for (const auto& note : reader.notes.all())
            library.diagnostics.warn(describe(note.kind, note.word), text_location(text, name, note.offset),
                                     note.count);
        library.materials = std::move(reader.materials);
        locate(text, name, library.materials);
        return library;
    } catch (const ParseFailure& failure) {
        return text_error(text, name, failure);
    } catch (const std::bad_alloc&) {
        return out_of_memory(name);
    }
}

}  // namespace steradian
