// Each rule has a scene that it finds something in, and near misses in which there is nothing to find.
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <set>

#include "rule_cases.h"

namespace steradian::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Mesh scaled(Mesh m, float factor) {
    for (Vec3& p : m.positions) p = p * factor;
    return m;
}
/// The first so many sides of a box, rectangles that face in or out. Adds its glass.
MaterialId box_of_sheets(LintScene& t, int count, const Affine& place) {
    const MaterialId m = t.material(glass());
    for (int side = 0; side < count; ++side) {
        const int axis = side / 2;
        Rectangle r;
        r.center = r.half_u = r.half_v = {0, 0, 0};
        r.center[axis] = side % 2 ? 0.3f : -0.3f, r.half_u[(axis + 1) % 3] = 0.3f, r.half_v[(axis + 2) % 3] = 0.3f;
        t.place(Shape(r), m, place);
    }
    return m;
}
/// At z = 0.5, facing there.
Mesh square() {
    return {{{-0.5f, -0.5f, 0.5f}, {0.5f, -0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {-0.5f, 0.5f, 0.5f}},
            {},
            {},
            {0, 1, 2, 0, 2, 3}};
}
/// Of a cube: an open box, and the same turned about.
void two_halves(LintScene& t, double apart) {
    const MaterialId m = t.material(glass());
    const auto shape = add<ShapeId>(t.s.shapes, Shape(add<MeshId>(t.s.meshes, without_last_triangles(cube(0.3f), 2))));
    t.s.instances.push_back({shape, m, at(2, 0, -0.3)});
    t.s.instances.push_back({shape, m, at(2, 0, 0.3 + apart) * rotation_degrees(180, {0, 1, 0})});
}

const Case kMeshCases[] = {
    {"VertexThatIsNoNumber", "nan-vertices",
     [](LintScene& t) {
         Mesh m = triangle();
         m.positions[1].y = kNan;
         t.place(joined(triangle(), m), MaterialId{0}, at(2, 0, 0));
     }},
    {"VertexFarBeyond", "nan-vertices",
     [](LintScene& t) {
         Mesh m = triangle();
         m.positions[1].y = 1e16f;
         t.place(joined(triangle(), m), MaterialId{0}, at(2, 0, 0));
     }},
    {"VertexOfNoTriangle", "",
     [](LintScene& t) {
         Mesh m = triangle();
         m.positions.push_back({kNan, 0, 0});
         t.place(m, MaterialId{0}, at(2, 0, 0));
     }},
    {"NormalThatIsNoNumber", "nan-vertices",
     [](LintScene& t) {
         Mesh m = triangle();
         m.normals = {{0, 0, 1}, {0, 0, kNan}, {0, 0, 1}};
         t.place(m, MaterialId{0}, at(2, 0, 0));
     }},
    {"TriangleWithoutArea", "degenerate-triangles",
     [](LintScene& t) {
         Mesh m = triangle();
         m.indices.insert(m.indices.end(), {0, 1, 1});
         t.place(m, MaterialId{0}, at(2, 0, 0));
     }},
    {"ThinTriangle", "",
     [](LintScene& t) {
         t.place(Mesh{{{0, 0, 0}, {1, 0, 0}, {0.5f, 1e-6f, 0}}, {}, {}, {0, 1, 2}}, MaterialId{0}, at(2, 0, 0));
     }},
    {"TwoMaterialsInOnePlace", "coincident-surfaces",
     [](LintScene& t) { t.place(triangle(), MaterialId{0}, at(2, 0, 0)), t.place(triangle(), t.grey(), at(2, 0, 0)); }},
    {"TwoMaterialsSideBySide", "",
     [](LintScene& t) {
         t.place(triangle(), MaterialId{0}, at(2, 0, 0)), t.place(triangle(), t.grey(), at(2, 0, 1e-5));
     }},
    {"TwiceTheSame", "",
     [](LintScene& t) {
         t.place(triangle(), MaterialId{0}, at(2, 0, 0)), t.place(triangle(), MaterialId{0}, at(2, 0, 0));
     }},
    {"GlassTwice", "coincident-surfaces",
     [](LintScene& t) {
         const MaterialId m = t.material(glass());
         t.place(cube(0.1f), m, at(2, 0, 0)), t.place(cube(0.1f), m, at(2, 0, 0));
     }},
    {"BodiesThatTouch", "",
     [](LintScene& t) {
         const MaterialId water = t.material(GlassMaterial{1.33f, {1, 1, 1}, {1, 1, 1}, {}, 0, {}, 1}),
                          ice = t.material(GlassMaterial{1.31f, {1, 1, 1}, {1, 1, 1}, {}, 0, {}, 2});
         t.place(cube(0.1f), water, at(2, 0, 0)), t.place(cube(0.1f), ice, at(2, 0, 0));
     }},
    {"BodiesThatTouchOfWhichOneHasAPriority", "coincident-surfaces",
     [](LintScene& t) {
         const MaterialId water = t.material(GlassMaterial{1.33f, {1, 1, 1}, {1, 1, 1}, {}, 0, {}, 1}),
                          ice = t.material(GlassMaterial{1.31f});
         t.place(cube(0.1f), water, at(2, 0, 0)), t.place(cube(0.1f), ice, at(2, 0, 0));
     }},
    {"TwoMaterialsInOnePlaceByTransforms", "coincident-surfaces",
     [](LintScene& t) {
         Mesh moved = triangle();
         for (Vec3& p : moved.positions) p = p + Vec3{2, 0, 0};
         t.place(triangle(), MaterialId{0}, at(2, 0, 0)), t.place(moved, t.grey());
     }},
    {"OpenBox", "open-glass",
     [](LintScene& t) { t.place(without_last_triangles(cube(0.5f), 1), t.material(glass()), at(2, 0, 0)); }},
    {"ClosedBox", "", [](LintScene& t) { t.place(cube(0.5f), t.material(glass()), at(2, 0, 0)); }},
    {"ClosedBoxOfLooseTriangles", "",
     [](LintScene& t) { t.place(unwelded(cube(0.5f)), t.material(glass()), at(2, 0, 0)); }},
    {"OpenBoxOfPerfectRefraction", "",
     [](LintScene& t) {
         t.place(without_last_triangles(cube(0.5f), 1), t.material(RefractionMaterial{}), at(2, 0, 0));
     }},
    {"OpenBoxOfThinGlass", "",
     [](LintScene& t) {
         t.place(without_last_triangles(cube(0.5f), 1), t.material(ThinGlassMaterial{}), at(2, 0, 0));
     }},
    {"OpenBoxOfOpenPbr", "open-glass",
     [](LintScene& t) {
         OpenPbrMaterial m;
         m.transmission_weight = {1};
         t.place(without_last_triangles(cube(0.5f), 1), t.material(m), at(2, 0, 0));
     }},
    {"OpenBoxOfThinWalls", "",
     [](LintScene& t) {
         OpenPbrMaterial m;
         m.transmission_weight = {1};
         m.geometry_thin_walled = true;
         t.place(without_last_triangles(cube(0.5f), 1), t.material(m), at(2, 0, 0));
     }},
    {"OpenBoxOfMetal", "",
     [](LintScene& t) {
         OpenPbrMaterial m;
         m.transmission_weight = {1};
         m.base_metalness = {1};
         t.place(without_last_triangles(cube(0.5f), 1), t.material(m), at(2, 0, 0));
     }},
    {"BoxClosedByAnotherMaterial", "",
     [](LintScene& t) {
         Mesh lid = cube(0.5f);
         lid.indices.erase(lid.indices.begin(), lid.indices.end() - 6);
         t.place(without_last_triangles(cube(0.5f), 2), t.material(glass()), at(2, 0, 0));
         t.place(lid, MaterialId{0}, at(2, 0, 0));
     }},
    {"BoxWithItsLidElsewhere", "open-glass",
     [](LintScene& t) {
         Mesh lid = cube(0.5f);
         lid.indices.erase(lid.indices.begin(), lid.indices.end() - 6);
         t.place(without_last_triangles(cube(0.5f), 2), t.material(glass()), at(2, 0, 0));
         t.place(lid, MaterialId{0}, at(2, 0, 1));
     }},
    {"BoxWithItsLidMovedIntoPlace", "",
     [](LintScene& t) {
         Mesh lid = cube(0.5f);
         lid.indices.erase(lid.indices.begin(), lid.indices.end() - 6);
         for (Vec3& p : lid.positions) p.z += 0.3f;
         t.place(without_last_triangles(cube(0.5f), 2), t.material(glass()), at(2, 0, 0));
         t.place(lid, MaterialId{0}, at(2, 0, -0.3));
     }},
    {"BoxOfSixRectangles", "", [](LintScene& t) { box_of_sheets(t, 6, at(2, 0.1, 0)); }},
    {"BoxOfFiveRectangles", "open-glass", [](LintScene& t) { box_of_sheets(t, 5, at(2, 0.1, 0)); }},
    {"TurnedBoxOfSixRectangles", "",
     [](LintScene& t) {
         box_of_sheets(t, 6, at(2, 0, 0) * rotation_degrees(33, {1, 2, 3}) * scaling(0.7, 0.8, 0.9));
     }},
    {"TurnedBoxOfFiveRectangles", "open-glass",
     [](LintScene& t) {
         box_of_sheets(t, 5, at(2, 0, 0) * rotation_degrees(33, {1, 2, 3}) * scaling(0.7, 0.8, 0.9));
     }},
    {"BoxOfOneMeshInSixPlaces", "",
     [](LintScene& t) {
         const MaterialId m = t.material(glass());
         const auto shape = add<ShapeId>(t.s.shapes, Shape(add<MeshId>(t.s.meshes, square())));
         for (const double degrees : {0.0, 90.0, 180.0, 270.0})
             t.s.instances.push_back({shape, m, at(2, 0, 0) * rotation_degrees(degrees, {0, 1, 0})});
         for (const double degrees : {90.0, 270.0})
             t.s.instances.push_back({shape, m, at(2, 0, 0) * rotation_degrees(degrees, {1, 0, 0})});
     }},
    {"TwoHalves", "", [](LintScene& t) { two_halves(t, 0); }},
    {"TwoHalvesThatDoNotTouch", "open-glass", [](LintScene& t) { two_halves(t, 1e-3); }},
    {"BoxWithASideOfTwoRectangles", "",
     [](LintScene& t) {
         const MaterialId m = box_of_sheets(t, 5, at(2, 0, 0));
         for (const float x : {-0.15f, 0.15f})
             t.place(Shape(Rectangle{{x, 0, 0.3f}, {0.15f, 0, 0}, {0, 0.3f, 0}}), m, at(2, 0, 0));
     }},
    {"PaneOfTwoRectangles", "open-glass",
     [](LintScene& t) {
         const MaterialId m = t.material(glass());
         for (const float x : {2.0f, 2.5f}) t.place(Shape(Rectangle{{x, 0, 0}, {0.25f, 0, 0}, {0, 0.5f, 0}}), m);
     }},
    {"LakeOfTwoRectangles", "",
     [](LintScene& t) {
         const MaterialId m = t.material(glass());
         for (const float x : {2.0f, 2.5f}) t.place(Shape(Rectangle{{x, 0, 0}, {0.25f, 0, 0}, {0, 0, -0.5f}}), m);
     }},
    {"SeamWithoutSharedVertices", "",
     [](LintScene& t) {
         // The middle of one side of a face is a vertex on one of its sides only.
         Mesh m = cube(0.5f);
         m.positions.push_back({0, -0.5f, -0.5f});
         m.indices[24] = 0, m.indices[25] = 2, m.indices[26] = 3, m.indices[27] = 0, m.indices[28] = 3,
         m.indices[29] = 8;
         m.indices.insert(m.indices.end(), {8, 3, 1});
         t.place(m, t.material(glass()), at(2, 0, 0));
     }},
    {"WindowPane", "open-glass",
     [](LintScene& t) {
         t.place(Shape(Rectangle{{2, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}}), t.material(glass()));
     }},
    {"Lake", "",
     [](LintScene& t) {
         t.place(Shape(Rectangle{{0, -2, 0}, {3, 0, 0}, {0, 0, -3}}), t.material(glass()));
     }},
    {"LakeThatFacesDown", "",
     [](LintScene& t) {
         t.place(Shape(Rectangle{{0, -2, 0}, {3, 0, 0}, {0, 0, 3}}), t.material(glass()));
     }},
    {"PaneInAVastFloor", "open-glass",
     [](LintScene& t) {
         t.place(Shape(Rectangle{{2, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}}), t.material(glass()));
         t.place(Shape(Rectangle{{0, -0.5f, 0}, {9e14f, 0, 0}, {0, 0, -9e14f}}), MaterialId{0});
     }},
    {"ShelfOfTwoRectangles", "open-glass",
     [](LintScene& t) {
         const MaterialId m = t.material(glass());
         t.place(Shape(Rectangle{{2, 0, 0}, {0.5f, 0, 0}, {0, 0, -0.5f}}), m);
         t.place(Shape(Rectangle{{2, 0.5f, -0.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}}), m);
     }},
    {"WavyLake", "",
     [](LintScene& t) {
         t.place(Mesh{{{-1, -2, -1}, {1, -1.9f, -1}, {0, -2, 1}}, {}, {}, {0, 2, 1}}, t.material(glass()));
     }},
    {"GlassInsideOut", "inverted-normals",
     [](LintScene& t) { t.place(inside_out(cube(0.5f)), t.material(glass()), at(2, 0, 0)); }},
    {"OneOfTwoPartsInsideOut", "inverted-normals",
     [](LintScene& t) {
         t.place(joined(cube(0.5f), inside_out(box({0.6f, 0, 0}, {0.7f, 0.1f, 0.1f}))), t.material(glass()),
                 at(2, 0, 0));
     }},
    {"HollowGlass", "",
     [](LintScene& t) { t.place(joined(cube(0.5f), inside_out(cube(0.4f))), t.material(glass()), at(2, 0, 0)); }},
    {"BubbleInGlass", "",
     [](LintScene& t) {
         const MaterialId m = t.material(glass());
         t.place(cube(0.5f), m, at(2, 0, 0)), t.place(inside_out(cube(0.4f)), m, at(2, 0, 0));
     }},
    {"MirroredGlass", "",
     [](LintScene& t) { t.place(cube(0.5f), t.material(glass()), at(2, 0, 0) * scaling(-1, 1, 1)); }},
    {"GlassWoundBothWays", "inverted-normals",
     [](LintScene& t) {
         Mesh m = cube(0.5f);
         std::swap(m.indices[0], m.indices[1]);
         t.place(m, t.material(glass()), at(2, 0, 0));
     }},
    {"TwoSidedInsideOut", "", [](LintScene& t) { t.place(inside_out(cube(0.5f)), MaterialId{0}, at(2, 0, 0)); }},
    {"OneSidedInsideOut", "inverted-normals",
     [](LintScene& t) { t.place(inside_out(cube(0.5f)), t.grey(false), at(2, 0, 0)); }},
    {"OneSided", "", [](LintScene& t) { t.place(cube(0.5f), t.grey(false), at(2, 0, 0)); }},
    {"OneSidedRoom", "",
     [](LintScene& t) {
         t.place(inside_out(cube(9)), t.grey(false)), t.s.lights[0] = PointLight{{2, 2, 2}};
     }},
    {"OneSidedRoomOutwards", "inverted-normals",
     [](LintScene& t) {
         t.place(cube(9), t.grey(false)), t.s.lights[0] = PointLight{{2, 2, 2}};
     }},
    {"LampInsideOut", "inverted-normals",
     [](LintScene& t) {
         t.s.lights.push_back(AreaLight{t.place(inside_out(cube(0.2f)), MaterialId{0}, at(2, 0, 0))});
     }},
    {"LampInsideOutThatShinesBothWays", "",
     [](LintScene& t) {
         t.s.lights.push_back(AreaLight{t.place(inside_out(cube(0.2f)), MaterialId{0}, at(2, 0, 0)), {1, 1, 1}, true});
     }},
    {"NormalsOnTheOtherSide", "inverted-normals",
     [](LintScene& t) {
         Mesh m = triangle();
         m.normals.assign(3, {0, 0, -1});
         t.place(m, MaterialId{0}, at(2, 0, 0));
     }},
    {"NormalsOfOneTriangleOfThreeOnTheOtherSide", "",
     [](LintScene& t) {
         Mesh m = joined(joined(triangle(), triangle()), triangle());
         m.normals.assign(9, {0, 0, 1});
         for (size_t i = 0; i < 3; ++i) m.normals[i].z = -1;
         for (size_t i = 3; i < 9; ++i) m.positions[i].z += float(i / 3);
         t.place(m, MaterialId{0}, at(2, 0, 0));
     }},
};

const Case kWorldCases[] = {
    {"NoLight", "no-light", [](LintScene& t) { t.s.lights.clear(); }},
    {"NoLightNeeded", "", [](LintScene& t) { t.s.lights.clear(), t.settings.integrator = IntegratorKind::normals; }},
    {"LightOfAMaterial", "",
     [](LintScene& t) {
         OpenPbrMaterial m;
         m.emission_luminance = 1;
         t.s.lights.clear(), t.place(Shape(Sphere{{2, 0, 0}, 0.1f}), t.material(m));
     }},
    {"DarkLight", "dark-light",
     [](LintScene& t) {
         t.s.lights.push_back(PointLight{{5, 5, 5}, {0, 0, 0}});
     }},
    {"DimLight", "",
     [](LintScene& t) {
         t.s.lights.push_back(PointLight{{5, 5, 5}, {0, 0, 1e-9f}});
     }},
    {"BlackEmissionTexture", "dark-light",
     [](LintScene& t) {
         t.s.lights.push_back(AreaLight{
             InstanceId{0}, {5, 5, 5}, false, 1, true, t.texture(t.bytes({0, 0, 0, 0, 0, 0}), ColorSpace::srgb)});
     }},
    {"AlmostBlackEmissionTexture", "",
     [](LintScene& t) {
         t.s.lights.push_back(AreaLight{
             InstanceId{0}, {5, 5, 5}, false, 1, true, t.texture(t.bytes({0, 0, 0, 0, 0, 1}), ColorSpace::srgb)});
     }},
    {"LightInABox", "light-in-wall",
     [](LintScene& t) {
         t.place(cube(0.5f), MaterialId{0}, at(2, 0, 0)), t.s.lights.push_back(PointLight{{2.4f, 0, 0}});
     }},
    {"LightBesideABox", "",
     [](LintScene& t) {
         t.place(cube(0.5f), MaterialId{0}, at(2, 0, 0)), t.s.lights.push_back(PointLight{{2.6f, 0, 0}});
     }},
    {"LightInAnOpenBox", "",
     [](LintScene& t) {
         t.place(without_last_triangles(cube(0.5f), 1), MaterialId{0}, at(2, 0, 0));
         t.s.lights.push_back(PointLight{{2.4f, 0, 0}});
     }},
    {"LightInGlass", "",
     [](LintScene& t) {
         t.place(cube(0.5f), t.material(glass()), at(2, 0, 0)), t.s.lights.push_back(PointLight{{2.4f, 0, 0}});
     }},
    {"LightInAHalfTransparentBox", "",
     [](LintScene& t) {
         OpenPbrMaterial m;
         m.geometry_opacity = {0.5f};
         t.place(cube(0.5f), t.material(m), at(2, 0, 0)), t.s.lights.push_back(PointLight{{2.4f, 0, 0}});
     }},
    {"SpotInASphere", "light-in-wall",
     [](LintScene& t) {
         t.s.lights.push_back(SpotLight{{0, 0.5f, 0}});
     }},
    {"LampInASphere", "light-in-wall",
     [](LintScene& t) {
         t.s.lights.push_back(AreaLight{t.place(Shape(Sphere{{0, 0, 0}, 0.2f}), MaterialId{0})});
     }},
    {"LampHalfInASphere", "",
     [](LintScene& t) {
         t.s.lights.push_back(AreaLight{t.place(Shape(Sphere{{0, 1, 0}, 0.2f}), MaterialId{0})});
     }},
    {"LightInTheWallOfARoom", "light-in-wall",
     [](LintScene& t) {
         t.place(joined(cube(9), inside_out(cube(8))), MaterialId{0});
         t.s.lights[0] = PointLight{{2, 2, 2}}, t.s.lights.push_back(PointLight{{8.5f, 0, 0}});
     }},
    {"LightInARoom", "",
     [](LintScene& t) {
         t.place(cube(9), MaterialId{0}), t.s.lights[0] = PointLight{{2, 2, 2}};
     }},
    {"Giant", "scale",
     [](LintScene& t) { t.place(without_last_triangles(scaled(cube(1), 1800), 1), MaterialId{0}, at(0, 1800, 0)); }},
    {"LargeThing", "", [](LintScene& t) { t.place(scaled(cube(1), 400), MaterialId{0}, at(0, 401.5, 0)); }},
    {"Ground", "",
     [](LintScene& t) {
         t.place(box({-5000, -2, -5000}, {5000, -1.5f, 5000}), MaterialId{0});
     }},
    {"Dome", "",
     [](LintScene& t) {
         t.place(Shape(Sphere{{0, 0, 0}, 5000}), MaterialId{0}), t.s.lights[0] = PointLight{{2, 2, 2}};
     }},
    {"DomeOfTriangles", "",
     [](LintScene& t) {
         t.place(cube(5000), MaterialId{0}), t.s.lights[0] = PointLight{{2, 2, 2}};
     }},
    {"CameraFarAway", "scale",
     [](LintScene& t) {
         t.s.cameras = {PerspectiveCamera{{0, 0, 9000}}};
     }},
    {"CameraAway", "",
     [](LintScene& t) {
         t.s.cameras = {PerspectiveCamera{{0, 0, 200}}};
     }},
    {"FarFromItsOrigin", "precision",
     [](LintScene& t) {
         Mesh m = cube(1);
         for (Vec3& p : m.positions) p = p + Vec3{500000, 0, 0};
         t.place(m, MaterialId{0}, at(-500002.5, 0, 0));
     }},
    {"NotSoFarFromItsOrigin", "",
     [](LintScene& t) {
         Mesh m = cube(1);
         for (Vec3& p : m.positions) p = p + Vec3{5000, 0, 0};
         t.place(m, MaterialId{0}, at(-5002.5, 0, 0));
     }},
    {"CameraInABall", "camera-in-wall",
     [](LintScene& t) {
         t.s.cameras = {PerspectiveCamera{{0, 0, 0.5f}}};
     }},
    {"CameraInAMesh", "camera-in-wall", [](LintScene& t) { t.place(cube(2), MaterialId{0}, at(0, 0, 6)); }},
    {"CameraInAGlassBall", "",
     [](LintScene& t) {
         wear(t, glass()), t.s.cameras = {PerspectiveCamera{{0, 0, 0.5f}}};
     }},
    {"CameraInALamp", "",
     [](LintScene& t) {
         t.s.cameras = {PerspectiveCamera{{0, 0, 0.5f}}};
         t.s.lights.push_back(AreaLight{InstanceId{0}, {1, 1, 1}, true});
     }},
    {"CameraTurnedAway", "empty-view",
     [](LintScene& t) {
         t.s.cameras = {PerspectiveCamera{{0, 0, 6}, {0, 0, 9}}};
     }},
    {"CameraThatLooksBeside", "empty-view",
     [](LintScene& t) {
         t.s.cameras = {PerspectiveCamera{{0, 0, 6}, {9, 0, 0}}};
     }},
    {"CameraThatSeesTheRim", "",
     [](LintScene& t) {
         t.s.cameras = {PerspectiveCamera{{0, 0, 6}, {3, 0, 0}}};
     }},
    {"ParallelCameraBeside", "empty-view",
     [](LintScene& t) {
         t.s.cameras = {OrthographicCamera{{9, 0, 6}, {9, 0, 0}}};
     }},
    {"ParallelCamera", "",
     [](LintScene& t) {
         t.s.cameras = {OrthographicCamera{{1.5f, 0, 6}, {1.5f, 0, 0}}};
     }},
    {"PanoramaTurnedAway", "",
     [](LintScene& t) {
         t.s.cameras = {PanoramaCamera{{0, 0, 6}, {0, 0, 9}}};
     }},
    {"NothingButSky", "",
     [](LintScene& t) { t.s.instances.clear(), t.s.shapes.clear(), t.s.materials.clear(), t.s.textures.clear(); }},
};

TEST_P(Rules, FindNothingElse) { expect_findings(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Mesh, Rules, testing::ValuesIn(kMeshCases), name_of_case);
INSTANTIATE_TEST_SUITE_P(World, Rules, testing::ValuesIn(kWorldCases), name_of_case);

/// A sheet is not closed by its own copy, nor by one that nearly touches; each is a finding of its own.
TEST(OpenGlass, SheetsThatCloseNothing) {
    LintScene twice;
    const MaterialId m = twice.material(glass());
    for (int k = 0; k < 2; ++k) twice.place(Shape(Rectangle{{2, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}}), m);
    EXPECT_EQ(twice.rules()["open-glass"], 1);
    LintScene mesh;
    for (int k = 0; k < 2; ++k)
        mesh.place(Shape(MeshId{0}), mesh.s.materials.size() > 1 ? MaterialId{1} : mesh.material(glass()));
    mesh.s.meshes = {without_last_triangles(cube(0.5f), 2)};
    EXPECT_EQ(mesh.rules()["open-glass"], 1);
    LintScene apart;
    box_of_sheets(apart, 4, at(2, 0, 0));
    for (Instance& i : apart.s.instances) i.world_from_object.m[0][3] += index(i.shape) == 1 ? 1e-4 : 0;
    EXPECT_EQ(apart.rules()["open-glass"], 2);  // the side that was moved, and the other three
}

TEST(OpenGlass, SaysWhatBelongsTogether) {
    LintScene t;
    box_of_sheets(t, 5, at(2, 0, 0));
    const LintReport report = t.lint();
    ASSERT_EQ(report.findings.size(), 1u);
    const std::string& message = report.findings[0].message;
    EXPECT_NE(message.find("object 1 and 4 other pieces of solid glass"), std::string::npos) << message;
    EXPECT_NE(message.find("are open: 1 hole with 4 edges"), std::string::npos) << message;
    EXPECT_NE(message.find("0.3"), std::string::npos) << message;
}

/// "not-honoured" and "input" are for what readers say, tests/lint/files_test.cpp; more are in overlap_test.cpp.
TEST(RuleTable, EachRuleHasAScene) {
    std::set<std::string_view> tried{"not-honoured",       "input", "no-effect", "", "overlapping-surfaces",
                                     "duplicate-triangles"},
        known{""};
    for (const Case& c : material_cases()) tried.insert(c.rule);
    for (const Case& c : kMeshCases) tried.insert(c.rule);
    for (const Case& c : kWorldCases) tried.insert(c.rule);
    for (const LintRule& rule : lint_rules()) known.insert(rule.name);
    EXPECT_EQ(tried, known);
}

}  // namespace
}  // namespace steradian::test
