// Small scenes for the tests of the renderer, built by hand.
#pragma once

#include <utility>

#include "steradian/render.h"

namespace steradian::test {

inline MaterialId diffuse(Scene& s, Rgb color, bool two_sided = false) {
    const auto texture = add<TextureId>(s.textures, Texture(ConstantTexture{color}));
    return add<MaterialId>(s.materials, Material(DiffuseMaterial{texture, two_sided}));
}

inline InstanceId place(Scene& s, Shape shape, MaterialId material, Affine world_from_object = {}) {
    const auto id = add<ShapeId>(s.shapes, std::move(shape));
    return add<InstanceId>(s.instances, Instance{id, material, world_from_object});
}

/// A floor and a back wall, a glass and a mirror sphere, an instanced mesh, every kind of light.
inline Scene everything_scene() {
    Scene s;
    const MaterialId grey = diffuse(s, {0.7f, 0.7f, 0.68f}, true), red = diffuse(s, {0.6f, 0.1f, 0.05f}, true);
    const auto glass = add<MaterialId>(s.materials, Material(GlassMaterial{}));
    const auto mirror = add<MaterialId>(s.materials, Material(MirrorMaterial{{0.9f, 0.9f, 0.9f}}));
    place(s, Rectangle{{0, 0, 0}, {3, 0, 0}, {0, 0, -3}}, grey);
    place(s, Rectangle{{0, 2, -3}, {3, 0, 0}, {0, 2, 0}}, red);
    place(s, Sphere{{-0.8f, 0.6f, 0.5f}, 0.6f}, glass);
    place(s, Sphere{{0.9f, 0.7f, -0.5f}, 0.7f}, mirror);
    place(s, Disk{{0, 2.5f, -1}, {0, -1, 1}, 0.5f}, red);
    const auto mesh = add<MeshId>(
        s.meshes,
        Mesh{{{0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}}, {}, {}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}});
    const auto tetrahedron = add<ShapeId>(s.shapes, Shape(mesh));
    s.instances.push_back({tetrahedron, grey, translation(-0.3, 0.01, 1.2)});
    s.instances.push_back(
        {tetrahedron, red, translation(0.6, 0.01, 1.0) * rotation_degrees(35, {0, 1, 0}) * scaling(1, 1.5, 1)});
    const InstanceId lamp = place(s, Rectangle{{0, 3.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}}, grey);
    s.lights = {AreaLight{lamp, {9, 8, 7}, true, 2}, PointLight{{-1, 3, 2}, {2, 3, 4}},
                SpotLight{{2, 3, 2}, {-1, -1, -1}, {5, 5, 3}, 15, 30},
                DirectionalLight{{1, -1, -1}, {0.2f, 0.2f, 0.3f}}, EnvironmentLight{{0.1f, 0.15f, 0.2f}}};
    s.cameras = {PerspectiveCamera{{0, 1.5f, 6}, {0, 1, 0}, {0, 1, 0}, 40}};
    return s;
}

}  // namespace steradian::test
