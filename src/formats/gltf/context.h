// What all parts of the glTF reader share.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "formats/assets.h"
#include "formats/gltf/object.h"

namespace steradian::gltf {

/// The arrays that elements are referred to in.
struct Tables {
    Table animations{"animations", "animation"};
    Table accessors{"accessors", "accessor"}, buffer_views{"bufferViews", "buffer view"}, buffers{"buffers", "buffer"};
    Table cameras{"cameras", "camera"}, images{"images", "image"}, lights{"lights", "light"};
    Table materials{"materials", "material"}, meshes{"meshes", "mesh"}, nodes{"nodes", "node"};
    Table samplers{"samplers", "sampler"}, scenes{"scenes", "scene"}, skins{"skins", "skin"};
    Table textures{"textures", "texture"};
    Table variants{"variants", "variant"};

    explicit Tables(const Object& root);
};

/// What a file may make of itself, geometry and texels together: kMaxExpansion times the bytes that accessors,
/// compressed data and images take of it, or LoadOptions::gltf_free_bytes if that is more; what is made of no bytes at
/// all never more than those. So that a small file cannot ask for any amount of memory by naming the same data over and
/// over, by leaving them out, or with pictures of one colour, which are large in files that are tiny; nor a file that
/// is padded.
class Budget {
public:
    static constexpr uint64_t kMaxExpansion = 256;
    explicit Budget(uint64_t free_bytes) : free_(free_bytes) {}

    /// Bytes of the file that are in use; each counts once, however often this is said of it.
    void grant(std::span<const std::byte> used);
    /// These bytes were made, not read: grant() counts them for nothing.
    void disown(std::span<const std::byte> made) { cover(made); }
    /// So many nodes, each of which takes some bytes of text: the rest of the text counts for nothing.
    void grant_nodes(uint64_t count) noexcept { read_ += count * kNodeBytes; }

    /// Fails at `offset` when there is no more. Call them before the memory is taken.
    void take(uint64_t bytes, const Source& source, size_t offset);
    /// For what stands in no file, such as the zeros of accessors without data.
    void take_unread(uint64_t bytes, const Source& source, size_t offset);

private:
    static constexpr uint64_t kNodeBytes = 2;  ///< "{}"
    uint64_t cover(std::span<const std::byte> bytes);
    [[noreturn]] void refuse(uint64_t limit, const Source& source, size_t offset) const;

    uint64_t free_, read_ = 0, taken_ = 0, unread_ = 0;
    std::map<const std::byte*, const std::byte*> covered_;  ///< from begin to end; they do not touch
};

class Context {
public:
    Context(const Source& source_, const Tables& tables_, const LoadOptions& options_, LoadedScene& loaded_,
            Assets& assets_)
        : source(source_), tables(tables_), options(options_), loaded(loaded_), assets(assets_) {}

    const Source& source;
    const Tables& tables;
    const LoadOptions& options;
    LoadedScene& loaded;
    Assets& assets;
    std::optional<uint32_t> variant;  ///< the chosen one
    Budget budget{options.gltf_free_bytes};

    /// Something in the file is not as it should be, and the picture can be made nevertheless.
    void warn(std::string message, size_t offset, std::string rule = {}) {
        say(loaded.diagnostics, warned_, std::move(message), offset, std::move(rule));
    }
    /// Something that the file says is left out or only come near to.
    void not_honoured(std::string message, size_t offset) {
        say(loaded.fidelity, reported_, std::move(message), offset);
    }
    /// Nothing refers to it, or it has no effect on purpose: `rule` is the one of lint that says so.
    void unused(std::string message, size_t offset, std::string rule = {}) {
        say(loaded.unused, unused_, std::move(message), offset, std::move(rule));
    }

private:
    /// A hostile file can make any number of different messages: so many are kept.
    static constexpr size_t kMaxDifferent = 100;
    void say(Diagnostics& list, std::set<std::string>& said, std::string message, size_t offset, std::string rule = {});

    std::set<std::string> warned_, reported_, unused_;
};

/// What to do about a well-known extension that we do not have, for hints.
std::string remedy(std::string_view extension);

/// Fails when the file requires an extension that is not there; reports those that it uses only.
void check_extensions(Context& context, const Object& root);

/// As the file has them; those without a name are empty.
std::vector<std::string> variant_names(const Context& context);
/// The variant of that name among those of the file; fails where there is none.
uint32_t find_variant(const Context& context, std::string_view name);

/// The element's name, or "mesh 3".
std::string name_of(const Object& element, std::string_view what, uint32_t number);

}  // namespace steradian::gltf
