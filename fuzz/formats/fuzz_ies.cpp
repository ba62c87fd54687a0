// Photometric files (IES LM-63).
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "formats/ies/ies.h"
#include "scene/intensity_profile.h"
#include "scene/validate.h"

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    auto profile = steradian::parse_ies(text, "fuzz.ies");
    if (!profile) {
        const steradian::Error& error = profile.error();
        require(!error.message.empty() && error.where.line > 0 && error.str().size() < 8192);
        return 0;
    }
    for (double vertical = -10; vertical < 200; vertical += 9.7)
        for (double horizontal = 0; horizontal <= 360; horizontal += 7.5) {
            const double candela = steradian::intensity_at(*profile, vertical, horizontal);
            require(candela >= 0 && candela <= steradian::peak_intensity(*profile));
        }
    require(steradian::total_flux(*profile) >= 0);
    // What the parser accepts a scene accepts as well.
    steradian::Scene scene;
    scene.profiles.push_back(*std::move(profile));
    require(steradian::validate(scene).ok());
    return 0;
}
