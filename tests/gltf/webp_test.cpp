// EXT_texture_webp, and what is said of KTX2.
#include <webp/decode.h>

#include "gltf_builder.h"
#include "image/decode.h"
#include "image/samples.h"

namespace steradian {
namespace {

using namespace test;

std::vector<unsigned char> pixels(size_t count) {
    std::vector<unsigned char> out(count);
    for (size_t i = 0; i < count; ++i) out[i] = static_cast<unsigned char>(i * 53 + i / 7);
    return out;
}

/// A triangle whose base colour is this texture, with these images.
std::string textured(const std::vector<std::string>& images, const std::string& texture) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    std::string list;
    for (const std::string& image : images)
        list += (list.empty() ? "" : ",") + ("{\"bufferView\": " + std::to_string(b.view(image)) + "}");
    return b.binary("\"images\": [" + list + "], \"textures\": [{" + texture +
                    "}], \"materials\": [{\"alphaMode\": \"BLEND\", \"pbrMetallicRoughness\": {\"baseColorTexture\": "
                    "{\"index\": 0}}}], " +
                    one_mesh(p, ", \"material\": 0"));
}
std::string webp_texture(int source) {
    return "\"extensions\": {\"EXT_texture_webp\": {\"source\": " + std::to_string(source) + "}}";
}

TEST(GltfWebp, ColourAndAlphaAreThoseOfTheFile) {
    const auto colors = pixels(7 * 5 * 4);
    const LoadedScene loaded = good_gltf(textured({webp_file(7, 5, 4, true, colors)}, webp_texture(0)));
    EXPECT_TRUE(loaded.fidelity.empty());
    ASSERT_EQ(loaded.scene.images.size(), 2u);  // colour, and opacity
    for (const RawImage& image : loaded.scene.images) {
        ASSERT_EQ(image.width, 7u);
        ASSERT_EQ(image.height, 5u);
        for (size_t i = 0; i < 35; ++i)
            for (size_t c = 0; c < image.channels; ++c)
                EXPECT_EQ(std::to_integer<unsigned>(image.data[i * image.channels + c]),
                          colors[4 * i + (image.channels == 1 ? 3 : c)]);
    }
}

TEST(GltfWebp, GoesBeforeTheImageForOthers) {
    const std::string png = png_file(1, 1, 8, 0, std::string(2, '\0')), webp = webp_file(3, 3, 3, true, pixels(27));
    EXPECT_EQ(good_gltf(textured({png, webp}, "\"source\": 0, " + webp_texture(1))).scene.images.at(0).width, 3u);
}

TEST(GltfWebp, WithLossAsTheLibraryDecodesIt) {
    const std::string file = webp_file(33, 17, 3, false, pixels(33 * 17 * 3));
    const auto raw = decode_texels(file, "a.webp", {});
    ASSERT_TRUE(raw.ok()) << raw.error().str();
    int width = 0, height = 0;
    uint8_t* expected = WebPDecodeRGB(reinterpret_cast<const uint8_t*>(file.data()), file.size(), &width, &height);
    ASSERT_EQ(raw->data.size(), 33u * 17 * 3);
    EXPECT_EQ(std::memcmp(raw->data.data(), expected, raw->data.size()), 0);
    WebPFree(expected);
}

TEST(GltfWebp, CutOffFilesAndLiesAreRefused) {
    for (const bool lossless : {true, false}) {
        const std::string file = webp_file(16, 16, 4, lossless, pixels(16 * 16 * 4));
        for (size_t size = 0; size < file.size(); ++size)
            EXPECT_FALSE(decode_texels(file.substr(0, size), "a.webp", {}).ok()) << size << " of " << file.size();
    }
    // 16383 × 16383 in a lossless header, which has 14 bits for each.
    std::string bomb = webp_file(16, 16, 3, true, pixels(16 * 16 * 3));
    const size_t at = bomb.find("VP8L") + 8 + 1;
    const uint32_t bits = 0x0fffffffu;
    std::memcpy(bomb.data() + at, &bits, 4);
    EXPECT_EQ(decode_texels(bomb, "a.webp", {}).error().code, ErrorCode::resources);
    expect_refused(textured({std::string("RIFF\0\0\0\0WEBP", 12)}, webp_texture(0)), "/images/0", "header is damaged");
}

TEST(GltfWebp, Ktx2SaysWhatToDo) {
    const std::string ktx = "\"extensions\": {\"KHR_texture_basisu\": {\"source\": 0}}";
    const auto loaded = load_gltf(textured({"\xabKTX 20\xbb\r\n\x1a\n"}, ktx));
    ASSERT_FALSE(loaded.ok());
    EXPECT_EQ(loaded.error().where.pointer, "/textures/0");
    EXPECT_NE(loaded.error().message.find("KTX2"), std::string::npos);
    EXPECT_NE(loaded.error().hint.find("ktxdecompress"), std::string::npos);
    // With another image beside it, that one is used and the rest is reported.
    const LoadedScene other =
        good_gltf(textured({png_file(1, 1, 8, 0, std::string(2, '\0'))}, "\"source\": 0, " + ktx));
    EXPECT_TRUE(has(other.fidelity, "KHR_texture_basisu"));
    expect_refused("{\"asset\": {\"version\": \"2.0\"}, \"extensionsRequired\": [\"KHR_texture_basisu\"]}",
                   "/extensionsRequired/0", "KHR_texture_basisu");
}

}  // namespace
}  // namespace steradian
