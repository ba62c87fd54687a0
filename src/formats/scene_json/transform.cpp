#include "math/transform.h"

#include "formats/scene_json/common.h"

namespace steradian::scene_json {
namespace {

Vec3d read_vec3d(const Source& source, Value value, std::string_view what, Range range) {
    static constexpr size_t kThree[] = {3};
    json::expect_array(source, value, what, kThree);
    double v[3];
    int axis = 0;
    for (const Value element : value.elements()) v[axis++] = json::read_double(source, element, what, range);
    return {v[0], v[1], v[2]};
}

Affine read_rotate(const Source& source, Value value) {
    ObjectReader reader(source, value, kRotateSpec, "'rotate'");
    const Value axis_value = reader.require("axis");
    const Vec3d axis = read_vec3d(source, axis_value, "'axis'", json::kCoordinate);
    if (!(length(axis) > 0)) source.fail(axis_value.offset(), "the axis of a rotation must not be the zero vector");
    const double angle = json::read_double(source, reader.require("angle"), "'angle'", json::kAnyAngle);
    reader.finish();
    return rotation_degrees(angle, {axis.x, axis.y, axis.z});
}

Affine read_scale(const Source& source, Value value) {
    Vec3d s;
    if (value.is(Kind::number)) {
        const double uniform = json::read_double(source, value, "'scale'", json::kCoordinate);
        s = {uniform, uniform, uniform};
    } else {
        if (!value.is(Kind::array) || value.size() != 3)
            source.fail(value.offset(),
                        "'scale' must be a number or an array of 3 numbers, got " + json::describe(value));
        s = read_vec3d(source, value, "'scale'", json::kCoordinate);
    }
    if (s.x == 0 || s.y == 0 || s.z == 0) source.fail(value.offset(), "'scale' must not be 0: the object would vanish");
    return scaling(s.x, s.y, s.z);
}

/// Rows: 3 × 3, 3 × 4 or 4 × 4.
Affine read_matrix(const Source& source, Value value) {
    static constexpr size_t kRows[] = {3, 4};
    json::expect_array(source, value, "'matrix'", kRows);
    const size_t rows = value.size();
    size_t columns = 0, r = 0;
    Affine out;
    for (const Value row : value.elements()) {
        static constexpr size_t kThreeOrFour[] = {3, 4}, kThree[] = {3}, kFour[] = {4};
        const std::span<const size_t> wanted = rows == 4 || columns == 4 ? std::span<const size_t>(kFour)
                                               : columns == 3            ? std::span<const size_t>(kThree)
                                                                         : std::span<const size_t>(kThreeOrFour);
        json::expect_array(source, row, "a row of 'matrix'", wanted);
        columns = row.size();
        size_t c = 0;
        for (const Value element : row.elements()) {
            const double x = json::read_double(source, element, "an element of 'matrix'", json::kCoordinate);
            if (r < 3)
                out.m[r][c] = x;
            else if (x != (c == 3 ? 1 : 0))
                source.fail(element.offset(),
                            "the last row of 'matrix' must be 0, 0, 0, 1: projections are not transforms of objects");
            ++c;
        }
        ++r;
    }
    return out;
}

/// Puts the object at `origin`, its +Z axis towards `target`, its +Y axis as near to `up` as that allows.
Affine read_look_at(const Source& source, Value value) {
    ObjectReader reader(source, value, kLookAtSpec, "'look_at'");
    const Vec3d origin = read_vec3d(source, reader.require("origin"), "'origin'", json::kCoordinate);
    const Value target_value = reader.require("target");
    const Vec3d target = read_vec3d(source, target_value, "'target'", json::kCoordinate);
    const auto up_value = reader.find("up");
    const Vec3d up = up_value ? read_vec3d(source, *up_value, "'up'", json::kCoordinate) : Vec3d{0, 1, 0};
    reader.finish();
    const Vec3d z = normalize(target - origin);
    if (!(length(z) > 0))
        source.fail(target_value.offset(), "'target' is equal to 'origin': there is no direction to look in");
    const Vec3d side = cross(normalize(up), z);
    if (!(length(side) > 1e-6))
        source.fail(up_value ? up_value->offset() : value.offset(),
                    "'up' must not be zero or parallel to the direction to the target");
    const Vec3d x = normalize(side), y = cross(z, x);
    Affine out;
    out.m[0] = {x.x, y.x, z.x, origin.x};
    out.m[1] = {x.y, y.y, z.y, origin.y};
    out.m[2] = {x.z, y.z, z.z, origin.z};
    return out;
}

Affine read_step(const Source& source, Member step) {
    if (step.key == "translate") {
        const Vec3d t = read_vec3d(source, step.value, "'translate'", json::kCoordinate);
        return translation(t.x, t.y, t.z);
    }
    if (step.key == "rotate") return read_rotate(source, step.value);
    if (step.key == "scale") return read_scale(source, step.value);
    if (step.key == "matrix") return read_matrix(source, step.value);
    return read_look_at(source, step.value);
}

Affine read_steps(const Source& source, Value value, std::string_view what) {
    const ObjectReader checked(source, value, kTransformSpec, what);
    Affine total;
    for (const Member step : value.members()) total = read_step(source, step) * total;
    return total;
}

bool is_bare_matrix(Value value) {
    if (!value.is(Kind::array) || value.size() == 0) return false;
    return (*value.elements().begin()).is(Kind::array);
}

}  // namespace

Affine read_transform(const Source& source, Value value) {
    Affine total;
    if (is_bare_matrix(value)) {
        total = read_matrix(source, value);
    } else if (value.is(Kind::array)) {
        for (const Value step : value.elements()) total = read_steps(source, step, "a step of 'transform'") * total;
    } else if (value.is(Kind::object)) {
        total = read_steps(source, value, "'transform'");
    } else {
        source.fail(value.offset(),
                    "'transform' must be a list of steps, an object or a matrix, got " + json::describe(value));
    }
    if (!inverse(total)) source.fail(value.offset(), "'transform' flattens the object: its matrix cannot be inverted");
    if (!usable_inverse(total))
        source.fail(value.offset(),
                    "'transform' scales or moves the object too far: at most by 1e30, at least by 1e-30");
    return total;
}

}  // namespace steradian::scene_json
