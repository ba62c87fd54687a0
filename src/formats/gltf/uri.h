// References of glTF files: relative paths, percent-encoded, or data inside the text (RFC 3986, RFC 2397, RFC 4648).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace steradian::gltf {

/// "%20" as a space and so on; nothing where a '%' does not stand before two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view uri);

/// "data:image/png;base64,…". Views into the URI.
struct DataUri {
    std::string_view media_type;  ///< "image/png", without parameters; may be empty
    bool base64 = false;
    std::string_view payload;
};
/// Nothing when it is not a data URI; one without a comma has an empty payload and is not base64.
std::optional<DataUri> parse_data_uri(std::string_view uri);

/// With or without padding; nothing where there is anything else than the 64 characters, or a single left-over one.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace steradian::gltf
