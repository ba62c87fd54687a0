// What is in a picture, for `steradian info`.
#pragma once

#include <iosfwd>
#include <string>

#include "steradian/result.h"

namespace steradian::cli {

/// Prints format, size, channels with their ranges and what in them is not finite, metadata and the picture's hash.
/// Ranges and means are over finite values; in JSON they are null where there are none.
Status print_picture_info(const std::string& path, bool json, std::ostream& out);

}  // namespace steradian::cli
