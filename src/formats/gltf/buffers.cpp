#include "formats/gltf/buffers.h"

#include "base/file.h"
#include "base/text.h"
#include "formats/gltf/meshopt.h"
#include "formats/gltf/uri.h"

namespace steradian::gltf {
namespace {

constexpr uint64_t kMaxBytes = uint64_t(1) << 53;  ///< whole numbers of JSON are exact up to here

}  // namespace

std::string Buffers::read_data(std::string_view uri, size_t offset) const {
    const DataUri data = *parse_data_uri(uri);
    if (!data.base64)
        context_.source.fail(offset, "this data URI is not encoded in base64, expected 'data:<type>;base64,<data>'");
    auto bytes = decode_base64(data.payload);
    if (!bytes) context_.source.fail(offset, "the data of this URI is not base64");
    return std::move(*bytes);
}

std::shared_ptr<const std::string> Buffers::read_uri(std::string_view uri, size_t offset) {
    if (parse_data_uri(uri)) return std::make_shared<const std::string>(read_data(uri, offset));
    const auto name = percent_decoded(uri);
    if (!name)
        context_.source.fail(offset, "this URI has a '%' that is not followed by two hexadecimal digits",
                             "a '%' in a file's name is written as %25");
    const std::string path = context_.source.take(context_.assets.resolve(*name), offset);
    if (const auto known = files_.find(path); known != files_.end())
        if (auto bytes = known->second.lock()) return bytes;
    auto bytes = std::make_shared<const std::string>(
        context_.source.take(read_file(path, context_.options.max_file_bytes), offset));
    if (files_.insert_or_assign(path, bytes).second) context_.loaded.files.push_back(path);
    return bytes;
}

Buffers::Bytes Buffers::buffer(uint32_t number) {
    if (const auto known = open_.find(number); known != open_.end()) return known->second;
    const Object buffer(context_.source, context_.tables.buffers.elements[number], "a buffer");
    const uint64_t length =
        json::read_integer(context_.source, buffer.require("byteLength"), "'byteLength'", 1, kMaxBytes);
    std::string_view bytes;
    if (const auto uri = buffer.find("uri")) {
        const std::string_view text = json::read_string(context_.source, *uri, "'uri'");
        bytes = *owned_.emplace_back(read_uri(text, uri->offset()));
    } else if (number == 0 && binary_chunk_) {
        bytes = *binary_chunk_;
    } else {
        // Extensions may say where its data are; nothing else does.
        context_.warn("a buffer has no data: zeros are used", buffer.offset());
        context_.budget.take_unread(length, context_.source, buffer.offset());
        bytes = *owned_.emplace_back(std::make_shared<const std::string>(length, '\0'));
        context_.budget.disown(std::as_bytes(std::span(bytes)));
    }
    if (bytes.size() < length)
        context_.source.fail(
            buffer.offset_of("byteLength"),
            "the buffer claims " + std::to_string(length) + " bytes, but there are " + std::to_string(bytes.size()));
    const Bytes out = std::as_bytes(std::span(bytes.data(), length));
    open_.emplace(number, out);
    return out;
}

Buffers::View Buffers::view(uint32_t number) {
    const auto known = views_.find(number);
    return known != views_.end() ? known->second : views_.emplace(number, check(number)).first->second;
}

/// The bytes that an object names by buffer, offset and length.
Buffers::Bytes Buffers::part_of_buffer(const Object& view) {
    const uint32_t of = view.require_reference("buffer", context_.tables.buffers);
    const uint64_t begin = view.integer_or("byteOffset", 0, 0, kMaxBytes);
    const uint64_t length =
        json::read_integer(context_.source, view.require("byteLength"), "'byteLength'", 1, kMaxBytes);
    const Bytes bytes = buffer(of);
    if (begin > bytes.size() || length > bytes.size() - begin)
        context_.source.fail(view.offset(), "the buffer view needs bytes " + std::to_string(begin) + " to " +
                                                std::to_string(begin + length) + " of a buffer with " +
                                                std::to_string(bytes.size()));
    return bytes.subspan(begin, length);
}

Buffers::Bytes Buffers::decompress(const Object& view, const Object& extension) {
    const meshopt::Header header = meshopt::read_header(extension);
    const uint64_t length =
        json::read_integer(context_.source, view.require("byteLength"), "'byteLength'", 1, kMaxBytes);
    if (length != header.bytes())
        context_.source.fail(view.offset_of("byteLength"), "the buffer view has " + std::to_string(length) +
                                                               " bytes, but its data are " +
                                                               std::to_string(header.bytes()) + " when decompressed");
    const Bytes compressed = part_of_buffer(extension);
    context_.budget.grant(compressed);
    context_.budget.take(header.bytes(), context_.source, extension.offset());
    auto bytes = meshopt::decode(header, compressed);
    if (!bytes) context_.source.fail(extension.offset(), "the data are not compressed as the extension says");
    const Bytes out =
        std::as_bytes(std::span(*owned_.emplace_back(std::make_shared<const std::string>(std::move(*bytes)))));
    context_.budget.disown(out);
    return out;
}

Buffers::View Buffers::check(uint32_t number) {
    const Object view(context_.source, context_.tables.buffer_views.elements[number], "a buffer view");
    const auto compressed = view.extension("EXT_meshopt_compression");
    const Bytes bytes = compressed ? decompress(view, *compressed) : part_of_buffer(view);
    return {bytes, view.integer_or("byteStride", 0, 4, 252)};
}

}  // namespace steradian::gltf
