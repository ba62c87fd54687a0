// Damaged files: cut off at every byte, with bits turned over, and large on purpose. None may crash, hang or break what
// the readers promise; what is accepted is consistent, what is refused has a place.
#include <sys/resource.h>

#include "formats/obj/mtl.h"
#include "meshes/mesh_test.h"
#include "support/support.h"

namespace steradian {
namespace {

constexpr std::string_view kObj =
    "# sample\nmtllib a.mtl b\\ c.mtl\no thing\nv 0 0 0\nv 1.5e0 0 0 1\nv 1 1 .5 1 0 0\nv -0 1 0\nv 2 2 nan\nvt 0 "
    "0\nvt 1 0.5 0\nvt 1 1\nvn 0 0 1\nvn 0 1e-3 1\n"
    "usemtl red\ns 1\nf 1/1/1 2/2/1 3/3/2\nf 1//1 3//1 4//2\ns off\nusemtl blue \\\nnext\nf -5 -4 -3 -2\nf 1 2 3 4 "
    "5\ng x y\nusemtl red\nf 4 3 \\\r\n2 1\r\nl 1 2\np 1\ncurv 1 2\nzz\n";
constexpr std::string_view kMtl =
    "newmtl red\nKd 1 0 .5\nKs 0.5\nKe 1 1 1\nd 0.5\nTr .5\nNi 1.5\nillum 2\nTf 1 1 1\nmap_Kd -s 1 2 3 -o 0.5 -clamp "
    "on -type sphere a b.png\nnewmtl b \\\r\n c\nKd spectral x\nzz 1\n";
const std::string kAsciiPly =
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 5\nproperty float x\nproperty double y\nproperty int z\nproperty "
    "uchar red\nproperty float u\nproperty float v\n"
    "element face 3\nproperty list uchar int vertex_indices\nproperty list int float w\nelement tristrips 1\nproperty "
    "list int int vertex_indices\nend_header\n"
    "0 0 0 1 0 0\n1 0 0 1 0 1\n1 1 0 1 1 1\n0 1 0 2 0 1\n0.5 2 0 2 0 1\n5 0 1 2 4 3 0\n3 0 1 2 2 0.5 0.5\n2 0 1 0\n7 0 "
    "1 2 3 -1 0 1\n";

std::string binary_ply(bool big) {
    std::string out = std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
                      " 1.0\nelement vertex 4\nproperty uchar x\nproperty short y\nproperty char z\nelement face "
                      "2\nproperty list ushort uchar vertex_indices\nproperty int i\nend_header\n";
    for (const char c : {0, 1, 2, 3}) out += {c, 0, char(c * c), 0};
    for (const char n : {3, 4}) {
        if (big)
            out += {0, n};
        else
            out += {n, 0};
        for (char i = 0; i < n; ++i) out += i;
        out += std::string(4, '\0');
    }
    return out;
}

struct Sample {
    const char* name;
    std::string data;
};
std::vector<Sample> samples() {
    return {{"obj", std::string(kObj)},
            {"mtl", std::string(kMtl)},
            {"ascii.ply", kAsciiPly},
            {"little.ply", binary_ply(false)},
            {"big.ply", binary_ply(true)}};
}

/// Reads the sample as what its name says and checks what must hold in any case. Whether it was accepted.
bool read_any(std::string_view name, const std::string& data) {
    if (name == "mtl") {
        const auto library = parse_mtl(data, "t.mtl", "f", {});
        return library.ok();
    }
    const auto file = name == "obj" ? read_obj(data) : read_ply(data);
    if (file.ok()) {
        expect_consistent(*file);
        return true;
    }
    EXPECT_FALSE(file.error().message.empty());
    EXPECT_TRUE(file.error().where.line > 0 || file.error().where.byte.has_value());
    EXPECT_LT(file.error().str().size(), 4096u);
    return false;
}

TEST(Damage, TheSamplesAreWhole) {
    for (const Sample& sample : samples()) EXPECT_TRUE(read_any(sample.name, sample.data)) << sample.name;
}

TEST(Damage, CutOffAtEveryByte) {
    for (const Sample& sample : samples()) {
        size_t accepted = 0;
        for (size_t n = 0; n < sample.data.size(); ++n) {
            // An exact copy, so that a sanitizer sees a read past the end.
            accepted += read_any(sample.name, std::string(sample.data.substr(0, n)));
        }
        // A cut PLY lacks something, except where only white space or the end of a last list is gone.
        if (std::string_view(sample.name).find("ply") != std::string_view::npos) {
            EXPECT_LE(accepted, 3u) << sample.name;
        }
    }
}

TEST(Damage, BitsTurnedOver) {
    uint64_t state = 20240229;
    const auto random = [&state] { return (state = state * 6364136223846793005u + 1442695040888963407u) >> 33; };
    for (const Sample& sample : samples()) {
        size_t refused = 0;
        for (int i = 0; i < test::by_tier(10000, 200000); ++i) {
            std::string data = sample.data;
            for (uint64_t flips = 1 + random() % 3; flips > 0; --flips)
                data[random() % data.size()] ^= char(1 << random() % 8);
            refused += !read_any(sample.name, data);
        }
        EXPECT_EQ(refused > 0, std::string_view(sample.name) != "mtl") << sample.name;
    }
}

TEST(Damage, WordsReplacedByHostileOnes) {
    constexpr std::array<std::string_view, 22> kWords{"nan",
                                                      "-nan",
                                                      "inf",
                                                      "1e999",
                                                      "-1e999",
                                                      "1e-999",
                                                      "-0",
                                                      "0x1p3",
                                                      "1.2.3",
                                                      "255",
                                                      "-1",
                                                      "1000000000000",
                                                      "18446744073709551616",
                                                      "-9223372036854775808",
                                                      "",
                                                      "\\",
                                                      "\x1b[2J",
                                                      "\xff\xfe",
                                                      "2147483648",
                                                      "4294967295",
                                                      "1/1/1",
                                                      "//"};
    uint64_t state = 7;
    const auto random = [&state] { return (state = state * 6364136223846793005u + 1442695040888963407u) >> 33; };
    for (const Sample& sample : samples()) {
        for (int i = 0; i < test::by_tier(5000, 100000); ++i) {
            std::string data = sample.data;
            size_t begin = random() % data.size();
            while (begin > 0 && data[begin - 1] != ' ' && data[begin - 1] != '\n' && data[begin - 1] != '/') --begin;
            size_t end = data.find_first_of(" \n/", begin);
            if (end == std::string::npos) end = data.size();
            data.replace(begin, end - begin, kWords[random() % kWords.size()]);
            read_any(sample.name, data);
        }
    }
}

size_t peak_memory() {  // bytes
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

TEST(Damage, LargeAndHostileFilesAreBounded) {
    const auto repeat = [](std::string_view text, size_t count) {
        std::string out;
        for (size_t i = 0; i < count; ++i) out += text;
        return out;
    };
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    std::string polygon = "f";
    for (int i = 0; i < 100000; ++i) polygon.append(" ").append(std::to_string(1 + i % 3));
    const std::vector<std::string> files{
        repeat("\r", 2000000),
        repeat("\\\n", 1000000),
        repeat("#\\\r", 600000),
        "v " + std::string(4000000, '1') + " 0 0\n",
        "v 0." + std::string(4000000, '0') + "1 0 0\n",
        vertices + "f 1 2 " + std::string(4000000, '7') + "\n",
        vertices + polygon,
        vertices + repeat("g\nf 1 2 3\n", 100000),
        vertices + repeat("s 1\nf 1 2 3\ns 2\nf 1 2 3\n", 50000),
        repeat("mtllib a b c\n", 100000),
        "mtllib " + repeat("a ", 1000000),
        vertices + repeat("vn nan inf 0\n", 1000) + repeat("f 1//1000 2//999 3//1\n", 50000),
    };
    const size_t before = peak_memory();
    for (const std::string& text : files) {
        const auto result = read_obj(text);
        if (result.ok()) expect_consistent(*result);
    }
    EXPECT_LT(peak_memory() - before, size_t(512) << 20);
}

}  // namespace
}  // namespace steradian
