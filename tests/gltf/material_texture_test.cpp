// Textures of the extensions of materials: where the texel is 0 or 1, a surface has the bits of one without the
// texture.
#include "shading/spectrum.h"
#include "shading/thin_film.h"
#include "wall.h"

namespace steradian {
namespace {

using namespace test;

struct TexturedFactor {
    std::string base, extension;
    std::string textured, left, right;  ///< members of the extension
};

void expect_halves(const TexturedFactor& f) {
    SCOPED_TRACE(f.extension + " " + f.textured);
    const auto with = [&](const std::string& members) {
        return picture("\"pbrMetallicRoughness\": {\"baseColorFactor\": [0.8, 0.6, 0.4, 1], " + f.base +
                       "}, \"extensions\": {\"" + f.extension + "\": {" + members + "}}");
    };
    const std::vector<Rgb> textured = with(f.textured), left = with(f.left), right = with(f.right);
    size_t same = 0, different = 0;
    for (size_t i = 0; i < textured.size(); ++i) {
        same += textured[i] == (i % kWidth < kWidth / 2 ? left[i] : right[i]);
        different += left[i] != right[i];
    }
    EXPECT_EQ(same, textured.size());
    EXPECT_EQ(different, textured.size());
}

constexpr const char* kMatte = "\"metallicFactor\": 0, \"roughnessFactor\": 0.4";
constexpr const char* kRough = "\"metallicFactor\": 0, \"roughnessFactor\": 1";

/// Values of a factor, with more members of the extension: of the textured surface, and of the two halves.
TexturedFactor textured(const std::string& extension, const std::string& factor, const std::string& texture,
                        const std::string& left, const std::string& right, int number, const std::string& more) {
    const auto at = [&](const std::string& value) { return "\"" + factor + "\": " + value + more; };
    return {kMatte, extension, at(right) + ", \"" + texture + "\": {\"index\": " + std::to_string(number) + "}",
            at(left), at(right)};
}
TexturedFactor weight(const std::string& extension, const std::string& factor, const std::string& texture,
                      const std::string& more = {}) {
    return textured(extension, factor, texture, "0", "0.7", 0, more);
}
/// Their tables are over all roughnesses, and exact at both ends.
TexturedFactor roughness(const std::string& extension, const std::string& factor, const std::string& texture,
                         const std::string& more) {
    TexturedFactor out = textured(extension, factor, texture, "0", "1", 0, more);
    out.base = kRough;
    return out;
}
TexturedFactor color(const std::string& extension, const std::string& factor, const std::string& texture,
                     const std::string& more = {}) {
    return textured(extension, factor, texture, "[1, 0, 0]", "[1, 1, 1]", 1, more);
}

TEST(GltfExtensionTextures, Weights) {
    TexturedFactor specular = weight("KHR_materials_specular", "specularFactor", "specularTexture");
    expect_halves(specular);
    specular.base = "\"metallicFactor\": 0.5, \"roughnessFactor\": 0.4";
    expect_halves(specular);
    expect_halves(weight("KHR_materials_clearcoat", "clearcoatFactor", "clearcoatTexture",
                         ", \"clearcoatRoughnessFactor\": 0.2"));
    expect_halves(weight("KHR_materials_transmission", "transmissionFactor", "transmissionTexture"));
    expect_halves(weight("KHR_materials_iridescence", "iridescenceFactor", "iridescenceTexture"));
    expect_halves(weight("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor",
                         "diffuseTransmissionTexture", ", \"diffuseTransmissionColorFactor\": [0.2, 0.9, 0.1]"));
}

TEST(GltfExtensionTextures, Roughnesses) {
    expect_halves(roughness("KHR_materials_clearcoat", "clearcoatRoughnessFactor", "clearcoatRoughnessTexture",
                            ", \"clearcoatFactor\": 0.8"));
    expect_halves(roughness("KHR_materials_sheen", "sheenRoughnessFactor", "sheenRoughnessTexture",
                            ", \"sheenColorFactor\": [0.5, 0.7, 0.9]"));
}

TEST(GltfExtensionTextures, Colours) {
    expect_halves(color("KHR_materials_specular", "specularColorFactor", "specularColorTexture"));
    expect_halves(
        color("KHR_materials_sheen", "sheenColorFactor", "sheenColorTexture", ", \"sheenRoughnessFactor\": 0.5"));
    expect_halves(color("KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor",
                        "diffuseTransmissionColorTexture", ", \"diffuseTransmissionFactor\": 0.7"));
}

/// Each plane of the picture is read where the extension says so.
TEST(GltfExtensionTextures, Channels) {
    const LoadedScene loaded = wall(
        "\"extensions\": {\"KHR_materials_clearcoat\": {\"clearcoatFactor\": 1, \"clearcoatTexture\": {\"index\": 1}, "
        "\"clearcoatRoughnessFactor\": 1, \"clearcoatRoughnessTexture\": {\"index\": 1}}, \"KHR_materials_sheen\": "
        "{\"sheenColorFactor\": [1, 1, 1], \"sheenRoughnessTexture\": {\"index\": 1}}}");
    const Scene& scene = loaded.scene;
    const auto& mix = std::get<MixMaterial>(scene.materials[index(scene.instances.at(0).material)]);
    const auto& with = std::get<OpenPbrMaterial>(scene.materials[index(mix.second)]);
    EXPECT_EQ(std::get<OpenPbrMaterial>(scene.materials[index(mix.first)]).coat_weight, 0);
    EXPECT_EQ(with.coat_weight, 1);
    const auto image_of = [&](TextureId id) {
        const auto& texture = std::get<ImageTexture>(scene.textures[index(id)]);
        EXPECT_EQ(texture.color_space, ColorSpace::linear);
        return scene.images[index(texture.image)].data;
    };
    const auto bytes = [](int a, int b) { return std::vector{std::byte(a), std::byte(b)}; };
    EXPECT_EQ(image_of(*mix.weight.texture), bytes(255, 255));         // red
    EXPECT_EQ(image_of(*with.coat_roughness.texture), bytes(0, 255));  // green
    // A picture without alpha is opaque.
    const auto& squared = std::get<ProductTexture>(scene.textures[index(*with.fuzz_roughness.texture)]);
    EXPECT_EQ(squared.first, squared.second);
    EXPECT_EQ(image_of(squared.first), std::vector{std::byte(255)});
}

TEST(GltfExtensionTextures, Films) {
    const std::string film = "\"iridescenceFactor\": 0.9, \"iridescenceIor\": 1.7, ";
    TexturedFactor thickness;
    thickness.extension = "KHR_materials_iridescence";
    const auto at = [&](const std::string& nanometres) {
        return film + "\"iridescenceThicknessMaximum\": " + nanometres;
    };
    const std::string texture = ", \"iridescenceThicknessTexture\": {\"index\": 0}";
    for (const std::string base : {kMatte, "\"metallicFactor\": 1, \"roughnessFactor\": 0.3"}) {
        thickness.base = base;
        thickness.textured = at("550") + ", \"iridescenceThicknessMinimum\": 230" + texture;
        thickness.left = at("230"), thickness.right = at("550");
        expect_halves(thickness);
        thickness.textured = at("230") + ", \"iridescenceThicknessMinimum\": 550" + texture;  // turned around
        std::swap(thickness.left, thickness.right);
        expect_halves(thickness);
        thickness.textured = film + texture.substr(2);
        thickness.left = at("100"), thickness.right = film + "\"iridescenceThicknessMaximum\": 400";
        expect_halves(thickness);
    }
}

/// What a film on black glass or on a metal reflects at a right angle: Airy's sum, over the spectrum.
Rgb film_on(const FilmIndices (&n)[3], double thickness) {
    Vec3d sum, white;
    for (int nm = 380; nm < 730; ++nm) {
        const double wavelength = (nm + 0.5) / 1000;
        const Vec3d w = rgb_response(wavelength);
        const auto r = [&](int c) { return film_reflectance(1, n[c], thickness, wavelength); };
        sum = sum + Vec3d{w.x * r(0), w.y * r(1), w.z * r(2)}, white = white + w;
    }
    return {static_cast<float>(sum.x / white.x), static_cast<float>(sum.y / white.y),
            static_cast<float>(sum.z / white.z)};
}

/// From texel to pixel: the green of a texel to a thickness, and red to a weight.
TEST(GltfExtensionTextures, FilmsReflectByAirysFormula) {
    const double minimum = 0.12, maximum = 0.62, film = 1.6;
    const std::vector<int> texels{255, 0, 9, 255, 128, 77, 200, 255, 0, 151, 0, 255, 60, 255, 99, 255};
    const auto material = [&](const std::string& base, const std::string& more) {
        return "\"pbrMetallicRoughness\": {" + base +
               ", \"roughnessFactor\": 0}, \"extensions\": {\"KHR_materials_iridescence\": {\"iridescenceIor\": 1.6, "
               "\"iridescenceThicknessMinimum\": 120, \"iridescenceThicknessMaximum\": 620, "
               "\"iridescenceThicknessTexture\": {\"index\": 0}" +
               more + "}}";
    };
    const std::string black = "\"baseColorFactor\": [0, 0, 0, 1], \"metallicFactor\": 0",
                      copper = "\"baseColorFactor\": [0.9375, 0.625, 0.53125, 1]";
    const FilmIndices glass{1, film, 1.5, 0};
    const auto metal = [&](double normal) {  // of colours that the tables have
        const MetalIndex i = metal_index_of(normal, normal + (1 - normal) * std::pow(6 / 7.0, 5));
        return FilmIndices{1, film, i.n, i.k};
    };
    const FilmIndices on_glass[] = {glass, glass, glass}, on_copper[] = {metal(0.9375), metal(0.625), metal(0.53125)};
    const Rgb bare_glass{0.04f, 0.04f, 0.04f}, bare_copper{0.9375f, 0.625f, 0.53125f};
    for (const bool is_metal : {false, true})
        for (const bool weight : {false, true}) {
            const std::string more = weight ? ", \"iridescenceFactor\": 0.8, \"iridescenceTexture\": {\"index\": 0}"
                                            : ", \"iridescenceFactor\": 1";
            const Scene scene = wall(material(is_metal ? copper : black, more), texture_of(texels)).scene;
            for (uint32_t texel = 0; texel < 4; ++texel) {
                const Mean seen = under_a_white_sky(scene, texel * kWidth / 4, (texel + 1) * kWidth / 4);
                const double green = texels[texel * 4 + 1] / 255.0, red = texels[texel * 4] / 255.0;
                const auto w = static_cast<float>(weight ? 0.8 * red : 1);
                const Rgb covered = film_on(is_metal ? on_copper : on_glass, minimum + green * (maximum - minimum));
                const Rgb expected = (is_metal ? bare_copper : bare_glass) * (1 - w) + covered * w;
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(seen.color[c], expected[c], 5 * seen.error + (is_metal ? 3e-3 : 1e-3))
                        << is_metal << weight << " texel " << texel << " channel " << c;
            }
        }
}

TEST(GltfExtensionTextures, TwoWeightsAtMost) {
    GltfBuilder b;
    const int p = b.floats("VEC3", 3, kTriangle);
    const std::string weight = "\"index\": 0}}";
    const LoadedScene loaded = good_gltf(
        b.text(one_mesh(p, ", \"material\": 0") +
               ", \"materials\": [{\"normalTexture\": {\"index\": 1}, \"extensions\": {\"KHR_materials_specular\": "
               "{\"specularTexture\": {" +
               weight + ", \"KHR_materials_clearcoat\": {\"clearcoatFactor\": 1, \"clearcoatTexture\": {" + weight +
               ", \"KHR_materials_iridescence\": {\"iridescenceFactor\": 1, \"iridescenceTexture\": {" + weight +
               "}}], " + kTextures));
    EXPECT_TRUE(loaded.fidelity.empty());
    EXPECT_EQ(loaded.scene.materials.size(), 7u);  // four and the mixes
    ASSERT_EQ(loaded.scene.reliefs.size(), 4u);    // each has its own
    for (const Relief& r : loaded.scene.reliefs)
        EXPECT_TRUE(std::holds_alternative<OpenPbrMaterial>(loaded.scene.materials[index(r.material)]));
}

/// Fresnel's reflectance at this cosine, of an index of 1.5.
double fresnel(double mu) {
    const double n = 1.5, inside = std::sqrt(1 - (1 - mu * mu) / (n * n));
    const double s = (mu - n * inside) / (mu + n * inside), p = (n * mu - inside) / (n * mu + inside);
    return (s * s + p * p) / 2;
}

/// A polished coat on black, seen at a right angle below a white sky: it reflects by the angle of its own normal, which
/// without a map is that of the surface, whatever the base's map says.
TEST(GltfExtensionTextures, NormalsOfTheCoat) {
    const std::string black =
        "\"pbrMetallicRoughness\": {\"baseColorFactor\": [0, 0, 0, 1], \"roughnessFactor\": 0}, \"extensions\": "
        "{\"KHR_materials_clearcoat\": {\"clearcoatFactor\": 1";
    const std::string mapped = ", \"clearcoatNormalTexture\": {\"index\": 0}",
                      base = ", \"normalTexture\": {\"index\": 0}";
    const std::vector<int> tilted{247, 128, 171, 255};
    const double x = 247 / 127.5 - 1, y = 128 / 127.5 - 1, z = 171 / 127.5 - 1;
    const double mu = z / std::sqrt(x * x + y * y + z * z);
    const auto seen = [&](const std::string& material) {
        return under_a_white_sky(wall(material, texture_of(tilted)).scene, 0, kWidth);
    };
    const auto expect = [](const Mean& mean, double value) {
        EXPECT_LT(mean.error, 1e-3);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean.color[c], value, 5 * mean.error + 1e-3);
    };
    expect(seen(black + mapped + "}}"), fresnel(mu));
    EXPECT_GT(fresnel(mu), 0.16);
    expect(seen(black + "}}"), 0.04);
    // Black metal about a turned normal reflects by Schlick's formula, below what the flat coat lets pass.
    const double below = std::pow(1 - mu, 5);
    expect(seen(black + "}}" + base), 0.04 + 0.96 * below);
}

TEST(GltfExtensionTextures, DirectionsOfTheGrain) {
    const auto material = [](const std::string& members) {
        return "\"pbrMetallicRoughness\": {\"roughnessFactor\": 0.3}, \"extensions\": {\"KHR_materials_anisotropy\": "
               "{\"anisotropyStrength\": 0.6" +
               members + "}}";
    };
    // Up in the image, with two thirds of the strength.
    const std::string map = ", \"anisotropyTexture\": {\"index\": 0}";
    const std::vector<int> up{128, 255, 170, 255};
    const auto picture_of = [&](const std::string& text) {
        Scene scene = wall(text, texture_of(up)).scene;
        RenderSettings settings;
        settings.width = kWidth, settings.height = kHeight, settings.samples_per_pixel = 256;
        return run(prepared(std::move(scene)), settings).image.pixels;
    };
    const auto difference = [](const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0, all = 0;
        for (size_t i = 0; i < a.size(); ++i) sum += std::fabs(double(a[i]) - double(b[i])), all += double(a[i]);
        return sum / all;
    };
    std::string weaker = material(", \"anisotropyRotation\": 1.570796");
    weaker.replace(weaker.find("0.6"), 3, "0.4");
    const auto by_texture = picture_of(material(map)), by_factor = picture_of(weaker);
    EXPECT_LT(difference(by_factor, by_texture), 0.04);
    std::string straight = material("");
    straight.replace(straight.find("0.6"), 3, "0.4");
    EXPECT_GT(difference(by_factor, picture_of(straight)), 0.1);
    // Both turns together are half a turn, which is none.
    EXPECT_LT(difference(picture_of(straight), picture_of(material(map + ", \"anisotropyRotation\": 1.570796"))), 0.04);
}

}  // namespace
}  // namespace steradian
