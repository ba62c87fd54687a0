#include "formats/gltf/uri.h"

#include <array>
#include <cstdint>

#include "base/text.h"

namespace steradian::gltf {
namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

constexpr uint8_t kNoDigit = 0xff;

constexpr std::array<uint8_t, 256> base64_digits() {
    std::array<uint8_t, 256> digits{};
    digits.fill(kNoDigit);
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < kAlphabet.size(); ++i)
        digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<uint8_t>(i);
    return digits;
}

}  // namespace

std::optional<std::string> percent_decoded(std::string_view uri) {
    std::string out;
    out.reserve(uri.size());
    for (size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            out += uri[i];
            continue;
        }
        if (i + 2 >= uri.size()) return std::nullopt;
        const int high = hex_digit(uri[i + 1]), low = hex_digit(uri[i + 2]);
        if (high < 0 || low < 0) return std::nullopt;
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

std::optional<DataUri> parse_data_uri(std::string_view uri) {
    constexpr std::string_view kScheme = "data:";
    if (uri.size() < kScheme.size() || !iequals(uri.substr(0, kScheme.size()), kScheme)) return std::nullopt;
    uri.remove_prefix(kScheme.size());
    const size_t comma = uri.find(',');
    const std::string_view head = uri.substr(0, comma);
    DataUri out;
    out.media_type = head.substr(0, head.find(';'));
    if (comma == uri.npos) return out;
    constexpr std::string_view kMark = ";base64";
    out.base64 = head.size() >= kMark.size() && iequals(head.substr(head.size() - kMark.size()), kMark);
    out.payload = uri.substr(comma + 1);
    return out;
}

std::optional<std::string> decode_base64(std::string_view text) {
    static constexpr std::array<uint8_t, 256> kDigits = base64_digits();
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::string out(text.size() / 4 * 3 + (text.size() % 4 == 0 ? 0 : text.size() % 4 - 1), '\0');
    uint32_t bits = 0, count = 0;
    size_t n = 0;
    for (const char c : text) {
        const uint8_t digit = kDigits[static_cast<unsigned char>(c)];
        if (digit == kNoDigit) return std::nullopt;
        bits = bits << 6 | digit;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        out[n++] = static_cast<char>(bits >> count & 0xff);
    }
    return out;
}

}  // namespace steradian::gltf
