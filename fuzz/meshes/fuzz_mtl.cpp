#include <cmath>

#include "formats/obj/mtl.h"
#include "meshes/check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace steradian;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto library = parse_mtl(text, "fuzz.mtl", "folder", {});
    if (!library) {
        check_error(library.error());
        return 0;
    }
    for (const MeshMaterial& m : library->materials) {
        for (const Rgb c : {m.diffuse, m.specular, m.emission, m.transmission})
            for (int i = 0; i < 3; ++i) require(c[i] >= 0 && std::isfinite(c[i]));
        require(m.ior > 0 && std::isfinite(m.ior));
        require(m.dissolve >= 0 && m.dissolve <= 1);
        require(m.illum >= 0 && m.illum <= 10);
        require(std::isfinite(m.map_scale.x) && std::isfinite(m.map_scale.y));
        require(std::isfinite(m.map_offset.x) && std::isfinite(m.map_offset.y));
    }
    require(library->diagnostics.warnings().size() < 100);
    return 0;
}
