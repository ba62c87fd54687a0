// What glTF files that want to take memory or time are allowed: at most 512 MiB and 2 s of processor time, one line
// that names the file and the place, and no output.
#include <gtest/gtest.h>

#include "gltf/gltf_builder.h"
#include "image/samples.h"
#include "program.h"

namespace steradian::test {
namespace {

class HostileModels : public CommandTest {
protected:
    /// `text` must be in the first line of the error, or in what is said of the file where it is `accepted`; codes 3
    /// and 4 are refusals.
    void expect_cheap(const std::string& bytes, const std::string& text, bool accepted = false,
                      const std::vector<std::string>& arguments = {"info", "model.glb"}) {
        SCOPED_TRACE(text);
        spit(folder_.file("model.glb"), bytes);
        const Outcome o = steradian(arguments);
        const std::string line = o.err.substr(0, o.err.find('\n'));
        EXPECT_EQ(o.code == 3 || o.code == 4, !accepted) << o.code << o.err;
        EXPECT_EQ(line.starts_with("model.glb") && line.find(": error: ") != std::string::npos, !accepted) << line;
        EXPECT_NE((accepted ? o.out : line).find(text), std::string::npos) << line;
        expect_bounds(o);
        if (arguments[0] != "info") return;
        // Whoever looks for mistakes in it is told the same, or gets a list.
        std::vector<std::string> looking = arguments;
        looking[0] = "lint";
        const Outcome found = steradian(looking);
        EXPECT_EQ(found.code, o.code) << found.err;
        EXPECT_TRUE(accepted || found.err == o.err) << found.err;
        expect_bounds(found);
    }
    static void expect_bounds(const Outcome& o) {
        EXPECT_EQ(o.signal, 0);
        if (kSanitized) return;
        EXPECT_LE(o.peak_bytes, uint64_t(512) << 20);
        EXPECT_LE(o.cpu_seconds, 2.0);
    }

    /// A triangle with a material for each of these images.
    static std::string with_images(const std::vector<std::string>& pictures, size_t copies = 1) {
        GltfBuilder b;
        const int p = b.floats("VEC3", 3, kTriangle);
        std::string images, textures, materials, primitives;
        size_t n = 0;
        for (const std::string& picture : pictures) {
            const int view = b.view(picture);
            for (size_t i = 0; i < copies; ++i, ++n) {
                const std::string comma = n ? "," : "", number = std::to_string(n);
                images += comma + "{\"bufferView\": " + std::to_string(view) + "}";
                textures += comma + "{\"source\": " + number + "}";
                materials += comma + "{\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": " + number + "}}}";
                primitives +=
                    comma + "{\"attributes\": {\"POSITION\": " + std::to_string(p) + "}, \"material\": " + number + "}";
            }
        }
        return b.binary("\"images\": [" + images + "], \"textures\": [" + textures + "], \"materials\": [" + materials +
                        "], \"meshes\": [{\"primitives\": [" + primitives + "]}], \"nodes\": [{\"mesh\": 0}]");
    }
};

TEST_F(HostileModels, PicturesThatClaimMoreThanTheyHave) {
    const std::string rows(60'000'000, '\0');
    expect_cheap(with_images({png_file(65535, 65535, 16, 6, rows)}), "(/images/0)");
    expect_cheap(with_images({png_file(16384, 8192, 16, 6, rows)}), "(/images/0)");
    const std::string jpeg = jpeg_file(16, 16, 1, false, std::vector<unsigned char>(256, 7));
    std::string large = jpeg;
    large.replace(large.find("\xff\xc0") + 5, 4, "\xff\xdc\xff\xdc");
    expect_cheap(with_images({large}), "(/images/0)");
}

TEST_F(HostileModels, ManyPicturesOfOneColour) {
    // Each is honest: 7000 × 8000 grey texels in 55 kB. The view is the same for all of them.
    const std::string picture = png_file(7000, 8000, 8, 0, std::string(size_t(7001) * 8000, '\0'));
    ASSERT_LT(picture.size(), 60'000u);
    expect_cheap(with_images({picture}, 1000), "MiB");
    const std::vector<std::string> smaller(
        30, png_file(4000, 1000, 8, 2, std::string((size_t(4000) * 3 + 1) * 1000, '\0')));
    expect_cheap(with_images(smaller), "MiB");
    const Outcome more =
        steradian({"render", "model.glb", "--gltf-memory", "1024", "--spp", "1", "--size", "8x8", "-q", "-o", "a.png"});
    EXPECT_EQ(more.code, 0) << more.err;
}

TEST_F(HostileModels, ThingsThatAreNotThere) {
    const std::string vec3 = "\"componentType\": 5126, \"type\": \"VEC3\", \"count\": ";
    const auto zeros = [&](const std::string& count, const std::string& more = {}) {
        GltfBuilder b;
        return b.binary(one_mesh(b.raw_accessor(vec3 + count)) + more);
    };
    expect_cheap(zeros("4294967295"), "(/meshes/0/primitives/0)");
    expect_cheap(zeros("45000000") + std::string(3'000'000, ' '), "(/accessors/0)");  // padding is no credit
    expect_cheap(zeros("18000000"), "", true);  // 288 MB: the most that is allowed is cheap enough
    std::string buffer =
        "\"buffers\": [{\"byteLength\": 9007199254740992}], \"bufferViews\": [{\"buffer\": 0, "
        "\"byteLength\": 9007199254740992}], \"accessors\": [{\"bufferView\": 0, ";
    expect_cheap("{\"asset\": {\"version\": \"2.0\"}, " + buffer + vec3 + "3}], " + one_mesh(0) + "}", "(/buffers/0)");
    std::string claims = zeros("3");
    const uint32_t most = 0xffffffffu;
    std::memcpy(claims.data() + 8, &most, 4);
    expect_cheap(claims, "byte 8");
}

TEST_F(HostileModels, OneThingUsedOverAndOver) {
    // 3 million zeros a primitive, 10 000 primitives of different accessors.
    std::string accessors, primitives;
    for (int i = 0; i < 10'000; ++i) {
        const std::string comma = i ? "," : "";
        accessors += comma + "{\"componentType\": 5126, \"type\": \"VEC3\", \"count\": 3000000}";
        primitives += comma + "{\"attributes\": {\"POSITION\": " + std::to_string(i) + "}}";
    }
    expect_cheap("{\"asset\": {\"version\": \"2.0\"}, \"accessors\": [" + accessors +
                     "], \"meshes\": [{\"primitives\": [" + primitives + "]}], \"nodes\": [{\"mesh\": 0}]}",
                 "(/accessors/");
    // 30 levels of nodes that each name the next one twice would be 2^30 instances.
    GltfBuilder b;
    std::string nodes;
    const int p = b.floats("VEC3", 3, kTriangle);
    for (int i = 0; i < 30; ++i)
        nodes += "{\"children\": [" + std::to_string(i + 1) + "," + std::to_string(i + 1) + "]},";
    expect_cheap(b.binary("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(p) +
                          "}}]}], \"nodes\": [" + nodes + "{\"mesh\": 0}], \"scenes\": [{\"nodes\": [0]}]"),
                 "(/nodes/0/children/1)");
    // Instances by the billion, of accessors without data.
    GltfBuilder c;
    const int triangle = c.floats("VEC3", 3, kTriangle),
              t = c.raw_accessor("\"componentType\": 5126, \"type\": \"VEC3\", \"count\": 4000000000");
    expect_cheap(c.binary("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(triangle) +
                          "}}]}], \"nodes\": [{\"mesh\": 0, \"extensions\": {\"EXT_mesh_gpu_instancing\": "
                          "{\"attributes\": {\"TRANSLATION\": " +
                          std::to_string(t) + "}}}}]"),
                 "(/nodes/0/extensions/EXT_mesh_gpu_instancing)");
}

TEST_F(HostileModels, MorphTargetsAndSkinsByTheThousand) {
    // 20 000 targets that all name the same 50 000 differences.
    GltfBuilder b;
    const std::vector<float> many(150'000, 0.5f);
    const std::string p = std::to_string(b.floats("VEC3", 3, many));
    std::string targets, weights;
    for (int i = 0; i < 20'000; ++i) {
        targets += (i ? "," : "") + ("{\"POSITION\": " + p + "}");
        weights += i ? ",1" : "1";
    }
    expect_cheap(
        b.binary("\"meshes\": [{\"weights\": [" + weights + "], \"primitives\": [{\"attributes\": {\"POSITION\": " + p +
                 "}, \"targets\": [" + targets + "]}]}], \"nodes\": [{\"mesh\": 0}]"),
        "(/meshes/0/primitives/0/targets/");
    // The same mesh on 10 000 nodes with a skin each.
    GltfBuilder c;
    const std::string q = std::to_string(c.floats("VEC3", 3, many)), zeros = "\"type\": \"VEC4\", \"count\": 50000, ";
    const std::string joints = std::to_string(c.raw_accessor(zeros + "\"componentType\": 5121"));
    const std::string parts = std::to_string(c.raw_accessor(zeros + "\"componentType\": 5126"));
    std::string nodes, skins;
    for (int i = 0; i < 10'000; ++i) {
        nodes += ",{\"mesh\": 0, \"skin\": " + std::to_string(i) + "}";
        skins += std::string(i ? "," : "") + "{\"joints\": [0]}";
    }
    expect_cheap(
        c.binary("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + q + ", \"JOINTS_0\": " + joints +
                 ", \"WEIGHTS_0\": " + parts + "}}]}], \"nodes\": [{}" + nodes + "], \"skins\": [" + skins + "]"),
        "(/");
}

TEST_F(HostileModels, KeyframesByTheBillion) {
    GltfBuilder b;
    const std::string p = std::to_string(b.floats("VEC3", 3, kTriangle));
    const std::string t =
        std::to_string(b.raw_accessor("\"componentType\": 5126, \"type\": \"SCALAR\", \"count\": 4000000000"));
    const std::string file = b.binary(
        "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + p +
        "}}]}], \"nodes\": [{\"mesh\": 0}], \"animations\": [{\"samplers\": [{\"input\": " + t + ", \"output\": " + t +
        "}], \"channels\": [{\"sampler\": 0, \"target\": {\"node\": 0, \"path\": "
        "\"weights\"}}]}]");
    expect_cheap(file, "(/accessors/1)", false,
                 {"replay", "model.glb", "--pixel", "0,0", "--sample", "0", "--frame-time", "1"});
    expect_cheap(file, "", true);
}

TEST_F(HostileModels, Nesting) {
    const std::string start = "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{}], \"extras\": ";
    expect_cheap(start + std::string(1'000'000, '['), "deeper than the limit");
    expect_cheap(start + std::string(200, '[') + std::string(200, ']') + "}", "nothing to render", true);
}

TEST_F(HostileModels, OneFileNamedManyTimesIsReadOnce) {
    // 20 MB, by a thousand buffers and images.
    std::string buffers, views, accessors, primitives;
    for (int i = 0; i < 1000; ++i) {
        const std::string comma = i ? "," : "", number = std::to_string(i);
        buffers += comma + "{\"byteLength\": 36, \"uri\": \"./large.bin\"}";
        views += comma + "{\"buffer\": " + number + ", \"byteLength\": 36}";
        accessors +=
            comma + "{\"bufferView\": " + number + ", \"componentType\": 5126, \"type\": \"VEC3\", \"count\": 3}";
        primitives += comma + "{\"attributes\": {\"POSITION\": " + number + "}}";
    }
    spit(folder_.file("large.bin"), std::string(20'000'000, '\0'));
    expect_cheap("{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [" + buffers + "], \"bufferViews\": [" + views +
                     "], \"accessors\": [" + accessors + "], \"meshes\": [{\"primitives\": [" + primitives +
                     "]}], \"nodes\": [{\"mesh\": 0}]}",
                 "", true);
}

TEST_F(HostileModels, NothingIsWrittenForWhatIsRefused) {
    spit(folder_.file("model.gltf"), "{\"asset\": {\"version\": \"1.0\"}}");
    spit(folder_.file("a.png"), "what was there before");
    const Outcome o = steradian({"render", "model.gltf", "-o", "a.png", "-o", "b.exr"});
    EXPECT_EQ(o.code, 3);
    EXPECT_NE(o.err.find("model.gltf:1:23 (/asset/version)"), std::string::npos) << o.err;
    EXPECT_EQ(slurp(folder_.file("a.png")), "what was there before");
    expect_files({"model.gltf", "a.png"});
}

}  // namespace
}  // namespace steradian::test
