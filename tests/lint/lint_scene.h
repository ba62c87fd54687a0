// Scenes for the tests of lint: a sphere before a camera under an even sky, in which there is nothing to find.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "steradian/lint.h"

namespace steradian::test {

struct LintScene {
    Scene s;
    RenderSettings settings;

    LintScene() {
        s.cameras = {PerspectiveCamera{{0, 0, 6}}};
        s.lights = {EnvironmentLight{}};
        place(Sphere{}, grey());
    }

    TextureId constant(float value) {
        return add<TextureId>(s.textures, Texture(ConstantTexture{{value, value, value}}));
    }
    MaterialId material(Material m) { return add<MaterialId>(s.materials, std::move(m)); }
    MaterialId grey(bool two_sided = true) { return material(DiffuseMaterial{constant(0.5f), two_sided}); }
    InstanceId place(const Shape& shape, MaterialId m, const Affine& where = {}) {
        const auto id = add<ShapeId>(s.shapes, shape);
        return add<InstanceId>(s.instances, Instance{id, m, where});
    }
    InstanceId place(Mesh mesh, MaterialId m, const Affine& where = {}) {
        return place(Shape(add<MeshId>(s.meshes, std::move(mesh))), m, where);
    }
    /// One channel of floats, or as many bytes as there are, RGB.
    ImageId image(const std::vector<float>& values) {
        RawImage out{static_cast<uint32_t>(values.size()), 1, 1, TexelFormat::f32, {}};
        out.data.resize(4 * values.size());
        std::memcpy(out.data.data(), values.data(), out.data.size());
        return add<ImageId>(s.images, std::move(out));
    }
    ImageId bytes(const std::vector<int>& values, uint8_t channels = 3) {
        RawImage out{static_cast<uint32_t>(values.size() / channels), 1, channels, TexelFormat::u8, {}};
        for (const int v : values) out.data.push_back(static_cast<std::byte>(v));
        return add<ImageId>(s.images, std::move(out));
    }
    TextureId texture(ImageId id, ColorSpace space) {
        ImageTexture out;
        out.image = id;
        out.color_space = space;
        return add<TextureId>(s.textures, Texture(out));
    }
    LintReport lint(const LintOptions& options = {}) const {
        auto report = steradian::lint(s, settings, options);
        if (!report) throw std::runtime_error(report.error().str());
        return std::move(report).value();
    }
    /// Rules with their numbers of findings.
    std::map<std::string, int> rules() const {
        std::map<std::string, int> out;
        for (const Finding& f : lint().findings) ++out[std::string(f.rule)];
        return out;
    }
};

/// A box with shared vertices, facing outwards.
inline Mesh box(Vec3 lo, Vec3 hi) {
    Mesh m;
    for (int i = 0; i < 8; ++i) m.positions.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
    m.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return m;
}
inline Mesh cube(float half) { return box({-half, -half, -half}, {half, half, half}); }

inline Mesh inside_out(Mesh m) {
    for (size_t i = 0; i < m.indices.size(); i += 3) std::swap(m.indices[i], m.indices[i + 1]);
    return m;
}
inline Mesh without_last_triangles(Mesh m, size_t n) {
    m.indices.resize(m.indices.size() - 3 * n);
    return m;
}
inline Mesh joined(Mesh a, const Mesh& b) {
    const auto first = static_cast<uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const uint32_t i : b.indices) a.indices.push_back(first + i);
    return a;
}
/// Every triangle has vertices of its own, as in files without normals.
inline Mesh unwelded(const Mesh& m) {
    Mesh out;
    for (const uint32_t i : m.indices) {
        out.indices.push_back(static_cast<uint32_t>(out.positions.size()));
        out.positions.push_back(m.positions[i]);
    }
    return out;
}
inline Mesh triangle() { return Mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {}, {}, {0, 1, 2}}; }

}  // namespace steradian::test
