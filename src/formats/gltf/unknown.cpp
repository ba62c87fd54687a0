#include "formats/gltf/unknown.h"

#include <algorithm>
#include <map>
#include <span>

#include "base/text.h"

namespace steradian::gltf {
namespace {

enum class Is : uint8_t {
    leaf,  ///< no object whose names are known
    root,
    accessor,
    sparse,
    sparse_indices,
    sparse_values,
    animation,
    channel,
    channel_target,
    animation_sampler,
    asset,
    buffer,
    buffer_view,
    camera,
    orthographic,
    perspective,
    image,
    material,
    metallic_roughness,
    texture_info,
    normal_texture,
    occlusion_texture,
    mesh,
    primitive,
    attributes,
    node,
    sampler,
    scene,
    skin,
    texture,
};

/// `is`: what its value is, or what the elements of its value are.
struct Property {
    std::string_view key;
    Is is = Is::leaf;
};

constexpr Property kRoot[] = {{"accessors", Is::accessor},
                              {"animations", Is::animation},
                              {"asset", Is::asset},
                              {"buffers", Is::buffer},
                              {"bufferViews", Is::buffer_view},
                              {"cameras", Is::camera},
                              {"extensionsRequired"},
                              {"extensionsUsed"},
                              {"images", Is::image},
                              {"materials", Is::material},
                              {"meshes", Is::mesh},
                              {"nodes", Is::node},
                              {"samplers", Is::sampler},
                              {"scene"},
                              {"scenes", Is::scene},
                              {"skins", Is::skin},
                              {"textures", Is::texture}};
constexpr Property kAccessor[] = {
    {"bufferView"}, {"byteOffset"}, {"componentType"}, {"normalized"}, {"count"},
    {"type"},       {"max"},        {"min"},           {"name"},       {"sparse", Is::sparse}};
constexpr Property kSparse[] = {{"count"}, {"indices", Is::sparse_indices}, {"values", Is::sparse_values}};
constexpr Property kSparseIndices[] = {{"bufferView"}, {"byteOffset"}, {"componentType"}};
constexpr Property kSparseValues[] = {{"bufferView"}, {"byteOffset"}};
constexpr Property kAnimation[] = {{"channels", Is::channel}, {"samplers", Is::animation_sampler}, {"name"}};
constexpr Property kChannel[] = {{"sampler"}, {"target", Is::channel_target}};
constexpr Property kChannelTarget[] = {{"node"}, {"path"}};
constexpr Property kAnimationSampler[] = {{"input"}, {"interpolation"}, {"output"}};
constexpr Property kAsset[] = {{"copyright"}, {"generator"}, {"version"}, {"minVersion"}};
constexpr Property kBuffer[] = {{"uri"}, {"byteLength"}, {"name"}};
constexpr Property kBufferView[] = {{"buffer"}, {"byteOffset"}, {"byteLength"}, {"byteStride"}, {"target"}, {"name"}};
constexpr Property kCamera[] = {
    {"orthographic", Is::orthographic}, {"perspective", Is::perspective}, {"type"}, {"name"}};
constexpr Property kOrthographic[] = {{"xmag"}, {"ymag"}, {"zfar"}, {"znear"}};
constexpr Property kPerspective[] = {{"aspectRatio"}, {"yfov"}, {"zfar"}, {"znear"}};
constexpr Property kImage[] = {{"uri"}, {"mimeType"}, {"bufferView"}, {"name"}};
constexpr Property kMaterial[] = {{"name"},
                                  {"pbrMetallicRoughness", Is::metallic_roughness},
                                  {"normalTexture", Is::normal_texture},
                                  {"occlusionTexture", Is::occlusion_texture},
                                  {"emissiveTexture", Is::texture_info},
                                  {"emissiveFactor"},
                                  {"alphaMode"},
                                  {"alphaCutoff"},
                                  {"doubleSided"}};
constexpr Property kMetallicRoughness[] = {{"baseColorFactor"},
                                           {"baseColorTexture", Is::texture_info},
                                           {"metallicFactor"},
                                           {"roughnessFactor"},
                                           {"metallicRoughnessTexture", Is::texture_info}};
constexpr Property kTextureInfo[] = {{"index"}, {"texCoord"}};
constexpr Property kNormalTexture[] = {{"index"}, {"texCoord"}, {"scale"}};
constexpr Property kOcclusionTexture[] = {{"index"}, {"texCoord"}, {"strength"}};
constexpr Property kMesh[] = {{"primitives", Is::primitive}, {"weights"}, {"name"}};
constexpr Property kPrimitive[] = {
    {"attributes", Is::attributes}, {"indices"}, {"material"}, {"mode"}, {"targets", Is::attributes}};
constexpr Property kAttributes[] = {{"POSITION"}, {"NORMAL"},   {"TANGENT"},  {"TEXCOORD_0"},
                                    {"COLOR_0"},  {"JOINTS_0"}, {"WEIGHTS_0"}};
constexpr Property kNode[] = {{"camera"},   {"children"}, {"skin"},        {"matrix"},  {"mesh"},
                              {"rotation"}, {"scale"},    {"translation"}, {"weights"}, {"name"}};
constexpr Property kSampler[] = {{"magFilter"}, {"minFilter"}, {"wrapS"}, {"wrapT"}, {"name"}};
constexpr Property kScene[] = {{"nodes"}, {"name"}};
constexpr Property kSkin[] = {{"inverseBindMatrices"}, {"skeleton"}, {"joints"}, {"name"}};
constexpr Property kTexture[] = {{"sampler"}, {"source"}, {"name"}};

struct ObjectKind {
    std::string_view what;  ///< for messages
    std::span<const Property> properties;
};
/// In the order of Is.
constexpr ObjectKind kKinds[] = {{"", {}},
                                 {"the file's root", kRoot},
                                 {"an accessor", kAccessor},
                                 {"'sparse'", kSparse},
                                 {"'indices'", kSparseIndices},
                                 {"'values'", kSparseValues},
                                 {"an animation", kAnimation},
                                 {"a channel", kChannel},
                                 {"'target'", kChannelTarget},
                                 {"an animation's sampler", kAnimationSampler},
                                 {"'asset'", kAsset},
                                 {"a buffer", kBuffer},
                                 {"a buffer view", kBufferView},
                                 {"a camera", kCamera},
                                 {"'orthographic'", kOrthographic},
                                 {"'perspective'", kPerspective},
                                 {"an image", kImage},
                                 {"a material", kMaterial},
                                 {"'pbrMetallicRoughness'", kMetallicRoughness},
                                 {"a material's texture", kTextureInfo},
                                 {"'normalTexture'", kNormalTexture},
                                 {"'occlusionTexture'", kOcclusionTexture},
                                 {"a mesh", kMesh},
                                 {"a primitive", kPrimitive},
                                 {"a primitive's attributes", kAttributes},
                                 {"a node", kNode},
                                 {"a sampler", kSampler},
                                 {"a scene", kScene},
                                 {"a skin", kSkin},
                                 {"a texture", kTexture}};
static_assert(std::size(kKinds) == static_cast<size_t>(Is::texture) + 1);

const ObjectKind& kind(Is is) { return kKinds[static_cast<size_t>(is)]; }

/// The property of that name.
const Property* find(Is is, std::string_view key) {
    for (const Property& p : kind(is).properties)
        if (p.key == key) return &p;
    return nullptr;
}

/// Whether objects of one kind alone have it, unlike "name" and "index".
bool tells_its_object(std::string_view key) {
    size_t kinds = 0;
    for (const ObjectKind& k : kKinds)
        for (const Property& p : k.properties) kinds += p.key == key ? 1 : 0;
    return kinds == 1;
}

/// Of a vertex: of their own with an underscore, and in sets by numbers.
bool is_attribute(std::string_view key) {
    if (key.starts_with("_")) return true;
    for (const std::string_view set : {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"})
        if (key.starts_with(set))
            return key.size() > set.size() && key.find_first_not_of("0123456789", set.size()) == key.npos;
    return false;
}

class UnknownProperties {
public:
    explicit UnknownProperties(Context& context) : context_(context) {}

    /// As deep as the specification's objects are, whatever the file has.
    void look_at(Value value, Is is) {
        if (is == Is::leaf) return;
        if (value.is(Kind::array))
            for (const Value element : value.elements())
                if (element.is(Kind::object)) look_at_members(element, is);
        if (value.is(Kind::object)) look_at_members(value, is);
    }

private:
    void look_at_members(Value object, Is is) {
        for (const json::Member m : object.members()) {
            if (const Property* known = find(is, m.key))
                look_at(m.value, known->is);
            else if (m.key != "extensions" && m.key != "extras" && !(is == Is::attributes && is_attribute(m.key)))
                report(m, is);
        }
    }

    void report(const json::Member& m, Is is) {
        const std::string message =
            quoted(m.key) + " is no property of " + std::string(kind(is).what) + " and is ignored";
        if (const std::string& meant = what_is_meant(m.key, is); !meant.empty())
            context_.warn(message + ": " + meant, m.key_offset);
        else if (context_.options.locations)
            context_.unused(message, m.key_offset, "no-effect");
    }

    /// Empty where nothing comes near. To compare names takes a while, so each is looked at once, and of a hostile
    /// file's only the first ones.
    const std::string& what_is_meant(std::string_view key, Is is) {
        static const std::string kNothing;
        constexpr size_t kMost = 1000;
        const std::pair place(is, key);
        if (const auto known = meant_.find(place); known != meant_.end()) return known->second;
        if (meant_.size() >= kMost) return kNothing;
        return meant_.emplace(place, guess(key, is)).first->second;
    }

    static std::string guess(std::string_view key, Is is) {
        std::vector<std::string_view> names{"extensions", "extras"};
        for (const Property& p : kind(is).properties) names.push_back(p.key);
        if (const auto match = closest_match(key, names)) return "did you mean '" + *match + "'?";
        for (const Property& p : kind(is).properties)
            if (find(p.is, key) && tells_its_object(key)) return "it belongs into " + quoted(p.key);
        return {};
    }

    Context& context_;
    std::map<std::pair<Is, std::string_view>, std::string> meant_;
};

}  // namespace

void find_unknown_properties(Context& context, const Object& root) {
    UnknownProperties(context).look_at(root.value(), Is::root);
}

}  // namespace steradian::gltf
