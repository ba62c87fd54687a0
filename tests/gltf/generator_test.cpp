// The models of the glTF Asset Generator beside the pictures that come with them. Those were made by a rasteriser in a
// photographed hall, so what is compared is what light does not decide: which pixels a model covers, and its colours up
// to one exposure for each channel. docs/gltf.md tells how.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "formats/gltf/object.h"
#include "gltf_builder.h"
#include "render/render_support.h"
#include "steradian/image_io.h"
#include "support/support.h"

namespace steradian {
namespace {

using namespace test;

constexpr uint32_t kSide = 72;  ///< of the thumbnails
constexpr size_t kPixels = size_t(kSide) * kSide;
using Picture = std::vector<Rgb>;  ///< linear

struct Model {
    std::string group, name;
    Vec3 camera;
    std::filesystem::path file, reference;
    bool lines = false;        ///< or points: not drawn, but reported
    Picture ours;              ///< on black
    std::vector<float> alpha;  ///< the share of each pixel that ours covers
    Picture theirs;            ///< on the hall; empty where the reference is a film
};

double code_of(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}
double linear_of(double code) {
    const double c = std::clamp(code, 0.0, 1.0);
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
/// Of what a screen shows, 0 … 1.
double difference(Rgb a, Rgb b) {
    double sum = 0;
    for (int c = 0; c < 3; ++c)
        sum += std::abs(code_of(static_cast<double>(a[c])) - code_of(static_cast<double>(b[c])));
    return sum / 3;
}

/// What every manifest of the suite lists.
std::vector<Model> models_in(const std::filesystem::path& suite) {
    std::vector<Model> out;
    for (const auto& entry : std::filesystem::directory_iterator(suite)) {
        if (!std::filesystem::exists(entry.path() / "Manifest.json")) continue;
        const std::string text = slurp(entry.path() / "Manifest.json");
        const auto document = json::Document::parse(text, "manifest", 64);
        if (!document) throw std::runtime_error(document.error().str());
        const json::Source source(document->text(), "manifest");
        for (const json::Value value : gltf::Object(source, document->root(), "a manifest").array("models")) {
            const gltf::Object model(source, value, "a model");
            const auto at = model.object("camera")->numbers("translation", 3, {-1e3, 1e3});
            const std::string file(model.string_or("fileName", ""));
            const std::filesystem::path picture = std::string(model.string_or("sampleImageName", ""));
            Model& m = out.emplace_back();
            m.group = entry.path().filename().string();
            m.name = file.substr(0, file.find('.'));
            for (int c = 0; c < 3; ++c) m.camera[c] = static_cast<float>((*at)[static_cast<size_t>(c)]);
            m.file = entry.path() / file;
            m.reference = entry.path() / "Figures/Thumbnails" / picture.filename();
        }
    }
    std::sort(out.begin(), out.end(), [](const Model& a, const Model& b) { return a.name < b.name; });
    return out;
}

/// A sky that is brighter above, as the hall of the references is, so that relief shows.
void light(Scene& scene) {
    constexpr uint32_t kRows = 32;
    RawImage sky{1, kRows, 1, TexelFormat::f32, std::vector<std::byte>(kRows * sizeof(float))};
    for (uint32_t y = 0; y < kRows; ++y) {
        const double up = std::cos(std::numbers::pi * (y + 0.5) / kRows);
        const auto radiance = static_cast<float>(0.1 + (1 + up) * (1 + up));
        std::memcpy(sky.data.data() + y * sizeof(float), &radiance, sizeof(float));
    }
    const ImageId image = add<ImageId>(scene.images, std::move(sky));
    scene.lights.emplace_back(EnvironmentLight{.image = image, .visible_to_camera = false});
}

void render_model(Model& model) {
    std::string text = slurp(model.file);
    // The suite comes without this texture: any other will do for where things are.
    for (size_t at; (at = text.find("MetallicRoughness_Nodes")) != text.npos;) text.replace(at, 23, "BaseColor_Nodes");
    auto loaded = load_gltf(text, {}, model.file.parent_path().string());
    ASSERT_TRUE(loaded.ok()) << loaded.error().str();
    model.lines = has(loaded->fidelity, "points and lines");
    Scene& scene = loaded->scene;
    scene.names = {};
    light(scene);
    // Of the viewer that made the references: 0.8 radians, and it looks at the origin.
    const auto degrees = static_cast<float>(0.8 * 180 / std::numbers::pi);
    scene.cameras = {PerspectiveCamera{.position = model.camera, .look_at = {0, 0, 0}, .vertical_fov = degrees}};
    RenderSettings settings;
    settings.width = settings.height = kSide;
    settings.samples_per_pixel = 16;
    settings.max_depth = 2;
    settings.filter = {FilterKind::box, 0.5f};
    settings.aovs = {Aov::alpha};
    const RenderResult result = run(prepared(std::move(scene)), settings);
    const Image color = color_channels(result.image);
    for (size_t i = 0; i < kPixels; ++i)
        model.ours.push_back({color.pixels[3 * i], color.pixels[3 * i + 1], color.pixels[3 * i + 2]});
    model.alpha = channel(result.image, "A");
}

void read_reference(Model& model) {
    if (model.reference.extension() != ".png") return;
    const auto image = read_image(model.reference.string());
    ASSERT_TRUE(image.ok()) << image.error().str();
    ASSERT_TRUE(image->width == kSide && image->height == kSide);
    const Image color = color_channels(*image);
    for (size_t i = 0; i < kPixels; ++i)
        model.theirs.push_back({color.pixels[3 * i], color.pixels[3 * i + 1], color.pixels[3 * i + 2]});
}

/// Ours in the hall, under the exposure of each channel within [0.7, 2] that comes nearest to `reference`. Like
/// those, what is half transparent is mixed by the codes of a screen.
Picture in_the_hall(const Model& m, const Picture& hall, const Picture& reference) {
    Picture out(kPixels);
    const auto share = [&](size_t i) { return std::max(static_cast<double>(m.alpha[i]), 1e-6); };
    for (int c = 0; c < 3; ++c) {
        double top = 0, bottom = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            const double alpha = share(i), own = m.ours[i][c] / alpha;
            const double code = (code_of(reference[i][c]) - (1 - alpha) * code_of(hall[i][c])) / alpha;
            if (alpha < 0.1 || code > 0.97) continue;  // what is cut off says little
            top += alpha * linear_of(code) * own;
            bottom += alpha * own * own;
        }
        constexpr double kLeast = 0.7, kMost = 2;
        const double exposure = bottom > 1e-3 ? std::clamp(top / bottom, kLeast, kMost) : kMost;
        for (size_t i = 0; i < kPixels; ++i) {
            const double alpha = share(i), own = code_of(exposure * m.ours[i][c] / alpha);
            out[i][c] = static_cast<float>(linear_of(alpha * own + (1 - alpha) * code_of(hall[i][c])));
        }
    }
    return out;
}

/// Of what stands out from the hall in either of the pictures, the part that does so in both.
double overlap(const Model& m, const Picture& hall) {
    const Picture own = in_the_hall(m, hall, m.theirs);
    size_t both = 0, any = 0;
    for (size_t i = 0; i < kPixels; ++i) {
        constexpr double kSeen = 0.012;
        const bool ours = difference(own[i], hall[i]) > kSeen, theirs = difference(m.theirs[i], hall[i]) > kSeen;
        both += ours && theirs;
        any += ours || theirs;
    }
    return any ? static_cast<double>(both) / static_cast<double>(any) : 1;
}

double mean_difference(const Picture& a, const Picture& b) {
    double sum = 0;
    for (size_t i = 0; i < kPixels; ++i) sum += difference(a[i], b[i]);
    return sum / static_cast<double>(kPixels);
}
double error_of(const Model& m, const Picture& hall, const Picture& reference) {
    return mean_difference(in_the_hall(m, hall, reference), reference);
}

/// The hall as most of the pictures of a group have it at each pixel.
Picture median_of(const std::vector<Model>& models, std::string_view group) {
    Picture out(kPixels);
    std::vector<float> values;
    for (size_t i = 0; i < kPixels; ++i)
        for (int c = 0; c < 3; ++c) {
            values.clear();
            for (const Model& m : models)
                if (m.group == group) values.push_back(m.theirs[i][c]);
            std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(values.size() / 2), values.end());
            out[i][c] = values[values.size() / 2];
        }
    return out;
}

/// Smooth ones mirror the hall, and a white metal has its colour.
bool shows_the_hall(const Model& m) {
    for (const char* number : {"00", "04", "06", "10", "11"})
        if (m.name == std::string("Material_MetallicRoughness_") + number) return true;
    return false;
}

void check(const Model& m, const std::vector<Model>& models, const Picture& hall) {
    SCOPED_TRACE(m.name);
    const bool from_above = m.camera.y != 0;  // there the hall is known but for what all models cover
    const double covered = from_above ? 1 : overlap(m, hall), error = error_of(m, hall, m.theirs);
    std::printf("%-32s overlap %.3f, difference %.4f\n", m.name.c_str(), covered, error);
    // Of small models and faint ones the border is a larger part.
    EXPECT_GE(covered, m.group == "Instancing" || m.group == "Material_AlphaBlend" ? 0.86 : 0.93);
    if (shows_the_hall(m)) return;
    EXPECT_LE(error, 0.055);
    // No other picture of the group fits better, unless it is as good as the same.
    for (const Model& other : models) {
        if (other.group != m.group || other.theirs.empty() || mean_difference(other.theirs, m.theirs) < 0.01) continue;
        EXPECT_LT(error, error_of(m, hall, other.theirs)) << other.name;
    }
}

/// Ours above, theirs below.
void write_sheet(const std::vector<Model>& models, const std::string& path) {
    constexpr uint32_t kAcross = 14;
    const auto rows = static_cast<uint32_t>((models.size() + kAcross - 1) / kAcross);
    Image sheet{kAcross * kSide, rows * 2 * kSide, {"R", "G", "B"}, {}, {}};
    sheet.pixels.resize(size_t(sheet.width) * sheet.height * 3);
    for (size_t i = 0; i < models.size(); ++i)
        for (const bool below : {false, true}) {
            const Picture& p = below ? models[i].theirs : models[i].ours;
            for (size_t j = 0; j < p.size(); ++j) {
                const size_t x = i % kAcross * kSide + j % kSide, y = (i / kAcross * 2 + below) * kSide + j / kSide;
                for (int c = 0; c < 3; ++c) sheet.pixels[(y * sheet.width + x) * 3 + static_cast<size_t>(c)] = p[j][c];
            }
        }
    ASSERT_TRUE(write_image(path, sheet).ok());
}

TEST(GltfSuite, AssetGenerator) {
    const auto shared = shared_folder();
    if (!shared || !std::filesystem::exists(*shared / "suites/gltf_asset_generator"))
        GTEST_SKIP() << "suites/gltf_asset_generator is not there";
    std::vector<Model> models = models_in(*shared / "suites/gltf_asset_generator");
    ASSERT_GT(models.size(), 100u);
    for (Model& model : models) {
        render_model(model);
        read_reference(model);
        if (HasFatalFailure()) return;
    }
    if (const char* path = std::getenv("STERADIAN_CONTACT_SHEET")) write_sheet(models, path);
    // The hall alone: a model of which its alpha leaves nothing.
    const auto empty =
        std::find_if(models.begin(), models.end(), [](const Model& m) { return m.name == "Material_AlphaMask_03"; });
    ASSERT_NE(empty, models.end());
    const Picture above = median_of(models, "Node_Attribute");
    for (const Model& m : models) {
        const float most = *std::max_element(m.alpha.begin(), m.alpha.end());
        EXPECT_EQ(most > 0, !m.lines && &m != &*empty) << m.name;
        if (most > 0 && !m.theirs.empty()) check(m, models, m.camera.y != 0 ? above : empty->theirs);
    }
}

}  // namespace
}  // namespace steradian
