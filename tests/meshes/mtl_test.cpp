#include "formats/obj/mtl.h"

#include "meshes/mesh_test.h"

namespace steradian {
namespace {

MaterialLibrary mtl(std::string_view text) {
    auto library = parse_mtl(text, "test.mtl", "folder", {});
    EXPECT_TRUE(library.ok()) << (library.ok() ? "" : library.error().str());
    return library.ok() ? std::move(library).value() : MaterialLibrary{};
}
MeshMaterial one(std::string_view lines, size_t warnings = 0) {
    MaterialLibrary library = mtl("newmtl m\n" + std::string(lines));
    EXPECT_EQ(library.diagnostics.warnings().size(), warnings) << lines << "\n" << all_warnings(library.diagnostics);
    EXPECT_EQ(library.materials.size(), 1u);
    return library.materials.empty() ? MeshMaterial{} : library.materials[0];
}

TEST(Mtl, EveryValue) {
    const MeshMaterial m =
        one("Kd 0.1 0.2 0.3\nKs .4 .5 .6\nKe 7 8 9\nTf 0.5 0.25 1\nNi 1.25\nd 0.5\nillum 7\nKa 1 1 1\nNs 10\nPr "
            "0.5\nmap_Bump b.png\n");
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.diffuse, (Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(m.specular, (Rgb{0.4f, 0.5f, 0.6f}));
    EXPECT_EQ(m.emission, (Rgb{7, 8, 9}));
    EXPECT_EQ(m.transmission, (Rgb{0.5f, 0.25f, 1}));
    EXPECT_EQ(m.ior, 1.25f);
    EXPECT_EQ(m.dissolve, 0.5f);
    EXPECT_EQ(m.illum, 7);
    EXPECT_EQ(m.diffuse_map, "");
}

TEST(Mtl, OneNumberIsAGrey) { EXPECT_EQ(one("Kd 0.25").diffuse, (Rgb{0.25f, 0.25f, 0.25f})); }

TEST(Mtl, NamesAndText) {
    const MaterialLibrary library =
        mtl("\xef\xbb\xbf# c\r\n newmtl  a b \r\n\tKd 1 \\\r\n 0 0 # red\r\nNEWMTL c#d\r\nkd 0 1 0\r\nnewmtl a b\r\nKd "
            "0 0 1\r\n");
    ASSERT_EQ(library.materials.size(), 2u);
    EXPECT_EQ(library.materials[0].name, "a b");
    EXPECT_EQ(library.materials[0].diffuse, (Rgb{1, 0, 0})) << "the first definition counts";
    EXPECT_EQ(library.materials[1].name, "c#d");
    EXPECT_EQ(library.materials[1].diffuse, (Rgb{0, 1, 0}));
    ASSERT_EQ(library.diagnostics.warnings().size(), 1u);
    EXPECT_EQ(library.diagnostics.warnings()[0].where.line, 7u);
}

TEST(Mtl, DissolveAndTransparency) {
    EXPECT_EQ(one("Tr 0.25").dissolve, 0.75f);
    EXPECT_EQ(one("d 0.25\nTr 0.75").dissolve, 0.25f);
    EXPECT_EQ(one("d 0.75\nTr 0.5", 1).dissolve, 0.75f);
    EXPECT_EQ(one("Tr 0.5\nd 0.75", 1).dissolve, 0.75f);
    EXPECT_EQ(one("d 1\nTr 1", 1).dissolve, 1.0f);
    EXPECT_EQ(one("d -halo 0.5").dissolve, 0.5f);
    EXPECT_EQ(one("d 1.5", 1).dissolve, 1.0f);
    EXPECT_EQ(one("Tr 2", 1).dissolve, 0.0f);
}

TEST(Mtl, MapsAndTheirOptions) {
    EXPECT_EQ(one("map_Kd a.png").diffuse_map, "folder/a.png");
    EXPECT_EQ(one("map_Kd  sub\\a b.png  ").diffuse_map, "folder/sub/a b.png");
    EXPECT_EQ(one("map_Kd \"a b.png\"").diffuse_map, "folder/a b.png");
    EXPECT_EQ(one("map_Kd /x/a.png").diffuse_map, "/x/a.png");
    const MeshMaterial m =
        one("map_Kd -blendu on -blendv off -bm 2 -boost 1 -cc on -clamp on -imfchan r -mm 0 1 -s 2 4 1 -o 0.25 0.5 -t "
            "1 2 3 -texres 512 -type "
            "sphere -colorspace sRGB a.png");
    EXPECT_EQ(m.diffuse_map, "folder/a.png");
    EXPECT_TRUE(m.map_clamp);
    EXPECT_EQ(m.map_scale, (Vec2{2, 4}));
    // At the file's v = 0.75, ours is 0.25: 1 - (0.75 * 4 + 0.5) = 0.25 * 4 + offset.
    EXPECT_EQ(m.map_offset, (Vec2{0.25f, -3.5f}));
    // Values may be left out; a number that ends the line is the file.
    EXPECT_EQ(one("map_Kd -o 0.1 diffuse.jpg").map_offset, (Vec2{0.1f, 0}));
    EXPECT_EQ(one("map_Kd -s 2 7").diffuse_map, "folder/7");
    EXPECT_EQ(one("map_Kd -s 2 1.png").diffuse_map, "folder/1.png");
    EXPECT_EQ(one("map_Kd -1.png").diffuse_map, "folder/-1.png");
    EXPECT_EQ(one("map_Kd -s 2 2 a.png\nmap_Kd b.png").map_scale, (Vec2{1, 1}));
}

TEST(Mtl, WhatIsWrongIsSaidWithItsPlace) {
    EXPECT_EQ(one("Kd 1 x 0", 1).diffuse, MeshMaterial{}.diffuse);
    EXPECT_EQ(one("Kd", 1).diffuse, MeshMaterial{}.diffuse);
    EXPECT_EQ(one("Kd nan 0 0", 1).diffuse, MeshMaterial{}.diffuse);
    EXPECT_EQ(one("Kd 0 -1 1e999", 1).diffuse, (Rgb{0, 0, 1e15f}));
    EXPECT_EQ(one("Kd spectral x.rfl", 1).diffuse, MeshMaterial{}.diffuse);
    EXPECT_EQ(one("Kd xyz 1 1 1", 1).diffuse, MeshMaterial{}.diffuse);
    EXPECT_EQ(one("Ni 0", 1).ior, 0.001f);
    EXPECT_EQ(one("illum 99", 1).illum, 10);
    EXPECT_EQ(one("illum glass", 1).illum, 2);
    EXPECT_EQ(one("map_Kd", 1).diffuse_map, "");
    EXPECT_EQ(one("map_Kd -foo 1", 1).diffuse_map, "folder/1");
    EXPECT_EQ(one("map_Kd -s a.png", 1).diffuse_map, "folder/a.png");
    const MaterialLibrary library = mtl("Kd 1 1 1\nnewmtl a\nKt 1\nNi  1,5\nKt 2\n");
    ASSERT_EQ(library.diagnostics.warnings().size(), 3u);
    EXPECT_EQ(library.diagnostics.warnings()[0].where.str(), "test.mtl:1:1");
    EXPECT_EQ(library.diagnostics.warnings()[1].count, 2u);
    EXPECT_EQ(library.diagnostics.warnings()[1].where.str(), "test.mtl:3:1");
    EXPECT_EQ(library.diagnostics.warnings()[2].where.str(), "test.mtl:4:5");
}

TEST(Mtl, TexturesOutsideOfTheFolder) {
    LoadOptions options;
    options.allow_outside_paths = false;
    const auto refused = parse_mtl("newmtl a\nmap_Kd -s 1 1 ../../x.png\n", "t.mtl", "f", options);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().where.str(), "t.mtl:2:15");
    EXPECT_TRUE(parse_mtl("newmtl a\nmap_Kd a/../x.png\n", "t.mtl", "f", options).ok());
}

TEST(Mtl, Utf16IsRefused) { EXPECT_FALSE(parse_mtl("\xff\xfen", "t.mtl", "f", {}).ok()); }

}  // namespace
}  // namespace steradian
