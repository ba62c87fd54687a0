#include "formats/gltf/container.h"

#include <bit>
#include <cstring>

#include "base/text.h"

namespace steradian::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and is read as it is");

constexpr std::string_view kMagic = "glTF";
constexpr uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

uint32_t word_at(std::string_view bytes, size_t offset) {
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

class BinaryReader {
public:
    BinaryReader(std::string_view bytes, const std::string& name, Diagnostics& diagnostics)
        : bytes_(bytes), name_(name), diagnostics_(diagnostics) {}

    Result<Container> read() {
        if (auto status = read_header(); !status) return std::move(status).error();
        Container out;
        size_t at = kHeaderBytes;
        for (size_t chunk = 0; at < bytes_.size(); ++chunk) {
            if (bytes_.size() - at < kChunkHeaderBytes)
                return fault(at, "the file ends within the header of a chunk, expected 8 bytes");
            const uint32_t length = word_at(bytes_, at), type = word_at(bytes_, at + 4);
            if (length > bytes_.size() - at - kChunkHeaderBytes)
                return fault(at, "the chunk claims " + std::to_string(length) + " bytes, but the file has only " +
                                     std::to_string(bytes_.size() - at - kChunkHeaderBytes) + " more");
            if (auto status = place_chunk(out, chunk, type, at, length); !status) return std::move(status).error();
            at += kChunkHeaderBytes + length;
        }
        if (!out.json_begin) return fault(kHeaderBytes, "the file has no JSON chunk");
        return out;
    }

private:
    Error fault(size_t offset, std::string message) const {
        return {ErrorCode::bad_input, std::move(message), {name_, 0, 0, offset}, {}, {}};
    }

    /// Cuts what lies behind the stated length.
    Status read_header() {
        if (bytes_.size() < kHeaderBytes)
            return fault(0, "the file has " + std::to_string(bytes_.size()) + " bytes, expected a header of 12");
        if (const uint32_t version = word_at(bytes_, 4); version != 2)
            return fault(4, "this is version " + std::to_string(version) + " of binary glTF, expected 2");
        const uint32_t length = word_at(bytes_, 8);
        if (length > bytes_.size())
            return fault(8, "the header claims " + std::to_string(length) + " bytes, but the file has " +
                                std::to_string(bytes_.size()) + ": it is cut off");
        if (length < kHeaderBytes) return fault(8, "the header claims fewer bytes than it has itself");
        if (length < bytes_.size())
            diagnostics_.warn("what lies behind the end of the binary glTF is ignored", {name_, 0, 0, length});
        bytes_ = bytes_.substr(0, length);
        return Ok{};
    }

    Status place_chunk(Container& out, size_t number, uint32_t type, size_t at, uint32_t length) {
        const std::string_view content = bytes_.substr(at + kChunkHeaderBytes, length);
        if (length % 4 != 0) diagnostics_.warn("a chunk's length is not a multiple of 4", {name_, 0, 0, at});
        if (number == 0 && type != kJsonChunk) return fault(at, "the first chunk is not JSON, as it must be");
        if (type == kJsonChunk) {
            if (out.json_begin) return fault(at, "this is a second JSON chunk, expected at most one");
            out.json = content;
            out.json_begin = at + kChunkHeaderBytes;
        } else if (type == kBinaryChunk) {
            if (out.binary) return fault(at, "this is a second binary chunk, expected at most one");
            if (number != 1) return fault(at, "the binary chunk must be the second one of the file");
            out.binary = content;
        } else {
            diagnostics_.warn("chunks of unknown types are skipped", {name_, 0, 0, at});
        }
        return Ok{};
    }

    std::string_view bytes_;
    const std::string& name_;
    Diagnostics& diagnostics_;
};

/// A binary file that is damaged, or another one by that name, is no JSON with a fault at its first character.
bool must_be_binary(std::string_view bytes, const std::string& name) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    const size_t first = bytes.find_first_not_of(" \t\r\n");
    const bool json = first != bytes.npos && bytes[first] == '{';
    return !json && extension_of(name) == ".glb";
}

}  // namespace

Result<Container> open_container(std::string_view bytes, const std::string& name, Diagnostics& diagnostics) {
    if (bytes.starts_with(kMagic)) return BinaryReader(bytes, name, diagnostics).read();
    if (must_be_binary(bytes, name))
        return Error{ErrorCode::bad_input,
                     "the file is no binary glTF, which begins with 'glTF', nor JSON, which begins with '{'",
                     {name, 0, 0, 0},
                     {},
                     bytes.empty() ? "it is empty" : "it may be damaged, or compressed as a whole"};
    return Container{bytes, std::nullopt, std::nullopt};
}

}  // namespace steradian::gltf
