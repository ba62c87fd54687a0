// glTF, text and binary, with everything that may be inside of it: accessors, compressed meshes, images. No file can be
// reached: the folder does not exist and paths must not leave it.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "formats/gltf/gltf.h"
#include "formats/json/reader.h"
#include "meshes/check.h"
#include "scene/validate.h"

namespace steradian {
namespace {

constexpr uint64_t kFreeBytes = 1 << 20;

size_t texel_size(TexelFormat format) { return format == TexelFormat::u8 ? 1 : format == TexelFormat::f32 ? 4 : 2; }

/// What is accepted is consistent, and no larger than the budget says.
void check_scene(const LoadedScene& loaded, uint64_t budget) {
    const Scene& scene = loaded.scene;
    uint64_t bytes = 0;
    for (const Mesh& mesh : scene.meshes) {
        require(!mesh.indices.empty() && mesh.indices.size() % 3 == 0);
        for (const uint32_t i : mesh.indices) require(i < mesh.positions.size());
        require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
        require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
        bytes += mesh.indices.size() * 4 + mesh.positions.size() * 12;
    }
    for (const RawImage& image : scene.images) {
        require(image.width > 0 && image.height > 0);
        require(image.data.size() == size_t(image.width) * image.height * image.channels * texel_size(image.format));
        bytes += image.data.size();
    }
    require(bytes <= budget + scene.images.size());  // a white texel for what is not there
    for (const Texture& texture : scene.textures)
        if (const auto* image = std::get_if<ImageTexture>(&texture)) require(index(image->image) < scene.images.size());
    for (const Instance& instance : scene.instances) {
        require(index(instance.shape) < scene.shapes.size() && index(instance.material) < scene.materials.size());
        for (const auto& row : instance.world_from_object.m)
            for (const double x : row) require(std::isfinite(x));
    }
    for (const Light& light : scene.lights)
        if (const auto* area = std::get_if<AreaLight>(&light)) require(index(area->instance) < scene.instances.size());
    require(loaded.settings.width > 0 && loaded.settings.height > 0);
    require(loaded.diagnostics.warnings().size() < 200 && loaded.fidelity.warnings().size() < 200);
}

/// True where it was accepted and has animations.
bool load(std::string_view bytes, const LoadOptions& options) {
    try {
        LoadedScene loaded = gltf::load(bytes, "fuzz.gltf", "/nonexistent/steradian-fuzz", options);
        check_scene(loaded, std::max<uint64_t>(kFreeBytes, 256 * bytes.size()));
        // Meshes may have numbers that are not finite until this; then the scene as a whole is good or refused.
        sanitize(loaded.scene, loaded.diagnostics);
        if (const auto status = validate(loaded.scene); !status) require(!status.error().message.empty());
        return !loaded.animations.empty();
    } catch (const json::ReadFailure& failure) {
        check_error(failure.error);
        const SourceLocation& where = failure.error.where;
        require(where.byte || (where.line > 0 && where.column > 0));
        for (const char c : failure.error.message) require(static_cast<unsigned char>(c) >= 0x20);
    }
    return false;
}

}  // namespace
}  // namespace steradian

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace steradian;
    LoadOptions options;
    options.images.max_pixels = 1 << 16;
    options.gltf_free_bytes = kFreeBytes;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    if (!load(bytes, options)) return 0;
    options.frame_time = 0.5;
    load(bytes, options);
    return 0;
}
