// Transforms: their vocabulary and their order.
#include <cmath>

#include "formats/scene_test.h"
#include "math/transform.h"

namespace steradian::test {
namespace {

Affine transform_of(std::string_view transform) {
    return load_good(scene_with_object("{\"type\": \"sphere\", \"transform\": " + std::string(transform) + "}"))
        .scene.instances.at(0)
        .world_from_object;
}

void expect_maps(const Affine& a, Vec3d from, Vec3d to) {
    const Vec3d got = transform_point(a, from);
    EXPECT_NEAR(got.x, to.x, 1e-12);
    EXPECT_NEAR(got.y, to.y, 1e-12);
    EXPECT_NEAR(got.z, to.z, 1e-12);
}

TEST(SceneTransform, SingleSteps) {
    EXPECT_EQ(transform_of("[]"), Affine{});
    EXPECT_EQ(transform_of("{}"), Affine{});
    EXPECT_EQ(transform_of(R"([{"translate": [1, 2, 3]}])"), translation(1, 2, 3));
    EXPECT_EQ(transform_of(R"([{"scale": 2}])"), scaling(2, 2, 2));
    EXPECT_EQ(transform_of(R"([{"scale": [1, -2, 3]}])"), scaling(1, -2, 3));
    EXPECT_EQ(transform_of(R"([{"rotate": {"axis": [0, 2, 0], "angle": 30}}])"), rotation_degrees(30, {0, 1, 0}));
    // Counter-clockwise seen from the tip of +Y: +Z goes to +X.
    expect_maps(transform_of(R"({"rotate": {"axis": [0, 1, 0], "angle": 90}})"), {0, 0, 1}, {1, 0, 0});
}

TEST(SceneTransform, StepsOfAListAreAppliedInTheirOrder) {
    // First moved, then turned about the origin: the object ends on -Z.
    expect_maps(transform_of(R"([{"translate": [1, 0, 0]}, {"rotate": {"axis": [0, 1, 0], "angle": 90}}])"), {0, 0, 0},
                {0, 0, -1});
    // First turned in place, then moved.
    expect_maps(transform_of(R"([{"rotate": {"axis": [0, 1, 0], "angle": 90}}, {"translate": [1, 0, 0]}])"), {0, 0, 0},
                {1, 0, 0});
    expect_maps(transform_of(R"([{"scale": 2}, {"translate": [1, 0, 0]}, {"scale": [3, 1, 1]}])"), {1, 1, 1},
                {9, 2, 2});
}

TEST(SceneTransform, KeysOfAnObjectAreAppliedInTheirOrder) {
    expect_maps(transform_of(R"({"translate": [1, 0, 0], "rotate": {"axis": [0, 1, 0], "angle": 90}})"), {0, 0, 0},
                {0, 0, -1});
    expect_maps(transform_of(R"({"rotate": {"axis": [0, 1, 0], "angle": 90}, "translate": [1, 0, 0]})"), {0, 0, 0},
                {1, 0, 0});
    expect_maps(transform_of(R"([{"scale": 2, "translate": [1, 0, 0]}, {"scale": 10}])"), {1, 0, 0}, {30, 0, 0});
}

TEST(SceneTransform, Matrices) {
    Affine expected;
    expected.m = {{{1, 2, 3, 4}, {0, 1, 5, 6}, {0, 0, 1, 7}}};
    EXPECT_EQ(transform_of("{\"matrix\": [[1,2,3,4],[0,1,5,6],[0,0,1,7],[0,0,0,1]]}"), expected);
    EXPECT_EQ(transform_of("{\"matrix\": [[1,2,3,4],[0,1,5,6],[0,0,1,7]]}"), expected);
    EXPECT_EQ(transform_of("[[1,2,3,4],[0,1,5,6],[0,0,1,7],[0,0,0,1]]"), expected);
    for (auto& row : expected.m) row[3] = 0;
    EXPECT_EQ(transform_of("{\"matrix\": [[1,2,3],[0,1,5],[0,0,1]]}"), expected);
}

TEST(SceneTransform, LookAtTurnsThePlusZAxisToTheTarget) {
    const Affine a = transform_of(R"({"look_at": {"origin": [1, 2, 3], "target": [4, 2, 3]}})");
    expect_maps(a, {0, 0, 0}, {1, 2, 3});
    expect_maps(a, {0, 0, 1}, {2, 2, 3});
    expect_maps(a, {0, 1, 0}, {1, 3, 3});
    EXPECT_NEAR(determinant(a), 1, 1e-12);
    const Affine tilted = transform_of(R"({"look_at": {"origin": [0, 0, 0], "target": [0, -3, 4], "up": [1, 0, 0]}})");
    expect_maps(tilted, {0, 0, 5}, {0, -3, 4});
    expect_maps(tilted, {0, 1, 0}, {1, 0, 0});
    EXPECT_NEAR(determinant(tilted), 1, 1e-12);
}

TEST(SceneTransform, WhatCannotBeATransformIsRefused) {
    const auto refused = [](std::string_view transform, std::string_view message) {
        expect_error(scene_with_object("{\"type\": \"sphere\", \"transform\": " + std::string(transform) + "}"),
                     message);
    };
    refused("§3", "'transform' must be a list of steps, an object or a matrix, got 3");
    refused("[§5]", "a step of 'transform' must be an object, got 5");
    refused("[{§\"turn\": 5}]", "unknown key 'turn' in a step of 'transform'");
    refused("{\"translate\": §[1, 2]}", "'translate' must be an array of 3, got an array of 2");
    refused("{\"translate\": [1, §\"2\", 3]}", "'translate' must be a number, got the string \"2\"");
    refused("{\"rotate\": §90}", "'rotate' must be an object, got 90");
    refused("{\"rotate\": §{\"angle\": 90}}", "missing key 'axis' in 'rotate'");
    refused("{\"rotate\": §{\"axis\": [0, 1, 0]}}", "missing key 'angle' in 'rotate'");
    refused("{\"rotate\": {\"axis\": §[0, 0, 0], \"angle\": 90}}", "must not be the zero vector");
    refused("{\"rotate\": {\"axis\": [0, 1, 0], \"angle\": 90, §\"unit\": \"deg\"}}", "unknown key 'unit' in 'rotate'");
    refused("{\"scale\": §0}", "'scale' must not be 0");
    refused("{\"scale\": §[1, 0, 1]}", "'scale' must not be 0");
    refused("{\"scale\": §[1, 1]}", "'scale' must be a number or an array of 3 numbers, got an array of 2");
    refused("{\"matrix\": §[[1, 0], [0, 1]]}", "'matrix' must be an array of 3 or 4, got an array of 2");
    refused("{\"matrix\": [[1, 0, 0], §[0, 1, 0, 0], [0, 0, 1]]}",
            "a row of 'matrix' must be an array of 3, got an array of 4");
    refused("{\"matrix\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], §[0, 0, 0]]}",
            "a row of 'matrix' must be an array of 4");
    refused("{\"matrix\": [§[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]]}", "a row of 'matrix' must be an array of 4");
    refused("{\"matrix\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, §0.5, 1]]}",
            "projections are not transforms");
    refused("§{\"matrix\": [[1, 0, 0], [2, 0, 0], [0, 0, 1]]}", "flattens the object");
    refused("§[[1, 0, 0], [1, 0, 0], [0, 0, 1]]", "flattens the object");
    refused("§{\"scale\": 1e-120}", "flattens the object");
    refused("§[{\"scale\": 1e15}, {\"scale\": 1e15}, {\"scale\": 10}]", "at most by 1e30");
    refused("§[{\"scale\": 1e-15}, {\"scale\": 1e-15}, {\"scale\": 0.1}]", "at least by 1e-30");
    EXPECT_EQ(transform_of(R"([{"scale": 1e15}, {"scale": 1e-15}, {"scale": 10}])"), scaling(10, 10, 10));
    refused("{\"look_at\": §{\"origin\": [0, 0, 0]}}", "missing key 'target' in 'look_at'");
    refused("{\"look_at\": {\"origin\": [0, 0, 1], \"target\": §[0, 0, 1]}}", "'target' is equal to 'origin'");
    refused("{\"look_at\": §{\"origin\": [0, 0, 0], \"target\": [0, 1, 0]}}", "'up' must not be zero or parallel");
    refused("{\"look_at\": {\"origin\": [0, 0, 0], \"target\": [0, 0, 1], \"up\": §[0, 0, 0]}}",
            "'up' must not be zero or parallel");
}

}  // namespace
}  // namespace steradian::test
