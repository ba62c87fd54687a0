#include <bit>
#include <cmath>
#include <cstring>

#include "meshes/mesh_test.h"

namespace steradian {
namespace {

using Positions = std::vector<Vec3>;

/// Appends a value in the chosen byte order.
template <class T>
void put(std::string& out, T value, bool big_endian) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (size_t i = 0; i < sizeof(T); ++i) out += bytes[big_endian ? sizeof(T) - 1 - i : i];
}

std::string header(std::string_view format, std::string_view rest) {
    return "ply\nformat " + std::string(format) + " 1.0\ncomment made by hand\nobj_info x\n" + std::string(rest) +
           "end_header\n";
}
constexpr std::string_view kVertex3 = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
constexpr std::string_view kFace1 = "element face 1\nproperty list uchar int vertex_indices\n";

std::string ascii(std::string_view rest, std::string_view data) { return header("ascii", rest) + std::string(data); }
std::string triangle(std::string_view data) { return ascii(std::string(kVertex3) + std::string(kFace1), data); }

TEST(Ply, Ascii) {
    const Mesh mesh = only_mesh(read_ply(triangle("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")));
    EXPECT_EQ(mesh.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.uvs.empty());
}

TEST(Ply, LineEndsOfTheHeader) {
    const std::string lf = triangle("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    for (const std::string_view end : {"\r\n", "\r"}) {
        std::string text;
        for (const char c : lf) text += c == '\n' ? std::string(end) : std::string(1, c);
        EXPECT_EQ(only_mesh(read_ply(text)).positions.size(), 3u);
    }
    // A CR file whose first data byte is an LF; and one with CR LF.
    for (const std::string_view end : {"\r", "\r\n", "\n"}) {
        std::string text;
        for (const char c : header("binary_little_endian",
                                   "element vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement "
                                   "face 1\nproperty list uchar uchar vertex_index\n"))
            text += c == '\n' ? std::string(end) : std::string(1, c);
        text += std::string("\n\n\n\1\2\3\4\5\7\3\0\1\2", 13);
        EXPECT_EQ(only_mesh(read_ply(text)).positions, (Positions{{10, 10, 10}, {1, 2, 3}, {4, 5, 7}}));
    }
}

/// Writes the value with the type of this name.
void put_typed(std::string& out, std::string_view type, double value, bool big) {
    if (type == "char" || type == "int8")
        put(out, static_cast<int8_t>(value), big);
    else if (type == "uchar" || type == "uint8")
        put(out, static_cast<uint8_t>(value), big);
    else if (type == "short" || type == "int16")
        put(out, static_cast<int16_t>(value), big);
    else if (type == "ushort" || type == "uint16")
        put(out, static_cast<uint16_t>(value), big);
    else if (type == "int" || type == "int32")
        put(out, static_cast<int32_t>(value), big);
    else if (type == "uint" || type == "uint32")
        put(out, static_cast<uint32_t>(value), big);
    else if (type == "float" || type == "float32")
        put(out, static_cast<float>(value), big);
    else
        put(out, value, big);
}

TEST(Ply, EveryTypeInEveryEncoding) {
    for (const std::string type : {"char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int",
                                   "int32", "uint", "uint32", "float", "float32", "double", "float64"}) {
        // The type is that of coordinates, list lengths and indices; around them stands what has to be skipped.
        const std::string rest = "element junk 2\nproperty " + type + " a\nproperty list " + type + " " + type +
                                 " b\nelement vertex 3\nproperty list uchar short c\nproperty " + type +
                                 " z\nproperty " + type + " x\nproperty uchar red\nproperty " + type +
                                 " y\nelement face 1\nproperty double d\nproperty list " + type + " " + type +
                                 " vertex_indices\nproperty list uchar float e\n";
        const std::vector<std::array<double, 3>> points{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
        std::string text = header("ascii", rest) + "1 0\n2 2 7 7\n";
        for (const auto& p : points)
            text += "2 -1 -2 " + std::to_string(int(p[2])) + " " + std::to_string(int(p[0])) + " 255 " +
                    std::to_string(int(p[1])) + "\n";
        text += "0.5 3 2 0 1 1 0.5\n";
        std::vector<std::string> files{text};
        for (const bool big : {false, true}) {
            std::string data = header(big ? "binary_big_endian" : "binary_little_endian", rest);
            for (const double v : {1, 0, 2, 2, 7, 7}) put_typed(data, type, v, big);
            for (const auto& p : points) {
                put<uint8_t>(data, 2, big);
                put<int16_t>(data, -1, big);
                put<int16_t>(data, -2, big);
                put_typed(data, type, p[2], big);
                put_typed(data, type, p[0], big);
                put<uint8_t>(data, 255, big);
                put_typed(data, type, p[1], big);
            }
            put<double>(data, 0.5, big);
            for (const double v : {3, 2, 0, 1}) put_typed(data, type, v, big);
            put<uint8_t>(data, 1, big);
            put<float>(data, 0.5f, big);
            files.push_back(data);
        }
        for (const std::string& file : files) {
            const MeshFile result = expect_ok(read_ply(file));
            ASSERT_EQ(result.parts.size(), 1u);
            EXPECT_EQ(result.parts[0].mesh.positions, (Positions{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}})) << type;
            EXPECT_EQ(result.parts[0].mesh.indices, (std::vector<uint32_t>{2, 0, 1})) << type;
            EXPECT_EQ(warning_count(result.diagnostics, "'junk'"), 1u);
            EXPECT_EQ(warning_count(result.diagnostics, "colours"), 1u);
        }
    }
}

/// Integers over their largest value, meant as sRGB; floating-point numbers as they are, meant as linear.
TEST(Ply, VerticesHaveColours) {
    const auto file = [](const std::string& type, const std::string& color) {
        return read_ply(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "property " +
            type + " red\nproperty " + type + " green\nproperty " + type +
            " blue\nproperty uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "1 0 0 " +
            color + " 9\n0 1 0 " + color + " 9\n0 0 1 " + color + " 9\n3 0 1 2\n");
    };
    const MeshFile bytes = expect_ok(file("uchar", "0 51 255")), words = expect_ok(file("ushort", "0 13107 65535")),
                   floats = expect_ok(file("float", "0 0.2 1")), bad = expect_ok(file("double", "-1 nan 2"));
    for (const MeshFile* f : {&bytes, &words, &floats}) {
        EXPECT_EQ(f->parts.at(0).mesh.colors, (std::vector<Rgb>(3, Rgb{0, 0.2f, 1})));
        EXPECT_TRUE(f->diagnostics.empty());
    }
    EXPECT_EQ(bytes.color_space, ColorSpace::srgb);
    EXPECT_EQ(words.color_space, ColorSpace::srgb);
    EXPECT_EQ(floats.color_space, ColorSpace::linear);
    EXPECT_EQ(bad.parts.at(0).mesh.colors, (std::vector<Rgb>(3, Rgb{0, 0, 2})));
}

TEST(Ply, NegativeAndLargeValues) {
    for (const bool big : {false, true}) {
        std::string data =
            header(big ? "binary_big_endian" : "binary_little_endian",
                   "element vertex 3\nproperty int x\nproperty short y\nproperty double z\n" + std::string(kFace1));
        for (int i = 0; i < 3; ++i) {
            put<int32_t>(data, -2147483647 - 1, big);
            put<int16_t>(data, -300, big);
            put<double>(data, 0.1, big);
        }
        put<uint8_t>(data, 3, big);
        for (const int32_t v : {0, 1, 2}) put<int32_t>(data, v, big);
        EXPECT_EQ(only_mesh(read_ply(data)).positions[2], (Vec3{-2147483648.0f, -300, 0.1f}));
    }
}

TEST(Ply, NormalsAndTextureCoordinates) {
    for (const auto& [u, v] : {std::pair("u", "v"), std::pair("s", "t"), std::pair("texture_u", "texture_v"),
                               std::pair("texture_s", "texture_t")}) {
        const Mesh mesh =
            only_mesh(read_ply(ascii("element vertex 3\nproperty float nx\nproperty float x\nproperty float "
                                     "ny\nproperty float y\nproperty float nz\nproperty float z\nproperty float " +
                                         std::string(v) + "\nproperty float " + u + "\n" + std::string(kFace1),
                                     "1 0 2 0 3 0 0.25 0.5\n1 1 2 0 3 0 0 1\n1 0 2 1 3 0 1 0\n3 0 1 2")));
        EXPECT_EQ(mesh.positions[1], (Vec3{1, 0, 0}));
        EXPECT_EQ(mesh.normals, Positions(3, Vec3{1, 2, 3}));
        EXPECT_EQ(mesh.uvs, (std::vector<Vec2>{{0.5f, 0.75f}, {1, 1}, {0, 0}}));
    }
}

TEST(Ply, PolygonsSmallFacesAndOrderOfElements) {
    const std::string square = "0 0 0\n2 0 0\n2 2 0\n0 2 0\n";
    const std::string vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string faces = "element face 5\nproperty list uchar int vertex_index\n";
    for (const std::string& text : {ascii(vertices + faces, square + "4 0 1 2 3\n0\n1 2\n2 0 1\n3 0 1 2\n"),
                                    ascii(faces + vertices, "4 0 1 2 3\n0\n1 2\n2 0 1\n3 0 1 2\n" + square)}) {
        const MeshFile file = expect_ok(read_ply(text));
        ASSERT_EQ(file.parts.size(), 1u);
        EXPECT_EQ(file.parts[0].mesh.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3, 0, 1, 2}));
        EXPECT_EQ(warning_count(file.diagnostics, "fewer than three"), 3u);
    }
}

TEST(Ply, TriangleStrips) {
    const Mesh mesh =
        only_mesh(read_ply(ascii("element vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement "
                                 "tristrips 1\nproperty list int int vertex_indices\n",
                                 "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n10 0 1 2 3 4 -1 0 1 1 2\n")));
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 2, 1, 3, 2, 3, 4}));
}

TEST(Ply, NotFiniteCoordinatesDropTheirFaces) {
    const MeshFile file = expect_ok(
        read_ply(ascii("element vertex 6\nproperty float x\nproperty double y\nproperty float z\nelement face "
                       "4\nproperty list uchar int vertex_indices\n",
                       "0 0 0\n1 0 0\n0 1 0\nnan 0 0\n0 1e300 0\n0 0 -inf\n3 0 1 2\n3 0 1 3\n4 0 1 2 4\n3 0 1 5\n")));
    ASSERT_EQ(file.parts.size(), 1u);
    EXPECT_EQ(file.parts[0].mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_EQ(warning_count(file.diagnostics, "not finite"), 3u);
    for (const Vec3 p : file.parts[0].mesh.positions)
        EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
}

TEST(Ply, FilesWithoutFacesAndTrailingData) {
    EXPECT_TRUE(expect_ok(read_ply(ascii(kVertex3, "0 0 0 1 1 1 2 2 2"))).parts.empty());
    EXPECT_TRUE(
        expect_ok(
            read_ply(ascii("element vertex 0\nproperty int x\nproperty int y\nproperty int z\nelement face 0\n", "")))
            .parts.empty());
    const MeshFile file = expect_ok(read_ply(triangle("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n\nmore\n")));
    ASSERT_EQ(file.diagnostics.warnings().size(), 1u);
    EXPECT_EQ(file.diagnostics.warnings()[0].where.line, 17u) << all_warnings(file.diagnostics);
}

TEST(Ply, ElementsWithoutPropertiesCostNothing) {
    EXPECT_EQ(
        only_mesh(read_ply(ascii("element void 18446744073709551615\n" + std::string(kVertex3) + std::string(kFace1),
                                 "0 0 0 1 0 0 0 1 0 3 0 1 2")))
            .indices.size(),
        3u);
}

// --- Errors ----------------------------------------------------------------------------------------------------

struct Refusal {
    std::string data;
    uint32_t line, column;
    const char* message;
};
class PlyRefusals : public testing::TestWithParam<Refusal> {};

TEST_P(PlyRefusals, PointAtTheFault) {
    const Refusal& c = GetParam();
    const auto result = read_ply(c.data);
    ASSERT_FALSE(result.ok());
    const Error& error = result.error();
    EXPECT_EQ(error.where.file, "test.ply");
    EXPECT_EQ(error.where.line, c.line) << error.str();
    EXPECT_EQ(error.where.column, c.column) << error.str();
    EXPECT_NE(error.message.find(c.message), std::string::npos) << error.str();
}

INSTANTIATE_TEST_SUITE_P(
    Header, PlyRefusals,
    testing::Values(
        Refusal{"", 1, 1, "does not begin with 'ply'"}, Refusal{"plx\n", 1, 1, "does not begin"},
        Refusal{"ply", 1, 4, "ends inside of the header"},
        Refusal{"ply\nformat ascii 1.0\nelement vertex 3\n", 4, 1, "ends inside of the header"},
        Refusal{"ply\nformat asci 1.0\n", 2, 8, "unknown format 'asci'"},
        Refusal{"ply\nformat ascii 2.0\n", 2, 14, "unknown version"},
        Refusal{"ply\nformat ascii 1.0\nformat ascii 1.0\n", 3, 8, "second format"},
        Refusal{"ply\nend_header\n", 2, 1, "no format line"},
        Refusal{"ply\nelemnt vertex 3\n", 2, 1, "unknown keyword 'elemnt'"},
        Refusal{"ply\nelement vertex -1\n", 2, 16, "'-1' is not a count"},
        Refusal{"ply\nelement vertex 1e3\n", 2, 16, "not a count"},
        Refusal{"ply\nelement vertex 99999999999999999999\n", 2, 16, "not a count"},
        Refusal{"ply\nelement vertex\n", 2, 15, "not a count"},
        Refusal{"ply\nelement a 1\nelement a 1\n", 3, 9, "second element"},
        Refusal{"ply\nproperty int x\n", 2, 9, "before the first element"},
        Refusal{"ply\nelement a 1\nproperty flot x\n", 3, 10, "unknown type 'flot'"},
        Refusal{"ply\nelement a 1\nproperty list uchar x\n", 3, 21, "unknown type 'x'"},
        Refusal{"ply\nelement a 1\nproperty int\n", 3, 13, "expected the name"},
        Refusal{"ply\nelement a 1\nproperty int x\nproperty float x\n", 4, 16, "second property"},
        Refusal{"ply\nelement a 1 2\n", 2, 13, "unexpected '2'"}, Refusal{ascii(kFace1, ""), 7, 1, "no element vertex"},
        Refusal{ascii("element vertex 1\nproperty float x\nproperty float y\n", "1 2"), 5, 9,
                "lacks one of the properties"},
        Refusal{ascii("element vertex 1\nproperty float x\nproperty float y\nproperty list uchar int z\n", "1 2 1 3"),
                5, 9, "is a list"},
        Refusal{
            ascii(std::string(kVertex3) + "element face 1\nproperty int vertex_indices\n", "0 0 0 1 0 0 0 1 0 3 0 1 2"),
            9, 9, "lacks the list"},
        Refusal{ascii("element vertex 1000000000000\nproperty float x\nproperty float y\nproperty float z\n", "1 2 3"),
                5, 9, "more than 2^32"},
        Refusal{ascii("element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n", "1 2 3"), 5,
                9, "too short for 4000000000"},
        Refusal{ascii(std::string(kVertex3) + "element face 1000000000000\nproperty list uchar int vertex_indices\n",
                      "0 0 0 1 0 0 0 1 0 3 0 1 2"),
                9, 9, "too short for"}));

INSTANTIATE_TEST_SUITE_P(
    Data, PlyRefusals,
    testing::Values(
        Refusal{triangle("0 0 0\n1 0 0\n0 x 0\n3 0 1 2"), 14, 3, "'x' is not a number"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\n3 0 1 3"), 15, 7, "vertex index 3 is out of range: expected 0 to 2"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1"), 15, 7, "vertex index -1"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\n3 0 1 1e300"), 15, 7, "vertex index"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\n3 0 1 nan"), 15, 7, "vertex index"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\n-1 0 1 2"), 15, 1, "length of list"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\nnan 0 1 2"), 15, 1, "length of list"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\n2.5 0 1 2"), 15, 1, "length of list"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\n255 0 1 2"), 15, 1, "longer than the rest"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1 0\n4 0 1 2 "), 15, 9, "ends inside of element 'face', at number 1 of 1"},
        Refusal{triangle("0 0 0\n1 0 0\n0 1"), 5, 9, "too short"}));

TEST(Ply, BinaryErrorsHaveABytePosition) {
    std::string data = header("binary_little_endian", std::string(kVertex3) + std::string(kFace1));
    const size_t begin = data.size();
    for (int i = 0; i < 9; ++i) put<float>(data, 0, false);
    const std::string vertices = data;
    const auto expect_at = [&](const std::string& file, size_t byte, std::string_view message) {
        const auto result = read_ply(file);
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().where.byte, byte) << result.error().str();
        EXPECT_EQ(result.error().where.line, 0u);
        EXPECT_NE(result.error().message.find(message), std::string::npos) << result.error().str();
    };
    expect_at(vertices + '\xff', begin + 36, "longer than the rest");
    std::string bad = vertices + '\3';
    for (const int32_t v : {0, 1, 3}) put<int32_t>(bad, v, false);
    expect_at(bad, begin + 45, "index 3");
    // Truncation of fixed-size elements is known before reading: the line of the header says it.
    EXPECT_EQ(read_ply(vertices.substr(0, vertices.size() - 1)).error().where.line, 5u);
}

TEST(Ply, CountsThatLieAreKnownFromTheHeader) {
    for (const char* count : {"1000000000000", "18446744073709551615", "4294967295", "2147483648"})
        for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
            for (const char* element : {"vertex", "face", "other"})
                for (const char* property : {"float x\nproperty float y\nproperty float z",
                                             "list uchar int vertex_indices", "list double double vertex_indices"}) {
                    const std::string text =
                        header(format, (element == std::string("vertex") ? std::string() : std::string(kVertex3)) +
                                           "element " + element + " " + count + "\nproperty " + property + "\n") +
                        std::string(100, '\0');
                    const auto result = read_ply(text);
                    ASSERT_FALSE(result.ok());
                    // Known from the header, before anything is read: the place is that of the element's name.
                    EXPECT_GT(result.error().where.line, 2u) << result.error().str();
                }
}

TEST(Ply, HugeHeadersAreRefused) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 1\n";
    for (int i = 0; i < 5000; ++i) text.append("property float p").append(std::to_string(i)).append("\n");
    const auto result = read_ply(text + "end_header\n");
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::resources);
}

}  // namespace
}  // namespace steradian
