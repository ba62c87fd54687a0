// Buffers and the views into them. A buffer is read when it is first used and stays until the file is loaded.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/gltf/context.h"

namespace steradian::gltf {

class Buffers {
public:
    using Bytes = std::span<const std::byte>;

    Buffers(Context& context, std::optional<std::string_view> binary_chunk)
        : context_(context), binary_chunk_(binary_chunk) {}

    struct View {
        Bytes bytes;
        uint64_t stride = 0;  ///< between elements; 0: as large as they are
    };
    /// Fails where the view leaves its buffer, or the buffer its file. Checked when it is first asked for.
    View view(uint32_t number);

    /// What a URI refers to: data in itself, or a file inside the scene's folder, read once however often it is named.
    /// Nothing is fetched from the network. `offset` is that of the URI, for messages.
    std::shared_ptr<const std::string> read_uri(std::string_view uri, size_t offset);

private:
    Bytes buffer(uint32_t number);
    Bytes part_of_buffer(const Object& view);
    Bytes decompress(const Object& view, const Object& extension);
    View check(uint32_t number);
    std::string read_data(std::string_view uri, size_t offset) const;

    Context& context_;
    std::optional<std::string_view> binary_chunk_;
    std::vector<std::shared_ptr<const std::string>> owned_;
    std::map<std::string, std::weak_ptr<const std::string>> files_;  ///< by path
    std::map<uint32_t, Bytes> open_;
    std::map<uint32_t, View> views_;
};

}  // namespace steradian::gltf
