// One scene whose picture is known beforehand, as data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analytic/formulas.h"
#include "analytic/scene_text.h"
#include "steradian/image.h"

namespace steradian::analytic {

enum class CaseClass : uint8_t {
    zero_variance,  ///< every sample of a pixel brings the same: within 1e-5 after few samples
    stochastic,     ///< the rule of check.h on standard errors
};

/// The mean over pixels [x0, x1) × [y0, y1) of the picture.
struct Expected {
    uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< x1 = 0: the whole picture
    Color value;
    bool every_pixel = false;  ///< the value holds for each pixel by itself as well
};

/// An image that the scene refers to; the extension decides the format.
struct CaseFile {
    std::string name;
    Image image;
    std::string text = {};  ///< what is in the file, where it is no image
};

struct Case {
    std::string id;
    std::string formula;  ///< what the expected values come from, one line
    std::string scene;    ///< the text of the scene file
    std::vector<Expected> expected;
    CaseClass kind = CaseClass::zero_variance;
    double tolerance =
        1e-5;               ///< relative to the value; to the brightest expected one where it is 0 or there are several
    std::string catalogue;  ///< id of the same geometry in the outside catalogue, where there is one
    std::vector<CaseFile> files;
};

/// The whole picture has one mean.
Case whole(std::string id, std::string formula, const SceneText& scene, Color value);

/// By family; each id is unique among all.
std::vector<Case> delta_light_cases();
std::vector<Case> area_light_cases();
std::vector<Case> emitter_side_cases();
std::vector<Case> environment_cases();
std::vector<Case> sun_cases();
std::vector<Case> goniometric_cases();
std::vector<Case> specular_cases();
std::vector<Case> dispersion_cases();
std::vector<Case> path_cases();
std::vector<Case> medium_cases();
std::vector<Case> opacity_cases();
std::vector<Case> emission_cases();
std::vector<Case> surface_cases();
std::vector<Case> camera_cases();
std::vector<Case> transform_cases();
std::vector<Case> all_cases();

/// A line of the table in docs/verification.md, without its newline.
std::string table_row(const Case& c);

// --- What most cases look at: the origin of a floor of reflectance 1/2 in the plane y = 0 ---------------------------

inline constexpr V3 kUp{0, 1, 0};
inline constexpr double kNarrow = 0.05;  ///< field of view, degrees: the picture is one point but for about 1e-7
inline constexpr double kRho = 0.5;

/// Camera at `from`, materials "floor" (diffuse 1/2) and "black", the floor reaching 20 m.
SceneText floor_scene(V3 from = {0.6, 0.9, 0.9}, V3 at = {0, 0, 0});
/// The same without an object yet.
SceneText empty_scene(V3 from = {0.6, 0.9, 0.9}, V3 at = {0, 0, 0});

/// The class is stochastic, with the tolerance of 0.1 %.
Case noisy(Case c);
Case as_in_catalogue(Case c, std::string id);

}  // namespace steradian::analytic
