#include "formats/scene_json/native.h"

#include <limits>

namespace steradian::scene_json {
namespace {

constexpr size_t kMeshType = 0, kSphereType = 1, kRectangleType = 2, kInstanceType = 4;
constexpr Range kUv{-1e6, 1e6};

/// An array of arrays of `width` numbers, passed on one by one.
template <class Sink>
void read_rows(const Source& source, Value value, std::string_view what, size_t width, Range range, Sink sink) {
    json::expect_array(source, value, what);
    const std::string element_name = "an element of " + std::string(what);
    const size_t sizes[] = {width};
    for (const Value row : value.elements()) {
        json::expect_array(source, row, element_name, sizes);
        float numbers[3] = {};
        size_t i = 0;
        for (const Value number : row.elements()) numbers[i++] = json::read_number(source, number, element_name, range);
        sink(numbers);
    }
}

void expect_count(const Source& source, Value value, std::string_view what, size_t got, size_t vertices) {
    if (got != vertices)
        source.fail(value.offset(), std::string(what) + " has " + std::to_string(got) +
                                        " elements, but 'vertices' has " + std::to_string(vertices));
}

Rectangle read_rectangle(ObjectReader& reader) {
    Rectangle rectangle;
    rectangle.center = reader.vec3_or("center", rectangle.center);
    rectangle.half_u = reader.vec3_or("half_u", rectangle.half_u);
    rectangle.half_v = reader.vec3_or("half_v", rectangle.half_v);
    const Vec3d u(rectangle.half_u), v(rectangle.half_v);
    if (!(length(u) >= json::kMinLength) || !(length(v) >= json::kMinLength) ||
        !(length(cross(normalize(u), normalize(v))) > 1e-6))
        reader.source().fail(reader.offset(),
                             "the rectangle has no area: 'half_u' and 'half_v' must not be zero or parallel");
    return rectangle;
}

Disk read_disk(ObjectReader& reader) {
    Disk disk;
    disk.center = reader.vec3_or("center", disk.center);
    disk.normal = reader.vec3_or("normal", disk.normal);
    disk.radius = reader.number_or("radius", disk.radius, json::kLength);
    if (!(length(Vec3d(disk.normal)) >= json::kMinLength))
        reader.source().fail(reader.find("normal")->offset(), "'normal' must not be the zero vector");
    return disk;
}

}  // namespace

void NativeLoader::read_shapes(Value value) {
    if (!value.is(Kind::object))
        source_.fail(value.offset(),
                     "'shapes' must be an object with a shape for each name, got " + json::describe(value));
    for (const Member member : value.members()) {
        const Assets::Here here(assets_, member.value.offset());
        const std::string name(member.key), what = "shape " + quoted(name);
        const size_t type = read_type(source_, member.value, what, kShapeTypes);
        ObjectReader reader(source_, member.value, kShapeSpecs[type], what);
        reader.require("type");
        const Geometry geometry = read_geometry(reader, type, name);
        reader.finish();
        shapes_.insert(name, geometry);
    }
}

NativeLoader::Geometry NativeLoader::read_geometry(ObjectReader& reader, size_t type, const std::string& name) {
    if (type == kMeshType) return read_mesh(reader, name);
    if (type == kInstanceType) {
        const Value shape = reader.require("shape");
        return shapes_.get(source_, json::read_string(source_, shape, "'shape'"), shape.offset());
    }
    Shape shape;
    if (type == kSphereType) {
        Sphere sphere;
        sphere.center = reader.vec3_or("center", sphere.center);
        sphere.radius = reader.number_or("radius", sphere.radius, json::kLength);
        shape = sphere;
    } else if (type == kRectangleType) {
        shape = read_rectangle(reader);
    } else {
        shape = read_disk(reader);
    }
    return {std::nullopt, assets_.add_shape(shape, name)};
}

NativeLoader::Geometry NativeLoader::read_mesh(ObjectReader& reader, const std::string& name) {
    if (!reader.find("path"))
        return {std::nullopt, assets_.add_shape(assets_.add_mesh(read_inline_mesh(reader), name), name)};
    for (const std::string_view key : {"vertices", "triangles", "normals", "uvs", "colors"})
        if (reader.find(key))
            source_.fail(reader.key_offset(key), "a mesh has either a 'path' or its own " + quoted(key) + ", not both");
    const NamedPath path = read_path(reader);
    std::optional<ColorSpace> colors;
    if (const auto space = reader.find("color_space"))
        colors = static_cast<ColorSpace>(json::read_choice(source_, *space, "'color_space'", kColorSpaces));
    return {source_.take(assets_.load_model(path.path, colors), path.offset), std::nullopt};
}

Mesh NativeLoader::read_inline_mesh(ObjectReader& reader) const {
    if (!reader.find("vertices"))
        source_.fail(reader.offset(), "missing key 'path' in the mesh", "or give 'vertices' and 'triangles'");
    Mesh mesh;
    const Value vertices = reader.require("vertices"), triangles = reader.require("triangles");
    read_rows(source_, vertices, "'vertices'", 3, json::kCoordinate, [&](const float* v) {
        mesh.positions.push_back({v[0], v[1], v[2]});
    });
    json::expect_array(source_, triangles, "'triangles'");
    static constexpr size_t kThree[] = {3};
    for (const Value triangle : triangles.elements()) {
        json::expect_array(source_, triangle, "an element of 'triangles'", kThree);
        for (const Value corner : triangle.elements()) {
            const uint64_t i =
                json::read_integer(source_, corner, "a vertex number", 0, std::numeric_limits<uint32_t>::max());
            if (i >= mesh.positions.size())
                source_.fail(corner.offset(),
                             "vertex " + std::to_string(i) + " does not exist: there are " +
                                 std::to_string(mesh.positions.size()),
                             "counting starts at 0");
            mesh.indices.push_back(static_cast<uint32_t>(i));
        }
    }
    if (const auto normals = reader.find("normals")) {
        read_rows(source_, *normals, "'normals'", 3, json::kCoordinate, [&](const float* n) {
            mesh.normals.push_back({n[0], n[1], n[2]});
        });
        expect_count(source_, *normals, "'normals'", mesh.normals.size(), mesh.positions.size());
    }
    if (const auto uvs = reader.find("uvs")) {
        read_rows(source_, *uvs, "'uvs'", 2, kUv, [&](const float* t) { mesh.uvs.push_back({t[0], t[1]}); });
        expect_count(source_, *uvs, "'uvs'", mesh.uvs.size(), mesh.positions.size());
    }
    if (const auto colors = reader.find("colors")) {
        read_rows(source_, *colors, "'colors'", 3, json::kReflectance, [&](const float* c) {
            mesh.colors.push_back({c[0], c[1], c[2]});
        });
        expect_count(source_, *colors, "'colors'", mesh.colors.size(), mesh.positions.size());
    }
    return mesh;
}

void NativeLoader::read_objects(Value value) {
    json::expect_array(source_, value, "'objects'");
    for (const Value object : value.elements()) read_object(object);
}

NativeLoader::Emission NativeLoader::read_emission(ObjectReader& reader) {
    Emission emission;
    emission.radiance = reader.color("radiance", json::kEnergy);
    emission.two_sided = reader.boolean_or("two_sided", false);
    emission.samples = static_cast<uint32_t>(reader.integer_or("light_samples", 1, 1, kMaxLightSamples));
    emission.visible_to_camera = reader.boolean_or("visible_to_camera", true);
    if (const auto texture = reader.find("texture")) {
        emission.texture = find_texture(*texture, TextureUse::emission);
        if (!emission.texture)
            source_.fail(texture->offset(),
                         "'texture' must be the name of a texture or a texture, got " + json::describe(*texture));
    }
    return emission;
}

void NativeLoader::make_emitters(InstanceRange range, const Emission& emission, const std::string& name) {
    for (uint32_t i = 0; i < range.count; ++i)
        assets_.add_light(AreaLight{InstanceId(range.first + i), emission.radiance, emission.two_sided,
                                    emission.samples, emission.visible_to_camera, emission.texture},
                          name);
}

void NativeLoader::read_object(Value value) {
    const Assets::Here here(assets_, value.offset());
    const size_t type = read_type(source_, value, "an object", kObjectTypes);
    ObjectReader reader(source_, value, kObjectSpecs[type], "this " + std::string(kObjectTypes[type]));
    reader.require("type");
    Placement placement;
    const auto name = reader.find("name");
    if (name) placement.name = json::read_string(source_, *name, "'name'");
    if (name && objects_.contains(placement.name))
        source_.fail(name->offset(), "there is an object called " + quoted(placement.name) + " already");
    if (const auto material = reader.find("material")) placement.material = use_material(*material);
    if (const auto transform = reader.find("transform"))
        placement.world_from_object = read_transform(source_, *transform);
    std::optional<Emission> emission;
    if (const auto light = reader.find("light")) {
        ObjectReader light_reader(source_, *light, kObjectLightSpec, "'light'");
        static constexpr std::string_view kArea[] = {"area"};
        light_reader.choice_or("type", 0, kArea);
        emission = read_emission(light_reader);
        light_reader.finish();
        placement.emitter = true;
    }
    const Geometry geometry = read_geometry(reader, type, placement.name);
    reader.finish();

    const size_t lights_before = scene().lights.size();
    InstanceRange range{static_cast<uint32_t>(scene().instances.size()), 1};
    if (geometry.model) {
        range = source_.take(assets_.place(*geometry.model, placement), value.offset());
        if (emission && range.count == 0)
            source_.fail(reader.key_offset("light"), "a model without faces cannot be a light");
    } else {
        const MaterialId material =
            placement.material ? *placement.material : assets_.default_material(placement.emitter);
        assets_.add_instance({*geometry.shape, material, placement.world_from_object}, placement.name);
    }
    if (emission) make_emitters(range, *emission, placement.name);
    if (name) objects_.insert(placement.name, NamedObject{range, scene().lights.size() > lights_before});
}

}  // namespace steradian::scene_json
