#include "formats/gltf/context.h"

#include <algorithm>
#include <array>
#include <set>

#include "base/text.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

/// What can be required of us: all of it is honoured, or reported where it is not.
constexpr std::array<std::string_view, 21> kExtensions{"KHR_draco_mesh_compression",
                                                       "KHR_lights_punctual",
                                                       "KHR_materials_anisotropy",
                                                       "KHR_materials_clearcoat",
                                                       "KHR_materials_diffuse_transmission",
                                                       "KHR_materials_dispersion",
                                                       "KHR_materials_emissive_strength",
                                                       "KHR_materials_ior",
                                                       "KHR_materials_iridescence",
                                                       "KHR_materials_pbrSpecularGlossiness",
                                                       "KHR_materials_sheen",
                                                       "KHR_materials_specular",
                                                       "KHR_materials_transmission",
                                                       "KHR_materials_unlit",
                                                       "KHR_materials_variants",
                                                       "KHR_materials_volume",
                                                       "KHR_mesh_quantization",
                                                       "KHR_texture_transform",
                                                       "EXT_mesh_gpu_instancing",
                                                       "EXT_meshopt_compression",
                                                       "EXT_texture_webp"};

bool is_known(std::string_view name) {
    return std::find(kExtensions.begin(), kExtensions.end(), name) != kExtensions.end();
}

/// Calls `visit` for every member of an "extensions" object, in the order of the text. "extras" are the author's own.
template <class Visit>
void each_extension(Value root, Visit visit) {
    std::vector<Value> open{root};
    while (!open.empty()) {
        const Value value = open.back();
        open.pop_back();
        const auto first = static_cast<std::ptrdiff_t>(open.size());
        if (value.is(Kind::array))
            for (const Value element : value.elements()) open.push_back(element);
        if (value.is(Kind::object))
            for (const json::Member member : value.members()) {
                if (member.key == "extensions" && member.value.is(Kind::object))
                    for (const json::Member extension : member.value.members()) visit(extension);
                if (member.key != "extras") open.push_back(member.value);
            }
        std::reverse(open.begin() + first, open.end());
    }
}

}  // namespace

std::string remedy(std::string_view extension) {
    if (extension == "KHR_texture_basisu")
        return "its textures are KTX2 files: export them as PNG, JPEG or WebP, or convert the file: 'gltf-transform "
               "ktxdecompress IN OUT'";
    return {};
}

Tables::Tables(const Object& root) {
    for (Table* table : {&accessors, &animations, &buffer_views, &buffers, &cameras, &images, &materials, &meshes,
                         &nodes, &samplers, &scenes, &skins, &textures})
        table->elements = root.array(table->key);
    if (const auto punctual = root.extension("KHR_lights_punctual")) lights.elements = punctual->array(lights.key);
    if (const auto all = root.extension("KHR_materials_variants")) variants.elements = all->array(variants.key);
}

/// How many of the bytes had not been covered.
uint64_t Budget::cover(std::span<const std::byte> bytes) {
    if (bytes.empty()) return 0;
    const std::byte *begin = bytes.data(), *end = begin + bytes.size();
    auto at = covered_.upper_bound(begin);
    if (at != covered_.begin() && std::prev(at)->second >= begin) --at;
    uint64_t known = 0;
    while (at != covered_.end() && at->first <= end) {
        known += static_cast<uint64_t>(at->second - at->first);
        begin = min_of(begin, at->first);
        end = max_of(end, at->second);
        at = covered_.erase(at);
    }
    covered_.emplace(begin, end);
    return static_cast<uint64_t>(end - begin) - known;
}

void Budget::grant(std::span<const std::byte> used) { read_ += cover(used); }

void Budget::refuse(uint64_t limit, const Source& source, size_t offset) const {
    source.fail(offset,
                "this makes more than " + std::to_string(limit >> 20) + " MiB of " + std::to_string(read_) +
                    " bytes, expected at most " + std::to_string(kMaxExpansion) + " times as much",
                "if the file is to be trusted, --gltf-memory allows more", ErrorCode::resources);
}

void Budget::take(uint64_t bytes, const Source& source, size_t offset) {
    const uint64_t limit = max_of(free_, kMaxExpansion * read_);
    if (bytes > limit - taken_) refuse(limit, source, offset);
    taken_ += bytes;
}

void Budget::take_unread(uint64_t bytes, const Source& source, size_t offset) {
    if (bytes > free_ - unread_)
        source.fail(offset, "this makes more than " + std::to_string(free_ >> 20) + " MiB of what stands in no file",
                    "if the file is to be trusted, --gltf-memory allows more", ErrorCode::resources);
    unread_ += bytes;
    take(bytes, source, offset);
}

void Context::say(Diagnostics& list, std::set<std::string>& said, std::string message, size_t offset,
                  std::string rule) {
    const bool known = said.contains(message);
    if (!known && said.size() >= kMaxDifferent) message = "and others of which there are too many to list";
    // The place is that of the first one; to find the pointer of each would take long in a large file.
    const bool first = said.insert(message).second;
    list.warn(std::move(message), first ? source.where(offset) : SourceLocation{}, 1, std::move(rule));
}

void check_extensions(Context& context, const Object& root) {
    for (const Value value : root.array("extensionsRequired")) {
        const std::string_view name = json::read_string(context.source, value, "an element of 'extensionsRequired'");
        if (!is_known(name))
            context.source.fail(value.offset(),
                                "the file requires the extension " + quoted(name) + ", which is not supported",
                                remedy(name));
    }
    std::set<std::string_view> in_use;
    each_extension(root.value(), [&](const json::Member& member) {
        if (is_known(member.key)) return;
        context.not_honoured("the extension " + quoted(member.key) + " is not supported and has no effect",
                             member.key_offset);
        if (context.options.locations) in_use.insert(member.key);
    });
    for (const Value value : root.array("extensionsUsed")) {
        const std::string_view name = json::read_string(context.source, value, "an element of 'extensionsUsed'");
        if (context.options.locations && !is_known(name) && !in_use.contains(name))
            context.unused("the extension " + quoted(name) + " of 'extensionsUsed' is not known, and nothing uses it",
                           value.offset());
    }
}

std::vector<std::string> variant_names(const Context& context) {
    std::vector<std::string> names;
    for (const Value value : context.tables.variants.elements)
        names.emplace_back(Object(context.source, value, "a variant").string_or("name", ""));
    return names;
}

uint32_t find_variant(const Context& context, std::string_view name) {
    const std::vector<std::string> names = variant_names(context);
    const std::vector<std::string_view> views(names.begin(), names.end());
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<uint32_t>(found - names.begin());
    throw json::ReadFailure{Error{ErrorCode::usage,
                                  "there is no variant called " + quoted(name),
                                  {context.source.name(), 0, 0},
                                  {},
                                  names.empty() ? "the file has no variants" : suggestion(name, views)}};
}

std::string name_of(const Object& element, std::string_view what, uint32_t number) {
    const std::string_view name = element.string_or("name", "");
    return name.empty() ? std::string(what) + " " + std::to_string(number) : std::string(name);
}

}  // namespace steradian::gltf
