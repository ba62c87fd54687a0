// PLY (Turk 1994): ascii and both binary orders, any order of elements and properties.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/text.h"
#include "formats/mesh/parse_failure.h"
#include "formats/mesh/polygon.h"
#include "formats/mesh_file.h"
#include "formats/ply/header.h"
#include "formats/ply/source.h"
#include "math/ray.h"
#include "math/vector.h"

namespace steradian {
namespace {

using ply::Element;
using ply::Encoding;
using ply::Header;
using ply::Property;
using ply::Scalar;

/// Nearest float; beyond the largest one infinity, as the conversion is only defined inside.
float to_float(double value) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    if (value > kLargest) return std::numeric_limits<float>::infinity();
    if (value < -kLargest) return -std::numeric_limits<float>::infinity();
    return static_cast<float>(value);
}

/// What a colour is divided by: integers by their largest value.
float color_scale(Scalar type) {
    switch (type) {
        case Scalar::i8:
            return 127;
        case Scalar::u8:
            return 255;
        case Scalar::i16:
            return 32767;
        case Scalar::u16:
            return 65535;
        case Scalar::i32:
            return 2147483647.0f;
        case Scalar::u32:
            return 4294967295.0f;
        default:
            return 1;
    }
}

/// What is no colour is black.
float color_value(float value, float scale) { return value > 0 && is_finite(value) ? value / scale : 0; }

/// What the data say, before polygons become triangles.
struct Contents {
    Mesh mesh;                      ///< without indices
    std::vector<uint32_t> sizes;    ///< corners per polygon, each >= 3
    std::vector<uint32_t> corners;  ///< of all polygons, one after the other
    uint64_t too_small = 0;         ///< faces of fewer than three corners
    size_t too_small_at = 0;        ///< byte of the first one
    bool trailing = false;          ///< something follows the last element
    bool linear_colors = false;     ///< they are floating-point numbers
    size_t end = 0;                 ///< byte where it begins
};

template <class Source>
class BodyReader {
public:
    BodyReader(const Header& header, Source source, size_t data_size)
        : header_(header), source_(std::move(source)), data_size_(data_size) {}

    Contents read() {
        const auto vertex = std::find_if(header_.elements.begin(), header_.elements.end(),
                                         [](const Element& e) { return e.name == "vertex"; });
        if (vertex == header_.elements.end())
            throw ParseFailure{header_.end_line, "the header has no element vertex", {}};
        if (vertex->count > std::numeric_limits<uint32_t>::max())
            throw ParseFailure{vertex->offset, "more than 2^32 - 1 vertices", {}, ErrorCode::resources};
        vertices_ = vertex->count;
        for (const Element& element : header_.elements) read_element(element);
        out_.trailing = !source_.at_end();
        out_.end = source_.position();
        return std::move(out_);
    }

private:
    void read_element(const Element& element) {
        const uint64_t least = element.least_bytes(header_.encoding);
        const uint64_t left =
            data_size_ - std::min(data_size_, source_.position()) + (header_.encoding == Encoding::ascii);
        if (least != 0 && element.count > left / least)
            throw ParseFailure{element.offset,
                               "element '" + escape_for_display(element.name, 40) + "': the file is too short for " +
                                   std::to_string(element.count) + " of them, expected at most " +
                                   std::to_string(left / least),
                               "is the file cut off?"};
        try {
            number_ = 0;
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face" || element.name == "tristrips")
                read_faces(element);
            else
                skip_all(element);
        } catch (const ply::Truncated&) {
            throw ParseFailure{data_size_,
                               "the file ends inside of element '" + escape_for_display(element.name, 40) +
                                   "', at number " + std::to_string(number_ + 1) + " of " +
                                   std::to_string(element.count),
                               "is the file cut off?"};
        }
    }

    void skip(const Property& property) {
        if (property.is_list)
            source_.skip(property.type, list_length(property));
        else
            source_.skip(property.type, 1);
    }
    void skip_all(const Element& element) {
        if (element.properties.empty()) return;
        for (; number_ < element.count; ++number_)
            for (const Property& property : element.properties) skip(property);
    }

    uint64_t list_length(const Property& property) {
        const size_t at = source_.position();
        const double length = source_.number(property.count_type);
        if (!(length >= 0) || length != std::floor(length))
            throw ParseFailure{
                at,
                "the length of list '" + escape_for_display(property.name, 40) + "' is not a whole number from 0 on",
                {}};
        const uint64_t room = source_.room(ply::size_of(property.type));
        if (length > static_cast<double>(room))
            throw ParseFailure{
                at, "list '" + escape_for_display(property.name, 40) + "' is longer than the rest of the file", {}};
        return static_cast<uint64_t>(length);
    }

    void read_vertices(const Element& element);
    void read_faces(const Element& element);
    void read_polygon(uint64_t length, Scalar type, size_t at);
    void read_strips(uint64_t length, Scalar type);
    uint32_t read_index(Scalar type, bool may_restart);
    static constexpr uint32_t kRestart = std::numeric_limits<uint32_t>::max();

    const Header& header_;
    Source source_;
    size_t data_size_;
    uint64_t vertices_ = 0;
    uint64_t number_ = 0;  ///< of the current element
    Contents out_;
};

template <class Source>
void BodyReader<Source>::read_vertices(const Element& element) {
    constexpr size_t kSlots = 11;  // x y z, nx ny nz, u v, r g b
    const std::array<int, kSlots> at{element.find({"x"}),
                                     element.find({"y"}),
                                     element.find({"z"}),
                                     element.find({"nx"}),
                                     element.find({"ny"}),
                                     element.find({"nz"}),
                                     element.find({"u", "s", "texture_u", "texture_s"}),
                                     element.find({"v", "t", "texture_v", "texture_t"}),
                                     element.find({"red", "diffuse_red", "r"}),
                                     element.find({"green", "diffuse_green", "g"}),
                                     element.find({"blue", "diffuse_blue", "b"})};
    if (at[0] < 0 || at[1] < 0 || at[2] < 0)
        throw ParseFailure{element.offset, "element vertex lacks one of the properties x, y, z", {}};
    const bool normals = at[3] >= 0 && at[4] >= 0 && at[5] >= 0, uvs = at[6] >= 0 && at[7] >= 0;
    const bool colors = at[8] >= 0 && at[9] >= 0 && at[10] >= 0;
    std::vector<int> slot_of(element.properties.size(), -1);
    for (size_t slot = 0; slot < kSlots; ++slot) {
        if (at[slot] < 0) continue;
        const Property& property = element.properties[static_cast<size_t>(at[slot])];
        if (property.is_list)
            throw ParseFailure{
                element.offset,
                "property '" + std::string(property.name) + "' of element vertex is a list, expected a number",
                {}};
        slot_of[static_cast<size_t>(at[slot])] = static_cast<int>(slot);
    }
    Mesh& mesh = out_.mesh;
    const auto count = static_cast<size_t>(element.count);
    mesh.positions.resize(count);
    if (normals) mesh.normals.resize(count);
    if (uvs) mesh.uvs.resize(count);
    std::array<float, kSlots> value{}, scale{};
    if (colors) {
        mesh.colors.resize(count);
        out_.linear_colors = true;
        for (size_t slot = 8; slot < kSlots; ++slot) {
            const Scalar type = element.properties[static_cast<size_t>(at[slot])].type;
            scale[slot] = color_scale(type);
            out_.linear_colors = out_.linear_colors && ply::is_floating(type);
        }
    }
    for (size_t i = 0; i < count; ++i) {
        number_ = i;
        for (size_t p = 0; p < slot_of.size(); ++p) {
            const Property& property = element.properties[p];
            if (slot_of[p] >= 0)
                value[static_cast<size_t>(slot_of[p])] = to_float(source_.number(property.type));
            else
                skip(property);
        }
        mesh.positions[i] = {value[0], value[1], value[2]};
        if (normals) mesh.normals[i] = {value[3], value[4], value[5]};
        if (uvs) mesh.uvs[i] = {value[6], 1 - value[7]};
        if (colors)
            mesh.colors[i] = {color_value(value[8], scale[8]), color_value(value[9], scale[9]),
                              color_value(value[10], scale[10])};
    }
}

template <class Source>
uint32_t BodyReader<Source>::read_index(Scalar type, bool may_restart) {
    const size_t at = source_.position();
    const double value = source_.number(type);
    if (may_restart && value == -1) return kRestart;
    if (value >= 0 && value < static_cast<double>(vertices_) && value == std::floor(value))
        return static_cast<uint32_t>(value);
    const std::string shown = std::fabs(value) < 1e15 && value == std::floor(value)
                                  ? std::to_string(static_cast<int64_t>(value))
                                  : "is not a whole number and";
    throw ParseFailure{
        at,
        "vertex index " + shown + " is out of range: " +
            (vertices_ ? "expected 0 to " + std::to_string(vertices_ - 1) : std::string("the file has no vertices")),
        {}};
}

template <class Source>
void BodyReader<Source>::read_polygon(uint64_t length, Scalar type, size_t at) {
    if (length < 3) {
        if (out_.too_small++ == 0) out_.too_small_at = at;
        for (uint64_t i = 0; i < length; ++i) read_index(type, false);
        return;
    }
    out_.sizes.push_back(static_cast<uint32_t>(length));
    for (uint64_t i = 0; i < length; ++i) out_.corners.push_back(read_index(type, false));
}

/// Triangles (a, b, c), (b, d, c) ... of a strip a, b, c, d; -1 begins a new strip.
template <class Source>
void BodyReader<Source>::read_strips(uint64_t length, Scalar type) {
    uint32_t a = 0, b = 0;
    uint64_t since = 0;  // indices since the last restart
    for (uint64_t i = 0; i < length; ++i) {
        const uint32_t c = read_index(type, true);
        if (c == kRestart) {
            since = 0;
            continue;
        }
        if (since >= 2 && a != b && b != c && c != a) {
            out_.sizes.push_back(3);
            if (since % 2 == 0)
                out_.corners.insert(out_.corners.end(), {a, b, c});
            else
                out_.corners.insert(out_.corners.end(), {b, a, c});
        }
        a = b;
        b = c;
        ++since;
    }
}

template <class Source>
void BodyReader<Source>::read_faces(const Element& element) {
    const int indices = element.find({"vertex_indices", "vertex_index"});
    if (indices < 0 || !element.properties[static_cast<size_t>(indices)].is_list) {
        if (element.count != 0) throw ParseFailure{element.offset, "element face lacks the list vertex_indices", {}};
        return;
    }
    const bool strips = element.name == "tristrips";
    for (; number_ < element.count; ++number_) {
        for (size_t p = 0; p < element.properties.size(); ++p) {
            const Property& property = element.properties[p];
            if (static_cast<int>(p) != indices) {
                skip(property);
                continue;
            }
            const size_t at = source_.position();
            const uint64_t length = list_length(property);
            if (length > std::numeric_limits<uint32_t>::max())
                throw ParseFailure{at, "a face of more than 2^32 - 1 corners", {}, ErrorCode::resources};
            if (strips)
                read_strips(length, property.type);
            else
                read_polygon(length, property.type, at);
        }
    }
}

struct BuildCounts {
    uint64_t not_finite = 0, fans = 0;
};

/// Polygons to triangles; those that use a position that is not usable are dropped.
BuildCounts triangulate(Contents& contents) {
    BuildCounts counts;
    Mesh& mesh = contents.mesh;
    const bool finite = std::all_of(mesh.positions.begin(), mesh.positions.end(), usable_position);
    const bool triangles = std::all_of(contents.sizes.begin(), contents.sizes.end(), [](uint32_t n) { return n == 3; });
    if (finite && triangles) {
        mesh.indices = std::move(contents.corners);
        return counts;
    }
    PolygonTriangulator triangulator;
    std::vector<Vec3> points;
    std::vector<uint32_t> cut;
    size_t begin = 0;
    for (const uint32_t size : contents.sizes) {
        const std::span<const uint32_t> corners(contents.corners.data() + begin, size);
        begin += size;
        points.clear();
        for (const uint32_t corner : corners) points.push_back(mesh.positions[corner]);
        if (!finite && !std::all_of(points.begin(), points.end(), usable_position)) {
            ++counts.not_finite;
            continue;
        }
        cut.clear();
        counts.fans += !triangulator.triangulate(points, cut);
        for (const uint32_t corner : cut) mesh.indices.push_back(corners[corner]);
    }
    // No triangle uses them any more, but later checks see every number of a scene.
    for (Vec3& p : mesh.positions)
        if (!usable_position(p)) p = {0, 0, 0};
    return counts;
}

Contents read_body(const Header& header, std::string_view data) {
    switch (header.encoding) {
        case Encoding::ascii:
            return BodyReader(header, ply::AsciiSource(data, header.size), data.size()).read();
        case Encoding::little_endian:
            return BodyReader(header, ply::BinarySource<false>(data, header.size), data.size()).read();
        case Encoding::big_endian:
            return BodyReader(header, ply::BinarySource<true>(data, header.size), data.size()).read();
    }
    return {};
}

void describe_ignored(const Header& header, std::string_view data, const std::string& name, Diagnostics& diagnostics) {
    for (const Element& element : header.elements) {
        const SourceLocation where = text_location(data, name, element.offset);
        if (element.name == "vertex") {
            const bool red = element.find({"red", "diffuse_red", "r"}) >= 0;
            if (red &&
                (element.find({"green", "diffuse_green", "g"}) < 0 || element.find({"blue", "diffuse_blue", "b"}) < 0))
                diagnostics.warn("vertex colours without green or blue are not used", where);
        } else if (element.name == "face") {
            if (element.find({"texcoord"}) >= 0) diagnostics.warn("texture coordinates of faces are not used", where);
        } else if (element.name != "tristrips" && element.name != "edge" && element.count != 0) {
            diagnostics.warn("element '" + escape_for_display(element.name, 60) + "' ignored", where);
        }
    }
}

/// Faults in the header and in ascii data have a line, those in binary data a byte.
SourceLocation location_of(std::string_view data, const std::string& name, bool text, size_t offset) {
    if (text) return text_location(data, name, offset);
    return {name, 0, 0, offset};
}

Error binary_error(const std::string& name, const ParseFailure& failure) {
    Error error;
    error.code = failure.code;
    error.message = failure.message;
    error.where.file = name;
    error.where.byte = failure.offset;
    error.hint = failure.hint;
    return error;
}

MeshFile read_ply(std::string_view data, const std::string& name, const Header& header, bool text) {
    MeshFile file;
    describe_ignored(header, data, name, file.diagnostics);
    Contents contents = read_body(header, data);
    if (contents.trailing)
        file.diagnostics.warn("data after the last element ignored", location_of(data, name, text, contents.end));
    if (contents.too_small)
        file.diagnostics.warn("faces of fewer than three corners ignored",
                              location_of(data, name, text, contents.too_small_at), contents.too_small);
    const BuildCounts counts = triangulate(contents);
    note_dropped(file, {name, 0, 0, {}}, counts.not_finite);
    if (counts.fans)
        file.diagnostics.warn("polygons that cross themselves were cut into triangles as fans", {name, 0, 0, {}},
                              counts.fans);
    if (contents.linear_colors) file.color_space = ColorSpace::linear;
    if (!contents.mesh.indices.empty()) file.parts.push_back({std::move(contents.mesh), -1, {}});
    return file;
}

}  // namespace

Result<MeshFile> parse_ply(std::string_view data, const std::string& name, const LoadOptions&) {
    Header header;
    bool text = true;
    try {
        header = ply::read_header(data);
        text = header.encoding == Encoding::ascii;
        return read_ply(data, name, header, text);
    } catch (const ParseFailure& failure) {
        if (text || failure.offset < header.size) return text_error(data, name, failure);
        return binary_error(name, failure);
    } catch (const std::bad_alloc&) {
        return out_of_memory(name);
    }
}

}  // namespace steradian
