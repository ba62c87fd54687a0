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

CameraSampler make(const Camera& camera, uint32_t width, uint32_t height) {
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

void expect_refused(const Camera& c, const char* word) {
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

// --- Lenses ----------------------------------------------------------------------------------------------------------

PerspectiveCamera lens(float radius, float focus, uint32_t blades = 0) {
    PerspectiveCamera c = looking_down_z(50);
    c.position = {1, 2, 3};
    c.look_at = {4, -2, 15};  // 13 m away
    c.aperture_radius = radius;
    c.focus_distance = focus;
    c.aperture_blades = blades;
    return c;
}

Vec2 random_point(Random& random) {
    Vec2 u;
    u.x = random.unit_float(), u.y = random.unit_float();
    return u;
}

/// Where a ray is when it is `depth` metres in front of the camera.
Vec3d at_depth(const Ray& ray, const PerspectiveCamera& c, double depth) {
    const Vec3d forward = normalize(Vec3d(c.look_at) - Vec3d(c.position));
    const double start = dot(Vec3d(ray.o) - Vec3d(c.position), forward);
    return Vec3d(ray.o) + Vec3d(ray.d) * ((depth - start) / dot(Vec3d(ray.d), forward));
}

TEST(Lens, RaysThroughOneFilmPointMeetInThePlaneOfFocusWhereThePinholeSeesIt) {
    Random random(4);
    for (const uint32_t blades : {0u, 5u}) {
        const PerspectiveCamera c = lens(0.4f, 6, blades);
        PerspectiveCamera pinhole = c;
        pinhole.aperture_radius = 0;
        const CameraSampler camera = make(c, 100, 80), sharp = make(pinhole, 100, 80);
        EXPECT_TRUE(camera.has_lens());
        EXPECT_FALSE(sharp.has_lens());
        for (int i = 0; i < 1000; ++i) {
            const Vec2 film{static_cast<float>(random.between(0, 100)), static_cast<float>(random.between(0, 80))};
            const Vec3d expected = at_depth(sharp.generate(film), c, 6);
            const Ray ray = camera.generate(film, random_point(random));
            EXPECT_LT(length(at_depth(ray, c, 6) - expected), 5e-6);
            EXPECT_NEAR(length(ray.d), 1, 2e-7);
            EXPECT_LE(length(Vec3d(ray.o) - Vec3d(c.position)), 0.4f + 1e-6);
        }
    }
}

/// A point at distance d is seen from the whole lens; the film positions that see it are those whose place in the plane
/// of focus is within r |d - f| / d. Here from the other side: rays of one film position spread over r |d - f| / f at
/// d.
TEST(Lens, SpreadsByTheCircleOfConfusion) {
    Random random(5);
    const PerspectiveCamera c = lens(0.5f, 4);
    const CameraSampler camera = make(c, 64, 64);
    for (const double d : {1.0, 2.0, 3.9, 4.2, 8.0, 400.0}) {
        const double radius = 0.5 * std::fabs(d - 4) / 4;
        const Vec3d middle = at_depth(camera.generate({40, 20}, {0.5f, 0.5f}), c, d);
        double largest = 0;
        for (int i = 0; i < 20'000; ++i)
            largest =
                std::max(largest, length(at_depth(camera.generate({40, 20}, random_point(random)), c, d) - middle));
        // Of 20 000 uniform points on a disk the outermost is within 0.1 % of the edge, but for a chance of e^-40.
        EXPECT_NEAR(largest / radius, 0.9995, 0.0006) << d;
    }
}

TEST(Lens, WithoutAFocusDistanceLookAtIsSharp) {
    PerspectiveCamera c = lens(1, 1);
    c.focus_distance.reset();
    const CameraSampler camera = make(c, 64, 64);
    Random random(6);
    for (int i = 0; i < 100; ++i)
        EXPECT_LT(length(at_depth(camera.generate({32, 32}, random_point(random)), c, 13) - Vec3d(c.look_at)), 1e-5);
}

TEST(Lens, IsCoveredUniformly) {
    for (const uint32_t blades : {0u, 6u}) {
        const PerspectiveCamera c = lens(0.5f, 4, blades);
        const CameraSampler camera = make(c, 64, 64);
        // In the lens' own axes: right is forward × up.
        const Vec3d forward = normalize(Vec3d(c.look_at) - Vec3d(c.position));
        const Vec3d right = normalize(cross(forward, Vec3d(0, 1, 0))), up = cross(right, forward);
        constexpr int kSide = 24, kCount = 300'000;
        std::vector<double> observed(kSide * kSide), expected(kSide * kSide);
        Random random(7);
        for (int i = 0; i < kCount; ++i) {
            const Vec3d o = Vec3d(camera.generate({10, 50}, random_point(random)).o) - Vec3d(c.position);
            EXPECT_NEAR(dot(o, forward), 0, 1e-6);
            const auto bin = [](double x) { return clamp_to(static_cast<int>((x + 1) / 2 * kSide), 0, kSide - 1); };
            ++observed[size_t(bin(dot(o, up) / 0.5) * kSide + bin(dot(o, right) / 0.5))];
        }
        // The share of the outline in each cell, by 200 × 200 points.
        const auto inside = [&](double x, double y) {
            if (blades == 0) return x * x + y * y < 1;
            for (uint32_t k = 0; k < blades; ++k) {
                const double middle = (k + 0.5) * 2 * std::numbers::pi / blades;
                if (x * std::cos(middle) + y * std::sin(middle) > std::cos(std::numbers::pi / blades)) return false;
            }
            return true;
        };
        constexpr int kFine = 200;
        double total = 0;
        for (int y = 0; y < kSide * kFine; ++y)
            for (int x = 0; x < kSide * kFine; ++x)
                if (inside((x + 0.5) * 2 / (kSide * kFine) - 1, (y + 0.5) * 2 / (kSide * kFine) - 1))
                    ++expected[size_t(y / kFine * kSide + x / kFine)], ++total;
        for (double& e : expected) e *= kCount / total;
        const ChiSquare result = chi_square(observed, expected);
        EXPECT_TRUE(result.passes()) << blades << " blades: " << result;
    }
}

TEST(Lens, TurnsCounterClockwiseInThePicture) {
    PerspectiveCamera c;
    c.aperture_radius = 1;
    c.aperture_blades = 3;
    const auto first_corner = [&](float rotation) {
        c.aperture_rotation = rotation;
        return make(c, 10, 10).generate({5, 5}, {kOneMinusEpsilon, 0.5f}).o;
    };
    expect_near(first_corner(0), Vec3d(1, 0, 0), 1e-6);
    expect_near(first_corner(90), Vec3d(0, 1, 0), 1e-6);
    expect_near(first_corner(30), Vec3d(std::sqrt(0.75), 0.5, 0), 1e-6);
}

// --- Other projections ---------------------------------------------------------------------------------------------

TEST(Orthographic, RaysAreParallelAndMagnifyByTheHeight) {
    OrthographicCamera c;
    c.position = {1, 2, 3};
    c.look_at = {1, 2, -5};
    c.height = 4;
    const CameraSampler camera = make(c, 200, 100);
    for (const Vec2 film : {Vec2{0, 0}, Vec2{100, 50}, Vec2{200, 100}, Vec2{30, 80}}) {
        const Ray ray = camera.generate(film);
        EXPECT_EQ(ray.d, (Vec3{0, 0, -1}));
        // 0.04 m a pixel, x to the right, y up.
        expect_near(ray.o, Vec3d(1 + (film.x - 100) * 0.04, 2 - (film.y - 50) * 0.04, 3), 1e-6);
    }
    EXPECT_NEAR(camera.depth_of({9, 9, -4}), 7, 1e-12);
}

/// Latitude and longitude of pixels against directions written by hand.
TEST(Panorama, DirectionsAreThoseOfTheTable) {
    PanoramaCamera c;  // looks down -Z
    const CameraSampler camera = make(c, 360, 180);
    const double s = std::sqrt(0.5);
    const std::pair<Vec2, Vec3d> table[] = {{{180, 90}, {0, 0, -1}},
                                            {{270, 90}, {1, 0, 0}},
                                            {{90, 90}, {-1, 0, 0}},
                                            {{0, 90}, {0, 0, 1}},
                                            {{360, 90}, {0, 0, 1}},
                                            {{180, 45}, {0, s, -s}},
                                            {{180, 135}, {0, -s, -s}},
                                            {{225, 90}, {s, 0, -s}},
                                            {{77, 0}, {0, 1, 0}},
                                            {{300, 180}, {0, -1, 0}},
                                            {{270, 30}, {0.5, std::sqrt(0.75), 0}},
                                            {{180, -30}, {0, std::sqrt(0.75), 0.5}}};  // over the pole
    for (const auto& [film, expected] : table) expect_near(camera.generate(film).d, expected);
    c.look_at = {5, 0, 0};
    const CameraSampler east = make(c, 360, 180);
    expect_near(east.generate({180, 90}).d, Vec3d(1, 0, 0));
    expect_near(east.generate({270, 90}).d, Vec3d(0, 0, 1));
    EXPECT_NEAR(east.depth_of({-3, 4, 0}), 5, 1e-12);
}

/// A uniform film has uniform latitudes and longitudes about the picture's up.
TEST(Panorama, CoversLatitudesAndLongitudesUniformly) {
    const CameraSampler camera = make(PanoramaCamera{{0, 0, 0}, {1, 2, 3}, {0, 0, 1}}, 400, 300);
    const Vec3d forward = normalize(Vec3d(1, 2, 3)), right = normalize(cross(forward, Vec3d(0, 0, 1)));
    const Vec3d up = cross(right, forward);
    constexpr int kRows = 20, kColumns = 30, kCount = 300'000;
    std::vector<double> observed(kRows * kColumns), expected(kRows * kColumns, double(kCount) / (kRows * kColumns));
    Random random(8);
    for (int i = 0; i < kCount; ++i) {
        const Vec2 u = random_point(random);
        const Vec3d d(camera.generate({u.x * 400, u.y * 300}).d);
        const double row = std::acos(clamp_to(dot(d, up), -1.0, 1.0)) / std::numbers::pi;
        const double column = std::atan2(dot(d, right), dot(d, forward)) / (2 * std::numbers::pi) + 0.5;
        const auto bin = [](double t, int bins) { return clamp_to(static_cast<int>(t * bins), 0, bins - 1); };
        ++observed[size_t(bin(row, kRows) * kColumns + bin(column, kColumns))];
    }
    const ChiSquare result = chi_square(observed, expected);
    EXPECT_TRUE(result.passes()) << result;
}

TEST(Fisheye, AnglesFollowTheProjection) {
    FisheyeCamera c;
    for (const float fov : {60.0f, 180.0f, 250.0f, 360.0f})
        for (const auto projection : {FisheyeProjection::equidistant, FisheyeProjection::equisolid}) {
            c.fov = fov;
            c.projection = projection;
            const CameraSampler camera = make(c, 300, 200);
            const double half = fov / 2 * std::numbers::pi / 180;
            for (double r = 0.05; r < 1; r += 0.1)
                for (double phi = 0; phi < 6; phi += 0.7) {
                    const Vec2 film{static_cast<float>(150 + 100 * r * std::cos(phi)),
                                    static_cast<float>(100 - 100 * r * std::sin(phi))};
                    EXPECT_TRUE(camera.sees(film));
                    const double theta =
                        projection == FisheyeProjection::equidistant ? r * half : 2 * std::asin(r * std::sin(half / 2));
                    expect_near(
                        camera.generate(film).d,
                        Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta)),
                        2e-6);
                }
            EXPECT_EQ(camera.generate({150, 100}).d, (Vec3{0, 0, -1}));
            EXPECT_TRUE(camera.sees({249.9f, 100}));
            EXPECT_FALSE(camera.sees({250.1f, 100}));
            EXPECT_FALSE(camera.sees({150, -0.1f}));
        }
    EXPECT_TRUE(make(looking_down_z(), 10, 10).sees({-3, 40}));
}

TEST(Fisheye, EquisolidPixelsHaveOneSolidAngle) {
    const CameraSampler camera =
        make(FisheyeCamera{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 220, FisheyeProjection::equisolid}, 100, 100);
    Random random(9);
    const auto sample = [&](uint64_t) -> std::optional<Vec3> {
        while (true) {
            const Vec2 u = random_point(random);
            const Vec2 film{u.x * 100, u.y * 100};
            if (camera.sees(film)) return camera.generate(film).d;
        }
    };
    const double cos_edge = std::cos(110 * std::numbers::pi / 180);
    const auto density = [&](Vec3 v) {
        return static_cast<double>(v.z) > cos_edge ? 1 / (2 * std::numbers::pi * (1 - cos_edge)) : 0.0;
    };
    const ChiSquare result = test::chi_square_directions(sample, density, 200'000, 9, 12);
    EXPECT_TRUE(result.passes()) << result;
}

TEST(Camera, DegenerateOnesOfOtherKindsAreRefused) {
    expect_refused(PanoramaCamera{{1, 1, 1}, {1, 1, 1}}, "point that it looks at");
    expect_refused(FisheyeCamera{{0, 0, 0}, {0, 1, 0}}, "parallel");
    for (const float bad : {0.0f, -1.0f, 360.5f, NAN})
        expect_refused(FisheyeCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, bad}, "field of view");
    for (const float bad : {0.0f, -1.0f, NAN, kInfinity})
        expect_refused(OrthographicCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, bad}, "height");
    expect_refused(lens(-1, 1), "aperture");
    expect_refused(lens(1, 0), "focus");
    expect_refused(lens(1, NAN), "finite");
    expect_refused(lens(1, 1, 2), "blades");
    expect_refused(lens(1, 1, 65), "blades");
}

TEST(CameraBits, OfOtherKindsAreWhatTheyWere) {
    const Vec3 from{0, 1, 6.8f}, to{0.3f, 1, 0}, up{0, 1, 0};
    const Camera cameras[] = {PerspectiveCamera{from, to, up, 30, 0.2f, 5.0f, 0, 0},
                              PerspectiveCamera{from, to, up, 30, 0.2f, 5.0f, 7, 10},
                              OrthographicCamera{from, to, up, 3},
                              PanoramaCamera{from, to, up},
                              FisheyeCamera{from, to, up, 200, FisheyeProjection::equidistant},
                              FisheyeCamera{from, to, up, 200, FisheyeProjection::equisolid}};
    Hasher hasher;
    for (const Camera& c : cameras) {
        const CameraSampler camera = make(c, 640, 360);
        for (float y = 0.1f; y < 360; y += 3.3f)
            for (float x = 0.1f; x < 640; x += 3.7f) {
                const Ray ray = camera.generate({x, y}, {x / 640, y / 360});
                for (int axis = 0; axis < 3; ++axis) hasher.value(ray.d[axis]), hasher.value(ray.o[axis]);
            }
    }
    EXPECT_EQ(hasher.hex(), "dc2a9e9001103a76b18b03fbcbc00464");
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
