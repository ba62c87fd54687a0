#include "render/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"

namespace steradian {
namespace {

/// Things without a name are called by their number, from 0.
std::string name_of_thing(const std::vector<std::string>& names, size_t i, const char* kind) {
    return i < names.size() && !names[i].empty() ? names[i] : fmt::format("{} {}", kind, i);
}

std::vector<std::string> object_names(const Scene& scene) {
    std::vector<std::string> out;
    for (size_t i = 0; i < scene.instances.size(); ++i)
        out.push_back(name_of_thing(scene.names.instances, i, "object"));
    return out;
}

std::vector<std::string> material_names(const Scene& scene) {
    std::vector<std::string> out;
    for (size_t i = 0; i < scene.materials.size(); ++i)
        out.push_back(name_of_thing(scene.names.materials, i, "material"));
    return out;
}

std::vector<uint32_t> ids_of(const std::vector<std::string>& names) {
    std::vector<uint32_t> out;
    for (const std::string& name : names) out.push_back(matte_id(name));
    return out;
}

std::string quoted_json(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += std::string("\\") + c;
        else if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out += c;
    }
    return out + "\"";
}

/// {"name":"id in hexadecimal",…}, sorted by name, so that equal scenes say the same.
std::string manifest(std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::string out;
    for (const std::string& name : names)
        out += fmt::format("{}{}:\"{:08x}\"", out.empty() ? "" : ",", quoted_json(name), matte_id(name));
    return "{" + out + "}";
}

void describe(const std::string& layer, std::vector<std::string> names, std::map<std::string, std::string>& out) {
    const std::string key = fmt::format("cryptomatte/{}/", fmt::format("{:08x}", matte_id(layer)).substr(0, 7));
    out[key + "name"] = layer;
    out[key + "hash"] = "MurmurHash3_32";
    out[key + "conversion"] = "uint32_to_float32";
    out[key + "manifest"] = manifest(std::move(names));
}

}  // namespace

uint32_t matte_id(std::string_view name) noexcept {
    const uint32_t hash = murmur_hash3(name, 0), exponent = hash >> 23 & 0xff;
    return exponent == 0 || exponent == 0xff ? hash ^ (1u << 23) : hash;
}

void MatteCounts::add(uint32_t id, int32_t samples) {
    for (uint32_t i = 0; i < used_; ++i)
        if (few_[i].id == id) {
            few_[i].samples += samples;
            return;
        }
    if (used_ < kFew) {
        few_[used_++] = {id, samples};
        return;
    }
    const auto at =
        std::lower_bound(more_.begin(), more_.end(), id, [](const Entry& e, uint32_t i) { return e.id < i; });
    if (at != more_.end() && at->id == id)
        at->samples += samples;
    else
        more_.insert(at, {id, samples});
}

MatteCounts::Ranking MatteCounts::ranking() const {
    int64_t total = 0;
    each([&](const Entry& e) { total += e.samples; });
    Ranking out;
    if (total == 0) return out;
    const int64_t sign = total < 0 ? -1 : 1;  // of few samples most may be of negative weight
    std::vector<Entry> covering;
    each([&](const Entry& e) {
        if (e.id != 0 && e.samples * sign > 0) covering.push_back(e);
    });
    const auto most = covering.begin() + ptrdiff_t(std::min<size_t>(covering.size(), kMatteRanks));
    std::partial_sort(covering.begin(), most, covering.end(), [sign](const Entry& a, const Entry& b) {
        return a.samples != b.samples ? a.samples * sign > b.samples * sign : a.id < b.id;
    });
    std::transform(covering.begin(), most, out.begin(), [total](const Entry& e) {
        return Covered{e.id,
                       std::min(static_cast<float>(static_cast<double>(e.samples) / static_cast<double>(total)), 1.0f)};
    });
    return out;
}

MatteIds::MatteIds(const Scene& scene, AovSet aovs) {
    if (aovs.has(Aov::crypto_object)) objects = ids_of(object_names(scene));
    if (aovs.has(Aov::crypto_material)) materials = ids_of(material_names(scene));
}

std::map<std::string, std::string> matte_metadata(const Scene& scene, AovSet aovs) {
    std::map<std::string, std::string> out;
    if (aovs.has(Aov::crypto_object)) describe("CryptoObject", object_names(scene), out);
    if (aovs.has(Aov::crypto_material)) describe("CryptoMaterial", material_names(scene), out);
    return out;
}

}  // namespace steradian
