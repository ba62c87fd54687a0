// The complex indices of metals. tools/metals.py computes them from measurements: n and k over the spectrum give the
// reflectance at every angle, the CIE 1931 observer under D65 its colour in linear Rec. 709 relative to white, and the
// index of a channel is the one whose reflectance over all angles is nearest to that colour. (Gold's red is brighter
// than Rec. 709 can say, 1.04, and is the brightest possible.)
#include <array>

#include "steradian/scene.h"

namespace steradian {
namespace {

struct Metal {
    std::string_view name;
    ComplexIndex index;
};

// P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972): silver, gold, copper; Phys. Rev. B 9, 5056 (1974):
// iron, chromium, titanium, nickel. A. D. Rakić, Appl. Opt. 34, 4755 (1995): aluminium. B. Karlsson and
// C. G. Ribbing, J. Appl. Phys. 53, 6340 (1982): austenitic stainless steel. M. R. Querry, Report CRDEC-CR-88009
// (1985): brass, 70 % copper.
constexpr Metal kMetals[] = {
    {"silver", {{0.057f, 0.055f, 0.043f}, {4.483f, 3.546f, 2.590f}}},
    {"gold", {{0.106f, 0.499f, 1.470f}, {18.859f, 2.261f, 1.774f}}},
    {"copper", {{0.221f, 1.044f, 1.295f}, {3.353f, 2.624f, 2.361f}}},
    {"aluminium", {{1.497f, 0.984f, 0.605f}, {7.638f, 6.546f, 5.344f}}},
    {"iron", {{2.923f, 2.919f, 2.546f}, {3.077f, 2.937f, 2.750f}}},
    {"steel", {{2.412f, 2.021f, 1.652f}, {4.187f, 3.641f, 3.070f}}},
    {"chromium", {{3.247f, 3.114f, 2.286f}, {3.287f, 3.336f, 3.117f}}},
    {"titanium", {{2.747f, 2.508f, 2.240f}, {3.842f, 3.397f, 3.014f}}},
    {"nickel", {{2.033f, 1.903f, 1.728f}, {4.199f, 3.570f, 2.895f}}},
    {"brass", {{0.452f, 0.523f, 1.124f}, {4.198f, 2.666f, 1.810f}}},
};

constexpr auto kNames = [] {
    std::array<std::string_view, std::size(kMetals)> names;
    for (size_t i = 0; i < names.size(); ++i) names[i] = kMetals[i].name;
    return names;
}();

}  // namespace

std::optional<ComplexIndex> metal_index(std::string_view name) {
    for (const Metal& metal : kMetals)
        if (metal.name == name) return metal.index;
    return std::nullopt;
}

std::span<const std::string_view> metal_names() { return kNames; }

}  // namespace steradian
