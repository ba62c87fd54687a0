#include <fmt/format.h>

#include <cmath>
#include <new>
#include <set>

#include "base/file.h"
#include "base/text.h"
#include "image/codec.h"

namespace steradian {
namespace {

Error usage_error(const std::string& path, std::string message, std::string hint = {}) {
    return {ErrorCode::usage, std::move(message), {path, 0, 0, {}}, {}, std::move(hint)};
}

/// A picture that any encoder may trust.
Status check_image(const Image& image, const std::string& path) {
    if (image.width == 0 || image.height == 0 || image.channels.empty())
        return usage_error(path, "an empty picture cannot be written");
    constexpr uint32_t kMaxSide = 0x7fffffff;
    const uint64_t count = uint64_t(image.width) * image.height;
    if (image.width > kMaxSide || image.height > kMaxSide || image.pixels.size() / image.channels.size() != count ||
        image.pixels.size() % image.channels.size() != 0)
        return usage_error(path, fmt::format("the picture is {} × {} with {} channels but holds {} values", image.width,
                                             image.height, image.channels.size(), image.pixels.size()));
    if (!image.types.empty() && image.types.size() != image.channels.size())
        return usage_error(path, fmt::format("the picture has {} channels and types of {}", image.channels.size(),
                                             image.types.size()));
    std::set<std::string> names;
    for (const std::string& name : image.channels)
        if (name.empty() || name.size() > 255 || name.find('\0') != name.npos || !names.insert(name).second)
            return usage_error(path, fmt::format("'{}' is no usable channel name: empty, too long or there twice",
                                                 escape_for_display(name, 64)));
    return Ok{};
}

std::string encode(const std::string& extension, const std::string& path, const Image& image,
                   const ImageWriteOptions& options, Diagnostics& diagnostics) {
    if (extension == ".exr") return codec::encode_exr(image, options.exr, path, diagnostics);
    if (extension == ".png") return codec::encode_png(image, options, path, diagnostics);
    if (extension == ".hdr") return codec::encode_hdr(image, path, diagnostics);
    if (extension == ".pfm") return codec::encode_pfm(image, path, diagnostics);
    throw codec::Failure{usage_error(path, "this file name does not say a known picture format",
                                     "expected one of .exr, .hdr, .pfm, .png")};
}

}  // namespace

Status write_image(const std::string& path, const Image& image, const ImageWriteOptions& options,
                   Diagnostics* diagnostics) {
    if (auto status = check_image(image, path); !status) return status;
    if (!std::isfinite(options.exposure)) return usage_error(path, "the exposure must be a finite number of stops");
    try {
        Diagnostics local;
        const std::string bytes = encode(extension_of(path), path, image, options, local);
        if (auto status = replace_file(path, bytes); !status) return status;
        if (diagnostics) diagnostics->append(local);
        return Ok{};
    } catch (codec::Failure& failure) {
        return std::move(failure.error);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::resources, "not enough memory to write the picture", {path, 0, 0, {}}, {}, {}};
    } catch (const std::exception& error) {
        return Error{ErrorCode::resources,
                     fmt::format("cannot encode the picture: {}", escape_for_display(error.what())),
                     {path, 0, 0, {}},
                     {},
                     {}};
    }
}

}  // namespace steradian
