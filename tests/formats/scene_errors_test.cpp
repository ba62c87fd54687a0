// Every kind of mistake in a scene of ours: the message, the place, the hint.
#include "formats/scene_test.h"

namespace steradian::test {
namespace {

void refused(std::string_view members, std::string_view message, std::string_view hint = {}) {
    expect_error(scene_with(members), message, hint);
}
void refused_object(std::string_view object, std::string_view message, std::string_view hint = {}) {
    expect_error(scene_with_object(object), message, hint);
}
void refused_light(std::string_view light, std::string_view message, std::string_view hint = {}) {
    expect_error(scene_with_light(light), message, hint);
}
void refused_camera(std::string_view camera, std::string_view message, std::string_view hint = {}) {
    expect_error("{\"version\": 1,\n  \"camera\": " + std::string(camera) + "}", message, hint);
}

TEST(SceneErrors, AnErrorReadsLikeThis) {
    const auto loaded = load_text(
        "{\n  \"version\": 1,\n  \"camera\": {\"position\": [0, 0, 5], \"look_at\": [0, 0, 0]},\n"
        "  \"objects\": [{\"type\": \"sphere\", \"raduis\": 2}]\n}\n");
    ASSERT_FALSE(loaded.ok());
    EXPECT_EQ(loaded.error().str(),
              "test.json:4:34: error: unknown key 'raduis' in this sphere\n"
              "    \"objects\": [{\"type\": \"sphere\", \"raduis\": 2}]\n"
              "                                   ^\n"
              "  hint: did you mean 'radius'?");
}

TEST(SceneErrors, TheWholeFile) {
    expect_error("§[]", "a scene must be an object, got an array of 0");
    expect_error("§{}", "missing key 'version'", "begin with {\"version\": 1");
    expect_error("§{\"lights\": []}", "missing key 'version'", "begin with");
    expect_error("{\"version\": §2}", "scenes of version 2 are not known", "");
    expect_error("{\"version\": §1.5}", "scenes of version 1.5 are not known", "");
    expect_error("{\"version\": §\"1\"}", "'version' must be the number 1, got the string \"1\"");
    expect_error("§{\"version\": 1}", "missing key 'camera' in the scene", "\"position\"");
    expect_error("{\"version\": 1,\n\n §\"camra\": {}}", "unknown key 'camra' in the scene", "did you mean 'camera'?");
    expect_error("{\"version\": 1, §\"version\": 1}", "the key 'version' stands here for the second time",
                 "test.json:1:2");
    refused("\"objects\": [{\"type\": \"sphere\",\n \"radius\": 1, §\"radius\": 2}]",
            "the key 'radius' stands here for the second time", "test.json:3:2");
    refused("\"comment\": §7", "'comment' must be a string, got 7");
    refused("\"$schema\": §null", "'$schema' must be a string, got null");
    expect_error("{\"version\": 1, \"x\": §1e999}", "the number is too large");
    expect_error("{\"version\": 1, \"x\": §NaN}", "expected a JSON value", "finite");
}

TEST(SceneErrors, Render) {
    refused("\"render\": §[]", "'render' must be an object, got an array of 0");
    refused("\"render\": {§\"samples\": 5}", "unknown key 'samples' in 'render'", "sampler");
    refused("\"render\": {\"integrator\": §\"pat\"}", "'integrator' cannot be \"pat\"", "did you mean 'path'?");
    refused("\"render\": {\"clamp\": §-1}", "'clamp' must be");
    refused("\"render\": {\"light_sampling\": §\"both\"}", "'light_sampling' cannot be \"both\"", "mis");
    refused("\"render\": {\"integrator\": §1}", "'integrator' must be a string, got 1");
    refused("\"render\": {\"sampler\": §\"sobel\"}", "'sampler' cannot be \"sobel\"", "did you mean 'sobol'?");
    refused("\"render\": {\"spp\": §0}", "'spp' must be a whole number from 1 to 1000000000, got 0");
    refused("\"render\": {\"spp\": §-1}", "'spp' must be a whole number from 1 to 1000000000, got -1");
    refused("\"render\": {\"spp\": §2.5}", "'spp' must be a whole number", "");
    refused("\"render\": {\"spp\": §9223372036854775808}", "'spp' must be a whole number", "");
    refused("\"render\": {\"spp\": §\"64\"}",
            "'spp' must be a whole number from 1 to 1000000000, got the string \"64\"");
    refused("\"render\": {\"max_depth\": §65536}", "'max_depth' must be a whole number from 0 to 65535");
    refused("\"render\": {\"max_depth\": §true}", "got true");
    refused("\"render\": {\"seed\": §18446744073709551616}",
            "'seed' must be a whole number from 0 to 18446744073709551615");
    refused("\"render\": {\"camera\": §\"top\"}", "'camera' cannot be \"top\"", "expected camera");
}

TEST(SceneErrors, Film) {
    refused("\"film\": {\"resolution\": §512}", "'resolution' must be an array of 2, got 512");
    refused("\"film\": {\"resolution\": §[1, 2, 3]}", "'resolution' must be an array of 2, got an array of 3");
    refused("\"film\": {\"resolution\": [§0, 2]}", "the width must be a whole number from 1 to 1048576, got 0");
    refused("\"film\": {\"resolution\": [2, §-2]}", "the height must be a whole number from 1 to 1048576, got -2");
    refused("\"film\": {\"resolution\": [2, §2147483648]}", "the height must be a whole number from 1 to 1048576");
    refused("\"film\": {\"resolution\": §[1048576, 1048576]}", "more than the limit of 1073741824 pixels");
    EXPECT_TRUE(load_text(scene_with("\"film\": {\"resolution\": [1, 1]}")).ok());
    EXPECT_TRUE(load_text(scene_with("\"film\": {\"resolution\": [1, 1048576]}")).ok());
    refused("\"film\": {\"filter\": §\"box\"}", "the filter must be an object, got the string \"box\"");
    refused("\"film\": {\"filter\": §{}}", "missing key 'type' in the filter");
    refused("\"film\": {\"filter\": {\"type\": §\"gauss\"}}", "the type of the filter cannot be \"gauss\"",
            "expected one of box, tent, gaussian, mitchell");
    refused("\"film\": {\"filter\": {\"type\": §\"gausian\"}}", "the type of the filter cannot be \"gausian\"",
            "did you mean 'gaussian'?");
    refused("\"film\": {\"filter\": {\"type\": \"box\", \"radius\": §0}}", "'radius' must be from 0.01 to 32, got 0");
    refused("\"film\": {\"crop\": §[0, 0, 5]}", "'crop' must be an array of 4");
    refused("\"film\": {\"crop\": [0, 0, §513, 5]}", "an edge of 'crop' must be a whole number from 0 to 512, got 513");
    refused("\"film\": {\"crop\": [0, §-1, 5, 5]}", "an edge of 'crop' must be a whole number from 0 to 512, got -1");
    refused("\"film\": {\"crop\": §[5, 0, 5, 5]}", "'crop' has no pixels", "x0 < x1");
}

TEST(SceneErrors, Cameras) {
    refused_camera("§3", "the camera must be an object, got 3");
    refused_camera("§{\"look_at\": [0, 0, 0]}", "missing key 'position' in the camera");
    refused_camera("§{\"position\": [0, 0, 0]}", "missing key 'look_at' in the camera");
    refused_camera("{\"position\": §[0, 0], \"look_at\": [0, 0, 0]}",
                   "'position' must be an array of 3 numbers, got an array of 2");
    refused_camera("{\"position\": [0, §null, 0], \"look_at\": [0, 0, 0]}", "'position' must be a number, got null");
    refused_camera("{\"position\": [0, §1e16, 0], \"look_at\": [0, 0, 0]}",
                   "'position' must be from -1e+15 to 1e+15, got 1e16");
    refused_camera("{\"position\": [1, 2, 3], \"look_at\": §[1, 2, 3]}", "'look_at' is equal to its 'position'");
    // Equal once rounded to float.
    refused_camera("{\"position\": [1e9, 0, 0], \"look_at\": §[1000000000.1, 0, 0]}",
                   "'look_at' is equal to its 'position'");
    refused_camera("{\"position\": [0, 5, 0], \"look_at\": §[0, 0, 0]}", "'up' is parallel to the camera's view",
                   "[0, 0, 1]");
    refused_camera("{\"position\": [0, 0, 5], \"look_at\": [0, 0, 0], \"up\": §[0, 0, 2]}",
                   "'up' is parallel to the camera's view");
    refused_camera("{\"position\": [0, 0, 5], \"look_at\": [0, 0, 0], \"up\": §[0, 0, 0]}",
                   "'up' must not be the zero vector");
    for (const char* fov : {"0", "180", "-1", "179.99999999999"})
        refused_camera("{\"position\": [0, 0, 5], \"look_at\": [0, 0, 0], \"vertical_fov\": §" + std::string(fov) + "}",
                       "'vertical_fov' must be greater than 0 and less than 180, got " + std::string(fov));
    EXPECT_TRUE(
        load_text(
            "{\"version\": 1, \"camera\": {\"position\": [0, 0, 5], \"look_at\": [0, 0, 0], \"vertical_fov\": 1e-9}}")
            .ok());
    refused_camera("{\"type\": §\"fish\", \"position\": [0, 0, 5], \"look_at\": [0, 0, 0]}",
                   "'type' cannot be \"fish\"", "expected one of perspective, orthographic, panorama, fisheye");
    const auto refused_key = [](const std::string& type, const std::string& members, const std::string& message) {
        refused_camera("{\"type\": \"" + type + "\", \"position\": [0, 0, 5], \"look_at\": [0, 0, 0], " + members + "}",
                       message);
    };
    refused_key("perspective", "\"aperture_radius\": §-1", "'aperture_radius' must be from 0 to");
    refused_key("perspective", "\"aperture_radius\": 1, \"focus_distance\": §0", "'focus_distance' must be from 1e-15");
    for (const char* blades : {"2", "65", "0"})
        refused_key("perspective", "\"aperture_radius\": 1, \"aperture_blades\": §" + std::string(blades),
                    "'aperture_blades' must be a whole number from 3 to 64");
    // What has no effect is refused.
    refused_key("perspective", "§\"focus_distance\": 1", "focus_distance");
    refused_key("perspective", "§\"aperture_blades\": 5", "aperture_blades");
    refused_key("perspective", "\"aperture_radius\": 1, §\"aperture_rotation\": 5", "aperture_rotation");
    refused_key("orthographic", "\"height\": §0", "'height' must be from 1e-15");
    refused_key("orthographic", "§\"vertical_fov\": 40", "unknown key 'vertical_fov' in the camera");
    refused_key("panorama", "§\"height\": 1", "unknown key 'height' in the camera");
    refused_key("fisheye", "\"fov\": §361", "'fov' must be greater than 0 and at most 360");
    refused_key("fisheye", "\"projection\": §\"stereographic\"", "'projection' cannot be \"stereographic\"");
    refused_camera("{\"type\": \"panorama\", \"position\": [0, 5, 0], \"look_at\": §[0, 0, 0]}",
                   "'up' is parallel to the camera's view");
    refused_camera("{\"position\": [0, 0, 5], \"look_at\": [0, 0, 0], §\"fov\": 30}", "unknown key 'fov' in the camera",
                   "vertical_fov");
    refused("§\"cameras\": {}", "either 'camera' or 'cameras'");
    expect_error("{\"version\": 1, \"cameras\": §{}}", "'cameras' must be an object with a camera for each name");
    expect_error("{\"version\": 1, \"cameras\": §[1]}",
                 "'cameras' must be an object with a camera for each name, got an array of 1");
    expect_error("{\"version\": 1, \"cameras\": {\"a\": §1}}", "the camera must be an object");
}

TEST(SceneErrors, Textures) {
    refused("\"textures\": §[]", "'textures' must be an object with a texture for each name");
    refused("\"textures\": {\"t\": §5}", "texture 't' must be an object, got 5");
    refused("\"textures\": {\"t\": §{}}", "missing key 'type' in texture 't'", "constant, image, checkerboard");
    refused("\"textures\": {\"t\": {\"type\": §\"checker\"}}", "the type of texture 't' cannot be \"checker\"", "");
    refused("\"textures\": {\"t\": §{\"type\": \"constant\"}}", "missing key 'color' in texture 't'");
    refused("\"textures\": {\"t\": {\"type\": \"constant\", \"color\": §\"red\"}}",
            "'color' must be a number or an array of 3 numbers (red, green, blue)");
    refused("\"textures\": {\"t\": {\"type\": \"constant\", \"color\": [0.5, §-0.1, 0]}}",
            "'color' must be from 0 to 1e+06, got -0.1");
    refused("\"textures\": {\"t\": {\"type\": \"constant\", \"color\": 1, §\"scale\": 2}}",
            "unknown key 'scale' in texture 't'", "");
    refused("\"textures\": {\"t\": §{\"type\": \"image\"}}", "missing key 'path' in texture 't'");
    refused("\"textures\": {\"t\": {\"type\": \"image\", \"path\": §5}}", "'path' must be a string, got 5");
    refused("\"textures\": {\"t\": {\"type\": \"image\", \"path\": \"x.png\", \"wrap\": §\"tile\"}}",
            "'wrap' cannot be \"tile\"", "repeat");
    refused("\"textures\": {\"t\": {\"type\": \"image\", \"path\": \"x.png\", \"wrap\": §[\"clamp\"]}}",
            "'wrap' must be an array of 2");
    refused("\"textures\": {\"t\": {\"type\": \"image\", \"path\": \"x.png\", \"filter\": §\"trilinera\"}}",
            "'filter' cannot be \"trilinera\"", "trilinear");
    refused("\"textures\": {\"t\": {\"type\": \"image\", \"path\": \"x.png\", \"color_space\": §\"sRGB \"}}",
            "'color_space' cannot be", "srgb");
    refused("\"textures\": {\"t\": {\"type\": \"image\", \"path\": \"x.png\", \"scale\": §[1, 2, 3]}}",
            "'scale' must be a number or an array of 2 numbers");
    refused("\"textures\": {\"t\": {\"type\": \"image\", \"path\": §\"x.png\"}}",
            "/nonexistent/x.png: cannot open the file: No such file or directory");
}

TEST(SceneErrors, Relief) {
    const auto material = [](std::string_view members, std::string_view message, std::string_view hint = {}) {
        refused(
            "\"textures\": {\"n\": {\"type\": \"constant\", \"color\": 1}}, \"materials\": {\"m\": {\"type\": "
            "\"mirror\", " +
                std::string(members) + "}}",
            message, hint);
    };
    material("\"normal_map\": §5", "'normal_map' must be the name of a texture or a texture, got 5");
    material("\"normal_map\": §\"x\"", "there is no texture called 'x'", "n");
    material("\"normal_map\": §{}", "missing key 'texture'");
    material("\"normal_map\": {\"texture\": \"n\", \"strength\": §-1}", "'strength' must be from 0 to 100, got -1");
    material("\"normal_map\": {\"texture\": \"n\", §\"scale\": 1}", "unknown key 'scale'", "");
    material("\"bump_map\": §\"n\"", "'bump_map' must be an object");
    material("\"normal_map\": \"n\", §\"bump_map\": {\"texture\": \"n\"}",
             "either 'normal_map' or 'bump_map', not both");
}

TEST(SceneErrors, Mixes) {
    const auto mix = [](std::string_view members, std::string_view message, std::string_view hint = {}) {
        refused(
            "\"materials\": {\"a\": {\"type\": \"mirror\"}, \"two\": {\"type\": \"mix\", \"materials\": [\"a\", "
            "\"a\"]}, "
            "\"m\": {\"type\": \"mix\", " +
                std::string(members) + "}}",
            message, hint);
    };
    mix("\"materials\": §[\"a\"]", "'materials' must be an array of 2");
    mix("\"materials\": [\"a\", §\"b\"]", "there is no material called 'b'", "a");
    mix("\"materials\": [\"a\", §\"m\"]", "there is no material called 'm'", "a");
    mix("\"materials\": [\"a\", \"a\"], \"weight\": §2", "'weight' must be from 0 to 1, got 2");
    mix("\"materials\": [\"a\", \"a\"], §\"normal_map\": \"n\"", "unknown key 'normal_map'", "");
    mix("\"materials\": §[\"two\", {\"type\": \"mix\", \"materials\": [\"two\", \"a\"]}]",
        "a mix of 5 materials, expected at most 4");
}

TEST(SceneErrors, Materials) {
    refused("\"materials\": §1", "'materials' must be an object with a material for each name");
    refused("\"materials\": {\"m\": {\"type\": §\"difuse\"}}", "the type of material 'm' cannot be \"difuse\"",
            "did you mean 'diffuse'?");
    refused("\"materials\": {\"m\": {\"type\": §7}}", "the type of material 'm' must be a string, got 7");
    refused("\"materials\": {\"m\": §{\"type\": \"diffuse\"}}", "missing key 'reflectance' in material 'm'");
    refused("\"materials\": {\"m\": {\"type\": \"diffuse\", \"reflectance\": §\"wood\"}}",
            "there is no texture called 'wood'", "the file defines no texture");
    refused(
        "\"textures\": {\"woods\": {\"type\": \"constant\", \"color\": 1}}, \"materials\": {\"m\": {\"type\": "
        "\"diffuse\", \"reflectance\": §\"wood\"}}",
        "there is no texture called 'wood'", "did you mean 'woods'?");
    refused("\"materials\": {\"m\": {\"type\": \"diffuse\", \"reflectance\": §true}}",
            "'reflectance' must be a colour, the name of a texture or a texture, got true");
    refused("\"materials\": {\"m\": {\"type\": \"diffuse\", \"reflectance\": §[1, 1]}}",
            "'reflectance' must be a number or an array of 3 numbers");
    refused("\"materials\": {\"m\": {\"type\": \"diffuse\", \"reflectance\": 1, \"two_sided\": §1}}",
            "'two_sided' must be true or false, got 1");
    for (const char* eta : {"0", "-1", "1e9", "1e-9"})
        refused("\"materials\": {\"m\": {\"type\": \"glass\", \"eta\": §" + std::string(eta) + "}}",
                "'eta' must be from 0.001 to 1000, got " + std::string(eta));
    for (const char* abbe : {"0.5", "-20", "1e7"})
        refused("\"materials\": {\"m\": {\"type\": \"glass\", \"abbe\": §" + std::string(abbe) + "}}",
                "'abbe' must be from 1 to ");
    refused("\"materials\": {\"m\": {\"type\": \"refraction\", \"eta\": §0}}",
            "'eta' must be from 0.001 to 1000, got 0");
    refused("\"materials\": {\"m\": {\"type\": \"refraction\", §\"reflectance\": 1}}",
            "unknown key 'reflectance' in material 'm'", "");
    refused("\"materials\": {\"m\": {\"type\": \"mirror\", \"reflectance\": §-1}}",
            "'reflectance' must be from 0 to 1e+06, got -1");
}

TEST(SceneErrors, Conductors) {
    const auto refused_metal = [](const std::string& keys, std::string_view message, std::string_view hint = {}) {
        refused("\"materials\": {\"m\": " + keys + "}", message, hint);
    };
    const std::string_view one_of = "a conductor needs one of 'metal', 'n' with 'k', and 'reflectance'";
    refused_metal(R"(§{"type": "conductor"})", one_of);
    refused_metal(R"(§{"type": "conductor", "metal": "gold", "reflectance": 1})", one_of);
    refused_metal(R"(§{"type": "conductor", "n": 1})", "missing key 'k' in material 'm'");
    refused_metal(R"({"type": "conductor", "metal": §"gould"})", "'metal' cannot be \"gould\"", "did you mean 'gold'?");
    refused_metal(R"({"type": "conductor", "metal": "gold", §"k": 1})", "'k'", "");
    refused_metal(R"({"type": "conductor", "metal": "gold", §"edge_reflectance": 1})", "'edge_reflectance'", "");
    refused_metal(R"({"type": "conductor", "n": §0, "k": 1})", "'n' must be from 0.001 to 1000, got 0");
    refused_metal(R"({"type": "conductor", "metal": "gold", "roughness": §1.5})", "'roughness' must be from 0 to 1");
    refused_metal(R"({"type": "conductor", "metal": "gold", "roughness": [0, §-1]})", "'roughness'");
    refused_metal(R"({"type": "conductor", "metal": "gold", "roughness": §"t"})", "there is no texture called 't'",
                  "the file defines no texture");
    refused_metal(R"({"type": "conductor", "metal": "gold", "roughness": 1, §"alpha": 1})",
                  "either 'roughness' or 'alpha', not both");
}

TEST(SceneErrors, Objects) {
    refused("\"objects\": §{}", "'objects' must be an array, got an object");
    refused_object("§5", "an object must be an object, got 5");
    refused_object("§{}", "missing key 'type' in an object", "mesh, sphere, rectangle, disk, instance");
    refused_object("{\"type\": §\"cube\"}", "the type of an object cannot be \"cube\"", "mesh, sphere");
    refused_object("{\"type\": \"sphere\", \"material\": §\"m\"}", "there is no material called 'm'",
                   "the file defines no material");
    refused_object("{\"type\": \"sphere\", \"material\": §[1]}",
                   "'material' must be the name of a material or a material, got an array of 1");
    refused_object("{\"type\": \"sphere\", \"name\": §4}", "'name' must be a string, got 4");
    refused_object("{\"type\": \"sphere\", \"name\": \"a\"}, {\"type\": \"disk\", \"name\": §\"a\"}",
                   "there is an object called 'a' already");
    for (const char* radius : {"0", "-1", "1e-50", "1e16"})
        refused_object("{\"type\": \"sphere\", \"radius\": §" + std::string(radius) + "}",
                       "'radius' must be from 1e-15 to 1e+15, got " + std::string(radius));
    refused_object("{\"type\": \"disk\", \"radius\": §0}", "'radius' must be from 1e-15 to 1e+15, got 0");
    refused_object("{\"type\": \"disk\", \"normal\": §[0, 0, 0]}", "'normal' must not be the zero vector");
    refused_object("§{\"type\": \"rectangle\", \"half_u\": [0, 0, 0]}", "the rectangle has no area");
    refused_object("§{\"type\": \"rectangle\", \"half_u\": [1, 1, 0], \"half_v\": [-2, -2, 0]}",
                   "the rectangle has no area");
    refused_object("{\"type\": \"instance\", \"shape\": §\"s\"}", "there is no shape called 's'",
                   "the file defines no shape");
    refused_object("§{\"type\": \"instance\"}", "missing key 'shape' in this instance");
    refused("\"shapes\": §[]", "'shapes' must be an object with a shape for each name");
    refused("\"shapes\": {\"s\": {\"type\": §\"instance\"}}", "the type of shape 's' cannot be \"instance\"", "");
    refused("\"shapes\": {\"s\": {\"type\": \"sphere\", §\"material\": \"m\"}}", "unknown key 'material' in shape 's'",
            "");
}

TEST(SceneErrors, InlineMeshes) {
    const auto mesh = [](std::string_view members, std::string_view message, std::string_view hint = {}) {
        refused_object("{\"type\": \"mesh\", " + std::string(members) + "}", message, hint);
    };
    refused_object("§{\"type\": \"mesh\"}", "missing key 'path' in the mesh", "'vertices' and 'triangles'");
    refused_object("§{\"type\": \"mesh\", \"vertices\": [[0, 0, 0]]}", "missing key 'triangles'");
    mesh("\"vertices\": §5, \"triangles\": []", "'vertices' must be an array, got 5");
    mesh("\"vertices\": [[0, 0, 0], §[0, 0]], \"triangles\": []",
         "an element of 'vertices' must be an array of 3, got an array of 2");
    mesh("\"vertices\": [[0, §\"0\", 0]], \"triangles\": []", "an element of 'vertices' must be a number");
    mesh("\"vertices\": [[0, §1e20, 0]], \"triangles\": []",
         "an element of 'vertices' must be from -1e+15 to 1e+15, got 1e20");
    mesh("\"vertices\": [[0, 0, 0]], \"triangles\": [§0]", "an element of 'triangles' must be an array of 3, got 0");
    mesh("\"vertices\": [[0, 0, 0]], \"triangles\": [[0, 0, §1]]", "vertex 1 does not exist: there are 1",
         "counting starts at 0");
    mesh("\"vertices\": [[0, 0, 0]], \"triangles\": [[0, 0, §-1]]", "a vertex number must be a whole number");
    mesh("\"vertices\": [[0, 0, 0]], \"triangles\": [[0, 0, 0]], \"normals\": §[]",
         "'normals' has 0 elements, but 'vertices' has 1");
    mesh("\"vertices\": [[0, 0, 0]], \"triangles\": [[0, 0, 0]], \"uvs\": §[[0, 0], [1, 1]]",
         "'uvs' has 2 elements, but 'vertices' has 1");
    mesh("\"vertices\": [[0, 0, 0]], \"triangles\": [[0, 0, 0]], \"uvs\": [§[0]]",
         "an element of 'uvs' must be an array of 2, got an array of 1");
    mesh("\"path\": \"x.obj\", §\"vertices\": []", "a mesh has either a 'path' or its own 'vertices', not both");
    mesh("\"path\": \"x.obj\", §\"uvs\": []", "a mesh has either a 'path' or its own 'uvs', not both");
}

TEST(SceneErrors, Lights) {
    refused("\"lights\": §{}", "'lights' must be an array");
    refused_light("§{}", "missing key 'type' in a light", "point, spot, directional, area, environment");
    refused_light("{\"type\": §\"sun\"}", "the type of a light cannot be \"sun\"", "");
    refused_light("§{\"type\": \"point\", \"intensity\": 1}", "missing key 'position' in this point light");
    refused_light("§{\"type\": \"point\", \"position\": [0, 0, 0]}", "missing key 'intensity' in the light", "flux");
    refused_light("{\"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": 1, §\"flux\": 1}",
                  "either 'intensity' or 'flux', not both");
    refused_light("{\"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": §-1}",
                  "'intensity' must be 0 or greater, at most 1e+30, got -1");
    refused_light("{\"type\": \"point\", \"position\": [0, 0, 0], \"flux\": [0, 0, §2e30]}",
                  "'flux' must be 0 or greater, at most 1e+30, got 2e30");
    refused_light("{\"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": 1, §\"radiance\": 1}",
                  "unknown key 'radiance' in this point light", "");
    refused_light("{\"type\": \"point\", \"name\": §0, \"position\": [0, 0, 0], \"intensity\": 1}",
                  "'name' must be a string, got 0");
    const std::string spot = "{\"type\": \"spot\", \"position\": [0, 0, 0], \"intensity\": 1, ";
    refused_light("§{\"type\": \"spot\", \"position\": [0, 0, 0], \"intensity\": 1}",
                  "missing key 'direction' in the light", "look_at");
    refused_light(spot + "\"direction\": §[0, 0, 0]}", "'direction' must not be the zero vector");
    refused_light(spot + "\"look_at\": §[0, 0, 0]}", "'look_at' is equal to 'position'");
    refused_light(spot + "\"direction\": [0, 0, 1], §\"look_at\": [0, 0, 1]}",
                  "either 'direction' or 'look_at', not both");
    refused_light(spot + "\"direction\": [0, 0, 1], \"outer_angle\": §0}",
                  "'outer_angle' must be from 0.001 to 180, got 0");
    refused_light(spot + "\"direction\": [0, 0, 1], \"outer_angle\": §181}",
                  "'outer_angle' must be from 0.001 to 180, got 181");
    refused_light(spot + "\"direction\": [0, 0, 1], \"outer_angle\": 20, \"inner_angle\": §21}",
                  "'inner_angle' must be from 0 to 20, got 21");
    refused_light(
        "{\"type\": \"spot\", \"position\": [0, 0, 0], \"direction\": [0, 0, 1], \"outer_angle\": 0.001, \"flux\": "
        "§1e30}",
        "too large for a cone this narrow");
    refused_light("§{\"type\": \"directional\", \"irradiance\": 1}",
                  "missing key 'direction' in this directional light");
    refused_light("§{\"type\": \"directional\", \"direction\": [0, -1, 0]}",
                  "missing key 'irradiance' in this directional light");
    refused_light(
        "{\"type\": \"directional\", \"direction\": [0, -1, 0], \"irradiance\": 1, §\"visible_to_camera\": false}",
        "'visible_to_camera' is of no use without 'angular_diameter'");
    refused_light(
        "{\"type\": \"directional\", \"direction\": [0, -1, 0], \"irradiance\": 1, \"angular_diameter\": §91}",
        "'angular_diameter'");
    refused_light("{\"type\": \"directional\", \"irradiance\": 1, \"direction\": §[0, 0, 0]}",
                  "'direction' must not be the zero vector");
    refused_light("{\"type\": \"area\", \"object\": §\"lamp\", \"radiance\": 1}", "there is no object called 'lamp'",
                  "the file defines no object");
    refused_light("§{\"type\": \"area\", \"radiance\": 1}", "missing key 'object' in this area light");
    const std::string lamp = "\"objects\": [{\"type\": \"disk\", \"name\": \"lamp\"}], \"lights\": [";
    refused(lamp + "{\"type\": \"area\", \"object\": §\"lmp\", \"radiance\": 1}]", "there is no object called 'lmp'",
            "did you mean 'lamp'?");
    refused(lamp + "§{\"type\": \"area\", \"object\": \"lamp\"}]", "missing key 'radiance'");
    refused(lamp + "{\"type\": \"area\", \"object\": \"lamp\", \"radiance\": 1, \"light_samples\": §0}]",
            "'light_samples' must be a whole number from 1 to 4096, got 0");
    refused(lamp +
                "{\"type\": \"area\", \"object\": \"lamp\", \"radiance\": 1}, {\"type\": \"area\", \"object\": "
                "§\"lamp\", \"radiance\": 1}]",
            "'lamp' is a light already");
    refused(
        "\"objects\": [{\"type\": \"disk\", \"name\": \"lamp\", \"light\": {\"radiance\": 1}}], \"lights\": "
        "[{\"type\": \"area\", \"object\": §\"lamp\", \"radiance\": 1}]",
        "'lamp' is a light already");
    refused_object("{\"type\": \"disk\", \"light\": §5}", "'light' must be an object, got 5");
    refused_object("{\"type\": \"disk\", \"light\": §{}}", "missing key 'radiance' in 'light'");
    refused_object("{\"type\": \"disk\", \"light\": {\"type\": §\"spot\", \"radiance\": 1}}",
                   "'type' cannot be \"spot\"", "expected area");
    refused_object("{\"type\": \"disk\", \"light\": {\"radiance\": §-1}}", "'radiance' must be 0 or greater");
}

TEST(SceneErrors, Environments) {
    refused_light("{\"type\": \"environment\", \"radiance\": 1}, §{\"type\": \"environment\", \"radiance\": 1}",
                  "the scene has an environment already");
    refused_light("§{\"type\": \"environment\"}", "missing key 'radiance' in the environment light",
                  "'path' of an image");
    refused_light("{\"type\": \"environment\", \"radiance\": 1, \"scale\": §-1}",
                  "'scale' must be from 0 to 1e+08, got -1");
    // Keys that are about the image do nothing without one.
    refused_light("{\"type\": \"environment\", \"radiance\": 1, §\"rotation\": 30}",
                  "'rotation' has no effect in this environment light", "remove it");
    refused_light("{\"type\": \"environment\", \"radiance\": 1, §\"color_space\": \"linear\"}",
                  "'color_space' has no effect", "remove it");
    refused_object("{\"type\": \"sphere\", \"light\": {\"radiance\": 1, \"texture\": §1}}",
                   "'texture' must be the name of a texture or a texture, got 1");
    refused_light("{\"type\": \"environment\", \"path\": §\"sky.exr\"}", "/nonexistent/sky.exr: cannot open the file");
}

TEST(SceneErrors, ForeignBytesAreEscaped) {
    const auto loaded = load_text("{\"version\": 1, \"\\u001b[31mred\": 1}");
    ASSERT_FALSE(loaded.ok());
    for (const char c : loaded.error().str()) EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20);
    EXPECT_NE(loaded.error().message.find("\\x1b[31mred"), std::string::npos);
}

TEST(SceneErrors, LineEndsOfAllKindsCount) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        const auto loaded = load_text(std::string("{\"version\": 1,") + end + "\"camera\":" + end + " 5}");
        ASSERT_FALSE(loaded.ok());
        EXPECT_EQ(loaded.error().where.line, 3u);
        EXPECT_EQ(loaded.error().where.column, 2u);
    }
}

}  // namespace
}  // namespace steradian::test
