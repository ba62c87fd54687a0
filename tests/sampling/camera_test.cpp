#include "shading/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/hash.h"
#include "support/chi_square.h"
#include "support/random.h"

namespace steradian {
namespace {

using test::chi_square;
using test::ChiSquare;
using test::Random;

CameraSampler make(const PerspectiveCamera& camera, uint32_t width, uint32_t height) {
    auto result = CameraSampler::make(camera, width, height);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().str());
    return result.value();
}

PerspectiveCamera looking_down_z(float fov = 90) {
    PerspectiveCamera c;
    c.vertical_fov = fov;
    return c;
}

Vec3 direction(const CameraSampler& camera, float x, float y) { return camera.generate({x, y}).d; }

void expect_near(Vec3 a, Vec3d b, double tolerance = 1e-7) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

TEST(Camera, CentreRayLooksAtTheTarget) {
    PerspectiveCamera c;
    c.position = {1, 2, 3};
    c.look_at = {4, -2, 15};
    const CameraSampler camera = make(c, 640, 480);
    const Ray ray = camera.generate({320, 240});
    EXPECT_EQ(ray.o, c.position);
    expect_near(ray.d, Vec3d(3.0 / 13, -4.0 / 13, 12.0 / 13));
    EXPECT_EQ(ray.tmin, 0);
    EXPECT_EQ(ray.tmax, kInfinity);
}

TEST(Camera, LooksDownMinusZWithXToTheRightAndYUp) {
    const CameraSampler camera = make(looking_down_z(), 200, 100);
    expect_near(direction(camera, 100, 50), Vec3d(0, 0, -1));
    const Vec3 top_left = direction(camera, 0, 0), bottom_right = direction(camera, 200, 100);
    const double s = 1 / std::sqrt(1 + 4 + 1.0);  // 90 degrees high, twice as wide
    expect_near(top_left, Vec3d(-2 * s, s, -s));
    expect_near(bottom_right, Vec3d(2 * s, -s, -s));
    EXPECT_GT(direction(camera, 150, 50).x, 0);
    EXPECT_GT(direction(camera, 100, 20).y, 0);
}

TEST(Camera, VerticalFieldOfViewIsBetweenTopAndBottom) {
    for (const float fov : {0.01f, 1.0f, 19.5f, 40.0f, 90.0f, 170.0f, 179.9f})
        for (const uint32_t width : {1u, 100u, 3000u}) {
            const CameraSampler camera = make(looking_down_z(fov), width, 100);
            const float middle = static_cast<float>(width) / 2;
            const Vec3 top = direction(camera, middle, 0), bottom = direction(camera, middle, 100);
            const double angle = 2 * std::atan2(std::sqrt(static_cast<double>(length_squared(top - bottom))),
                                                std::sqrt(static_cast<double>(length_squared(top + bottom))));
            EXPECT_NEAR(angle * 180 / std::numbers::pi / fov, 1, 2e-5) << fov;
        }
}

TEST(Camera, PixelsAreSquareWhateverTheAspect) {
    for (const uint32_t width : {50u, 100u, 333u}) {
        const CameraSampler camera = make(looking_down_z(60), width, 100);
        const float middle = static_cast<float>(width) / 2;
        const Vec3 right = direction(camera, middle + 10, 50), up = direction(camera, middle, 40);
        EXPECT_NEAR(right.x, up.y, 1e-7);
        EXPECT_NEAR(right.x / -right.z, std::tan(std::numbers::pi / 6) * 10 / 50, 1e-7);
    }
}

TEST(Camera, UpIsMadePerpendicularAndNeedNotBeUnitLength) {
    PerspectiveCamera c = looking_down_z();
    c.up = {0, 5, 3};
    expect_near(direction(make(c, 100, 100), 0, 0),
                Vec3d(-1 / std::sqrt(3.0), 1 / std::sqrt(3.0), -1 / std::sqrt(3.0)));
    c.up = {1e-30f, 0, 0};  // rolled: the picture's up is +X, so its right is -Y
    const Vec3 right = direction(make(c, 100, 100), 100, 50);
    expect_near(right, Vec3d(0, -1 / std::sqrt(2.0), -1 / std::sqrt(2.0)));
}

TEST(Camera, FrameIsRightHandedInEveryDirection) {
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        PerspectiveCamera c;
        for (int axis = 0; axis < 3; ++axis) {
            c.position[axis] = static_cast<float>(random.between(-10, 10));
            c.look_at[axis] = static_cast<float>(random.between(-10, 10));
            c.up[axis] = static_cast<float>(random.between(-1, 1));
        }
        const CameraSampler camera = make(c, 64, 64);
        const Vec3 forward = direction(camera, 32, 32);
        const Vec3 right = direction(camera, 64, 32) - direction(camera, 0, 32);
        const Vec3 up = direction(camera, 32, 0) - direction(camera, 32, 64);
        EXPECT_GT(dot(cross(right, up), -forward), 0);
        EXPECT_GE(dot(up, c.up), 0);
        EXPECT_NEAR(dot(right, c.up), 0, 1e-5);
        EXPECT_NEAR(dot(right, forward), 0, 1e-6);
        EXPECT_NEAR(length(direction(camera, 3, 60)), 1, 2e-7);
    }
}

TEST(Camera, RaysDoNotDependOnTheRestOfThePicture) {
    // A ray is a function of its place on the film of the full picture; a finer picture has the same ray at the same
    // place.
    const CameraSampler coarse = make(looking_down_z(37), 320, 200), fine = make(looking_down_z(37), 1280, 800);
    for (float y = 0.25f; y < 200; y += 13)
        for (float x = 0.25f; x < 320; x += 17) {
            const Vec3 a = direction(coarse, x, y), b = direction(fine, 4 * x, 4 * y);
            expect_near(a, Vec3d(b), 6e-8);
            EXPECT_EQ(a, direction(coarse, x, y));
        }
}

// A uniform film gives directions of density 1 / (A cos³θ), A the film's area at distance 1.
TEST(Camera, DirectionsHaveTheirDensity) {
    PerspectiveCamera c = looking_down_z(70);
    c.look_at = {0, 0, 1};
    const CameraSampler camera = make(c, 300, 200);
    const double half_height = std::tan(35 * std::numbers::pi / 180), half_width = 1.5 * half_height;
    const double area = 4 * half_height * half_width;
    Random random(2);
    const auto film_direction = [&](uint64_t) {
        const float x = random.unit_float() * 300;
        const float y = random.unit_float() * 200;
        return std::optional<Vec3>(direction(camera, x, y));
    };
    const auto density = [&](Vec3 v) {
        if (!(v.z > 0) || std::fabs(v.x) > half_width * v.z || std::fabs(v.y) > half_height * v.z) return 0.0;
        return 1 / (area * v.z * v.z * v.z);
    };
    const ChiSquare result = test::chi_square_directions(film_direction, density, 200'000, 8, 12);
    EXPECT_TRUE(result.passes()) << result;
}

TEST(Camera, FilmPlaneIsCoveredUniformly) {
    constexpr int kSide = 32, kCount = 400'000;
    const CameraSampler camera = make(looking_down_z(120), 64, 64);
    const double half = std::tan(60 * std::numbers::pi / 180);
    std::vector<double> observed(kSide * kSide), expected(kSide * kSide, double(kCount) / (kSide * kSide));
    Random random(3);
    for (int i = 0; i < kCount; ++i) {
        const float x = random.unit_float() * 64;
        const float y = random.unit_float() * 64;
        const Vec3 d = direction(camera, x, y);
        const auto bin = [&](double t) { return clamp_to(static_cast<int>((t / half + 1) / 2 * kSide), 0, kSide - 1); };
        const double row = static_cast<double>(d.y) / -d.z, column = static_cast<double>(d.x) / -d.z;
        ++observed[static_cast<size_t>(bin(row) * kSide + bin(column))];
    }
    const ChiSquare result = chi_square(observed, expected);
    EXPECT_TRUE(result.passes()) << result;
}

void expect_refused(const PerspectiveCamera& c, const char* word) {
    const auto result = CameraSampler::make(c, 16, 16);
    ASSERT_FALSE(result.ok()) << word;
    EXPECT_EQ(result.error().code, ErrorCode::bad_input);
    EXPECT_NE(result.error().message.find(word), std::string::npos) << result.error().message;
}

TEST(Camera, DegenerateOnesAreRefused) {
    const PerspectiveCamera good = looking_down_z();
    for (const float fov : {0.0f, -10.0f, 180.0f, 300.0f}) expect_refused(looking_down_z(fov), "field of view");
    expect_refused(looking_down_z(NAN), "finite");
    PerspectiveCamera c = good;
    c.look_at = c.position = {3, 4, 5};
    expect_refused(c, "point that it looks at");
    c = good;
    c.up = {0, 0, 0};
    expect_refused(c, "zero");
    for (const float z : {1.0f, -2.0f}) {
        c = good;
        c.up = {0, 0, z};
        expect_refused(c, "parallel");
        c.up = {1e-8f, 0, z};
        expect_refused(c, "parallel");
    }
    for (Vec3 PerspectiveCamera::*member :
         {&PerspectiveCamera::position, &PerspectiveCamera::look_at, &PerspectiveCamera::up})
        for (const float bad : {NAN, kInfinity, -kInfinity}) {
            c = good;
            (c.*member).y = bad;
            expect_refused(c, "finite");
        }
    EXPECT_FALSE(CameraSampler::make(good, 0, 16).ok());
    EXPECT_FALSE(CameraSampler::make(good, 16, 0).ok());
}

TEST(CameraBits, AreWhatTheyWere) {
    PerspectiveCamera c;
    c.position = {0, 1, 6.8f};
    c.look_at = {0.3f, 1, 0};
    c.vertical_fov = 19.5f;
    const CameraSampler camera = make(c, 640, 360);
    Hasher hasher;
    for (float y = 0.1f; y < 360; y += 3.3f)
        for (float x = 0.1f; x < 640; x += 3.7f) {
            const Vec3 d = direction(camera, x, y);
            for (int axis = 0; axis < 3; ++axis) hasher.value(d[axis]);
        }
    EXPECT_EQ(hasher.hex(), "32181f8660044b9d8f176eeede067913");
}

TEST(Camera, ExtremePlacesAreFine) {
    PerspectiveCamera c;
    c.position = {1e15f, -1e15f, 1e15f};
    c.look_at = {-1e15f, 1e15f, 1e15f};
    expect_near(direction(make(c, 10, 10), 5, 5), Vec3d(-1 / std::sqrt(2.0), 1 / std::sqrt(2.0), 0));
    c.position = {0, 0, 0};
    c.look_at = {0, 0, -1e-30f};
    expect_near(direction(make(c, 10, 10), 5, 5), Vec3d(0, 0, -1));
    const CameraSampler large = make(looking_down_z(), 1u << 20, 1u << 20);
    EXPECT_NE(direction(large, 1000.5f, 7), direction(large, 1001.5f, 7));
}

}  // namespace
}  // namespace steradian
