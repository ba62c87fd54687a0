#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <vector>

#include "base/text.h"
#include "image/codec.h"
#include "image/view.h"
#include "math/vector.h"

namespace steradian::codec {
namespace {

/// What the C callbacks reach. Everything with a destructor lives outside of the function that setjmp guards.
struct Writer {
    std::string out;
    std::string message;
    uint32_t width = 0, height = 0;
    int colour_type = 0;
    std::vector<png_bytep> rows;
    std::vector<png_text> texts;
};

void on_error(png_structp png, png_const_charp message) {
    auto* writer = static_cast<Writer*>(png_get_error_ptr(png));
    try {
        if (writer->message.empty()) writer->message = message;
    } catch (...) {
        // Without memory for the message the error is reported without it.
    }
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_write(png_structp png, png_bytep data, size_t size) {
    auto* writer = static_cast<Writer*>(png_get_io_ptr(png));
    bool failed = false;
    try {
        writer->out.append(reinterpret_cast<const char*>(data), size);
    } catch (...) {
        failed = true;
    }
    if (failed) png_error(png, "out of memory");
}

/// False after an error, whose text is then in writer.message.
bool write_png(Writer& writer, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &writer, on_write, nullptr);
    // What the format can hold, not libpng's guard of a million against hostile files.
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    // Fixed, so that equal pictures are equal files.
    png_set_compression_level(png, 6);
    png_set_compression_strategy(png, Z_DEFAULT_STRATEGY);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
    png_set_IHDR(png, info, writer.width, writer.height, 8, writer.colour_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
    if (!writer.texts.empty()) png_set_text(png, info, writer.texts.data(), static_cast<int>(writer.texts.size()));
    png_write_info(png, info);
    png_write_image(png, writer.rows.data());
    png_write_end(png, info);
    return true;
}

void count_not_finite(const Image& image, const ColourChannels& colour, const std::string& path,
                      Diagnostics& diagnostics) {
    uint64_t pixels = 0;
    for (size_t at = 0; at < image.pixels.size(); at += image.channels.size()) {
        bool finite = !colour.alpha || is_finite(image.pixels[at + *colour.alpha]);
        for (size_t c = 0; c < colour.count; ++c) finite = finite && is_finite(image.pixels[at + colour.index[c]]);
        pixels += !finite;
    }
    if (pixels)
        diagnostics.warn("a pixel has values that are not finite: NaN was written as 0, infinity as the brightest",
                         {path, 0, 0, {}}, pixels);
}

std::vector<png_byte> to_bytes(const Image& image, const ColourChannels& colour, const View& view) {
    const SrgbQuantizer quantize;
    const size_t step = image.channels.size();
    const size_t pixels = size_t(image.width) * image.height;
    std::vector<png_byte> bytes;
    bytes.reserve(pixels * (colour.count + (colour.alpha ? 1 : 0)));
    for (size_t i = 0; i < pixels; ++i) {
        const float* pixel = &image.pixels[i * step];
        const Rgb shown = view(
            {pixel[colour.index[0]], pixel[colour.index[colour.count / 2]], pixel[colour.index[colour.count - 1]]});
        for (size_t c = 0; c < colour.count; ++c) bytes.push_back(quantize(shown[static_cast<int>(c)]));
        if (colour.alpha)
            bytes.push_back(static_cast<png_byte>(clamp_to(pixel[*colour.alpha], 0.0f, 1.0f) * 255.0f + 0.5f));
    }
    return bytes;
}

/// PNG keywords are 1 to 79 printable Latin-1 characters; we keep to ASCII.
bool is_keyword(const std::string& key) {
    const bool printable = std::all_of(key.begin(), key.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
    return printable && !key.empty() && key.size() <= 79 && key.front() != ' ' && key.back() != ' ' &&
           key.find("  ") == key.npos;
}

void add_texts(Writer& writer, const Image& image, const std::string& path, Diagnostics& diagnostics) {
    for (const auto& [key, text] : image.metadata) {
        if (!is_keyword(key) || text.find('\0') != text.npos) {
            diagnostics.warn(
                fmt::format("PNG cannot hold the text attribute '{}': left out", escape_for_display(key, 80)),
                {path, 0, 0, {}});
            continue;
        }
        const bool ascii =
            std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
        png_text entry{};
        entry.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        entry.key = const_cast<char*>(key.c_str());
        entry.text = const_cast<char*>(text.c_str());
        (ascii ? entry.text_length : entry.itxt_length) = text.size();
        writer.texts.push_back(entry);
    }
}

}  // namespace

std::string encode_png(const Image& image, const ImageWriteOptions& options, const std::string& path,
                       Diagnostics& diagnostics) {
    const auto view = find_view(options.view, options.exposure);
    if (!view)
        throw Failure{{ErrorCode::usage,
                       fmt::format("there is no view transform '{}'", escape_for_display(options.view, 64)),
                       {path, 0, 0, {}},
                       {},
                       suggestion(options.view, view_names())}};
    const ColourChannels colour = colour_channels(image, "PNG", true, path, diagnostics);
    count_not_finite(image, colour, path, diagnostics);
    std::vector<png_byte> bytes = to_bytes(image, colour, *view);

    Writer writer;
    writer.width = image.width;
    writer.height = image.height;
    writer.colour_type = (colour.count == 3 ? PNG_COLOR_MASK_COLOR : 0) | (colour.alpha ? PNG_COLOR_MASK_ALPHA : 0);
    const size_t row_bytes = size_t(image.width) * (colour.count + (colour.alpha ? 1 : 0));
    for (size_t y = 0; y < image.height; ++y) writer.rows.push_back(bytes.data() + y * row_bytes);
    add_texts(writer, image, path, diagnostics);

    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool done = info && write_png(writer, png, info);
    png_destroy_write_struct(&png, &info);
    if (!done)
        throw Failure{{ErrorCode::resources,
                       "cannot encode as PNG: " + (writer.message.empty() ? "out of memory" : writer.message),
                       {path, 0, 0, {}},
                       {},
                       {}}};
    return std::move(writer.out);
}

}  // namespace steradian::codec
