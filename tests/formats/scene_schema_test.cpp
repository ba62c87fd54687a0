// docs/scene.schema.json and the loader must know the same keys.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/names.h"
#include "formats/json/document.h"
#include "formats/scene_json/keys.h"
#include "steradian/scene.h"
#include "support/support.h"

namespace steradian::scene_json {
namespace {

using json::Member;
using json::Value;
using Names = std::set<std::string, std::less<>>;

std::optional<Value> member(Value object, std::string_view key) {
    for (const Member m : object.members())
        if (m.key == key) return m.value;
    return std::nullopt;
}

Names keys_of(Value object) {
    Names names;
    for (const Member m : object.members()) names.insert(std::string(m.key));
    return names;
}

std::vector<ObjectSpec> all_specs() {
    std::vector<ObjectSpec> all{kSceneSpec,       kRenderSpec,    kFilmSpec,   kFilterSpec,
                                kObjectLightSpec, kTransformSpec, kRotateSpec, kLookAtSpec,
                                kNormalMapSpec,   kBumpMapSpec,   kMediumSpec, kFilmThicknessSpec};
    all.insert(all.end(), std::begin(kCameraSpecs), std::end(kCameraSpecs));
    all.insert(all.end(), std::begin(kTextureSpecs), std::end(kTextureSpecs));
    all.insert(all.end(), std::begin(kMaterialSpecs), std::end(kMaterialSpecs));
    all.insert(all.end(), std::begin(kShapeSpecs), std::end(kShapeSpecs));
    all.insert(all.end(), std::begin(kObjectSpecs), std::end(kObjectSpecs));
    all.insert(all.end(), std::begin(kLightSpecs), std::end(kLightSpecs));
    return all;
}

class Schema : public testing::Test {
protected:
    void SetUp() override {
        text_ = test::slurp(test::source_folder() / "docs" / "scene.schema.json");
        auto parsed = json::Document::parse(text_, "scene.schema.json", 64);
        ASSERT_TRUE(parsed.ok()) << parsed.error().str();
        document_.emplace(std::move(parsed).value());
        ASSERT_FALSE(document_->duplicate_key());
    }
    Value definitions() const { return *member(document_->root(), "$defs"); }
    Value definition(std::string_view name) const { return *member(definitions(), name); }

    std::string text_;
    std::optional<json::Document> document_;
};

TEST_F(Schema, HasTheKeysThatTheLoaderAccepts) {
    for (const ObjectSpec& spec : all_specs()) {
        SCOPED_TRACE(spec.name);
        const auto found = member(definitions(), spec.name);
        ASSERT_TRUE(found);
        const auto properties = member(*found, "properties");
        ASSERT_TRUE(properties);
        EXPECT_EQ(keys_of(*properties), Names(spec.keys.begin(), spec.keys.end()));
        const auto open = member(*found, "additionalProperties");
        ASSERT_TRUE(open);
        EXPECT_TRUE(open->is(json::Kind::boolean) && !open->boolean());
    }
}

TEST_F(Schema, HasNoObjectsThatTheLoaderDoesNotKnow) {
    Names known;
    for (const ObjectSpec& spec : all_specs()) known.insert(std::string(spec.name));
    for (const Member definition : definitions().members())
        if (member(definition.value, "properties")) {
            EXPECT_TRUE(known.contains(definition.key)) << definition.key;
        }
}

TEST_F(Schema, NamesEachTypeByItsWord) {
    const auto check = [&](std::span<const ObjectSpec> specs, std::span<const std::string_view> types) {
        ASSERT_EQ(specs.size(), types.size());
        for (size_t i = 0; i < specs.size(); ++i) {
            const Value type = *member(*member(definition(specs[i].name), "properties"), "type");
            EXPECT_EQ(member(type, "const")->string(), types[i]);
        }
    };
    check(kCameraSpecs, kCameraTypes);
    check(kTextureSpecs, kTextureTypes);
    check(kMaterialSpecs, kMaterialTypes);
    check(kShapeSpecs, kShapeTypes);
    check(kObjectSpecs, kObjectTypes);
    check(kLightSpecs, kLightTypes);
}

TEST_F(Schema, ListsTheSameWords) {
    const auto check = [&](Value schema, std::span<const std::string_view> words) {
        Names listed;
        for (const Value word : member(schema, "enum")->elements()) listed.insert(std::string(word.string()));
        EXPECT_EQ(listed, Names(words.begin(), words.end()));
    };
    const auto property = [&](std::string_view object, std::string_view key) {
        return *member(*member(definition(object), "properties"), key);
    };
    check(property("render", "integrator"), names_of<IntegratorKind>());
    check(property("render", "light_sampling"), names_of<LightSampling>());
    check(property("render", "light_choice"), names_of<LightChoice>());
    check(property("render", "sampler"), names_of<SamplerKind>());
    check(property("filter", "type"), names_of<FilterKind>());
    const Value list = *++member(property("film", "aovs"), "oneOf")->elements().begin();
    check(*member(list, "items"), names_of<Aov>());
    check(property("fisheye_camera", "projection"), kFisheyeProjections);
    check(property("image_texture", "filter"), kTextureFilters);
    check(property("conductor_material", "metal"), metal_names());
    check(definition("wrap"), kWraps);
    check(definition("color_space"), kColorSpaces);
}

TEST_F(Schema, EveryPropertyIsDescribedOrRefersToADescription) {
    for (const ObjectSpec& spec : all_specs()) {
        for (const Member property : member(definition(spec.name), "properties")->members()) {
            const auto reference = member(property.value, "$ref");
            Value described = property.value;
            if (reference && !member(described, "description"))
                described = definition(reference->string().substr(std::string_view("#/$defs/").size()));
            EXPECT_TRUE(member(described, "description") || member(described, "oneOf"))
                << spec.name << "." << property.key;
        }
    }
}

}  // namespace
}  // namespace steradian::scene_json
