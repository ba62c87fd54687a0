// Scenes in JSON, our own and the course's. No file can be reached: the base folder does not exist and paths must not
// leave it.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "steradian/load.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    steradian::LoadOptions options;
    options.allow_outside_paths = false;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto loaded = steradian::load_scene_json(text, "fuzz.json", "/nonexistent/steradian-fuzz", options);
    if (!loaded) {
        // Every refusal says what and where, on one line, without raw control characters.
        const steradian::Error& error = loaded.error();
        if (error.message.empty() || error.where.file.empty() || error.where.line == 0 || error.where.column == 0)
            std::abort();
        for (const char c : error.message)
            if (static_cast<unsigned char>(c) < 0x20) std::abort();
        return 0;
    }
    // What is accepted is consistent.
    const steradian::Scene& scene = loaded->scene;
    if (scene.cameras.empty() || loaded->settings.camera >= scene.cameras.size()) std::abort();
    for (const steradian::Instance& instance : scene.instances)
        if (index(instance.shape) >= scene.shapes.size() || index(instance.material) >= scene.materials.size())
            std::abort();
    for (const steradian::Light& light : scene.lights)
        if (const auto* area = std::get_if<steradian::AreaLight>(&light);
            area && index(area->instance) >= scene.instances.size())
            std::abort();
    return 0;
}
