// Photometric data files: ANSI/IESNA LM-63 of 1986, 1991, 1995, 2002 and 2019.
#pragma once

#include <string>
#include <string_view>

#include "steradian/result.h"
#include "steradian/scene.h"

namespace steradian {

/// Candela values times the file's multiplier and its two ballast factors, and with TILT=INCLUDE times the factor for
/// no tilt; planes that follow from a symmetry are written out. Type C (planes through the vertical axis) only.
Result<IntensityProfile> load_ies(const std::string& path);

/// The same from memory (for tests and fuzzing).
Result<IntensityProfile> parse_ies(std::string_view text, const std::string& name);

}  // namespace steradian
