// Scenes for the tests of lint: a sphere before a camera under an even sky, in which there is nothing to find.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <map>
#include <ostream>
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

/// A closed body of 2 n² triangles on each of its two sides, a wavy slab.
inline Mesh slab(uint32_t n) {
    Mesh m;
    const auto at = [&](uint32_t x, uint32_t y, float z) {
        m.positions.push_back({float(x) / float(n), float(y) / float(n), z + 0.1f * float((x * 7 + y * 3) % 11) / 11});
    };
    for (const float z : {0.0f, 0.5f})
        for (uint32_t y = 0; y <= n; ++y)
            for (uint32_t x = 0; x <= n; ++x) at(x, y, z);
    const uint32_t row = n + 1, side = row * row;
    const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        m.indices.insert(m.indices.end(), {a, b, c, a, c, d});
    };
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t i = y * row + x;
            quad(i, i + row, i + row + 1, i + 1);
            quad(side + i, side + i + 1, side + i + row + 1, side + i + row);
        }
    for (uint32_t k = 0; k < n; ++k) {
        const uint32_t last = n * row;
        quad(k, k + 1, side + k + 1, side + k);
        quad(last + k + 1, last + k, side + last + k, side + last + k + 1);
        quad((k + 1) * row, k * row, side + k * row, side + (k + 1) * row);
        quad(k * row + n, (k + 1) * row + n, side + (k + 1) * row + n, side + k * row + n);
    }
    return m;
}

/// A scene for a rule.
struct Case {
    const char* name;
    const char* rule;  ///< the only one that finds something, once; "" for a near miss
    std::function<void(LintScene&)> make;
};
inline void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

inline void expect_findings(const Case& c) {
    LintScene t;
    c.make(t);
    const std::string rule = c.rule;
    std::map<std::string, int> expected;
    if (!rule.empty()) expected[rule] = 1;
    std::string all;
    for (const Finding& f : t.lint().findings) all += f.str() + "\n";
    EXPECT_EQ(t.rules(), expected) << all;

    LintOptions without;
    if (!rule.empty()) without.disabled = {rule};
    EXPECT_TRUE(t.lint(without).findings.empty());
}

}  // namespace steradian::test
