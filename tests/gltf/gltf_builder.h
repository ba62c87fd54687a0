// glTF files for the tests: JSON with a buffer whose parts are added one by one.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gltf/gltf.h"
#include "formats/json/reader.h"
#include "steradian/load.h"

namespace steradian::test {

inline std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

class GltfBuilder {
public:
    /// Appends the values to the buffer, as one view with one accessor; returns the accessor's number.
    template <class T>
    int accessor(std::string_view type, int component, size_t per_element, const std::vector<T>& values,
                 std::string_view more = {}) {
        const size_t begin = bytes_.size();
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        views_.push_back("{\"buffer\": 0, \"byteOffset\": " + std::to_string(begin) +
                         ", \"byteLength\": " + std::to_string(values.size() * sizeof(T)) + "}");
        return raw_accessor("\"bufferView\": " + std::to_string(views_.size() - 1) + ", \"componentType\": " +
                            std::to_string(component) + ", \"count\": " + std::to_string(values.size() / per_element) +
                            ", \"type\": \"" + std::string(type) + "\"" + std::string(more));
    }
    int floats(std::string_view type, size_t per_element, const std::vector<float>& values) {
        return accessor(type, 5126, per_element, values);
    }
    int raw_accessor(const std::string& members) {
        accessors_.push_back("{" + members + "}");
        return static_cast<int>(accessors_.size() - 1);
    }
    int view(std::string_view bytes, std::string_view more = {}) {
        views_.push_back("{\"buffer\": 0, \"byteOffset\": " + std::to_string(bytes_.size()) +
                         ", \"byteLength\": " + std::to_string(bytes.size()) + std::string(more) + "}");
        bytes_.append(bytes);
        return static_cast<int>(views_.size() - 1);
    }
    /// A view that holds these bytes by EXT_meshopt_compression: `count` elements of `stride` bytes.
    int compressed_view(std::string_view bytes, std::string_view mode, size_t count, size_t stride,
                        std::string_view filter = "NONE") {
        const std::string length = std::to_string(bytes.size()), each = std::to_string(stride);
        views_.push_back("{\"buffer\": 0, \"byteLength\": " + std::to_string(count * stride) +
                         (mode == "ATTRIBUTES" ? ", \"byteStride\": " + each : std::string()) +
                         ", \"extensions\": {\"EXT_meshopt_compression\": {\"buffer\": 0, \"byteOffset\": " +
                         std::to_string(bytes_.size()) + ", \"byteLength\": " + length + ", \"byteStride\": " + each +
                         ", \"count\": " + std::to_string(count) + ", \"mode\": \"" + std::string(mode) +
                         "\", \"filter\": \"" + std::string(filter) + "\"}}}");
        bytes_.append(bytes);
        return static_cast<int>(views_.size() - 1);
    }
    /// Other top-level members: "nodes", "meshes", …
    std::string text(const std::string& members) const {
        const auto list = [](const std::vector<std::string>& elements) {
            std::string out;
            for (const std::string& e : elements) out += (out.empty() ? "" : ",\n") + e;
            return "[" + out + "]";
        };
        std::string out = "{\"asset\": {\"version\": \"2.0\"}";
        if (!accessors_.empty()) out += ",\n\"accessors\": " + list(accessors_);
        if (!views_.empty()) out += ",\n\"bufferViews\": " + list(views_);
        if (!bytes_.empty())
            out += ",\n\"buffers\": [{\"byteLength\": " + std::to_string(bytes_.size()) +
                   ", \"uri\": \"data:application/octet-stream;base64," + base64(bytes_) + "\"}]";
        return out + (members.empty() ? "" : ",\n" + members) + "}";
    }
    /// The same as a binary file.
    std::string binary(const std::string& members) const {
        GltfBuilder without = *this;
        without.bytes_.clear();
        std::string json = without.text(members + (members.empty() ? "" : ",") +
                                        "\"buffers\": [{\"byteLength\": " + std::to_string(bytes_.size()) + "}]");
        json.resize((json.size() + 3) / 4 * 4, ' ');
        std::string data = bytes_;
        data.resize((data.size() + 3) / 4 * 4, '\0');
        const auto word = [](size_t value) {
            const auto v = static_cast<uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&v), 4);
        };
        return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + data.size()) + word(json.size()) + "JSON" + json +
               word(data.size()) + std::string("BIN\0", 4) + data;
    }

private:
    std::string bytes_;
    std::vector<std::string> views_, accessors_;
};

/// One triangle in the plane z = 0, from an accessor of positions, with one node.
inline std::string one_mesh(int positions, std::string_view primitive = {}, std::string_view more = {}) {
    return "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": " + std::to_string(positions) + "}" +
           std::string(primitive) + "}]}], \"nodes\": [{\"mesh\": 0}]" + std::string(more);
}
inline const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

inline Result<LoadedScene> load_gltf(std::string_view bytes, const LoadOptions& options = {},
                                     const std::string& folder = "/nonexistent") {
    try {
        return gltf::load(bytes, "test.gltf", folder, options);
    } catch (json::ReadFailure& failure) {
        return std::move(failure.error);
    }
}

inline LoadedScene good_gltf(std::string_view bytes, const LoadOptions& options = {}) {
    auto loaded = load_gltf(bytes, options);
    if (!loaded) throw std::runtime_error(loaded.error().str());
    return std::move(loaded).value();
}

/// Must be refused at this JSON pointer, with this in the message.
inline void expect_refused(std::string_view bytes, std::string_view pointer, std::string_view message,
                           ErrorCode code = ErrorCode::bad_input) {
    const auto loaded = load_gltf(bytes);
    ASSERT_FALSE(loaded.ok()) << "was accepted: " << message;
    const Error& error = loaded.error();
    EXPECT_EQ(error.where.file, "test.gltf");
    EXPECT_EQ(error.where.pointer, pointer) << error.str();
    EXPECT_NE(error.message.find(message), std::string::npos) << error.str();
    EXPECT_EQ(error.code, code) << error.str();
}

inline bool has(const Diagnostics& list, std::string_view part) {
    for (const Warning& w : list.warnings())
        if (w.message.find(part) != std::string::npos) return true;
    return false;
}

}  // namespace steradian::test
