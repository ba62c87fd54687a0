#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <vector>

#include "base/text.h"
#include "image/codec.h"

namespace steradian::codec {
namespace {

/// What the C callbacks reach. Everything with a destructor lives outside of the functions that setjmp guards.
struct Reader {
    const Source& source;
    size_t position = 0;
    std::string message;
    RawImage raw;
    std::vector<png_bytep> rows;
};

void on_error(png_structp png, png_const_charp message) {
    auto* reader = static_cast<Reader*>(png_get_error_ptr(png));
    try {
        if (reader->message.empty()) reader->message = message;
    } catch (...) {
        // Without memory for the message the error is reported without it.
    }
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep data, size_t size) {
    auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
    const std::string_view bytes = reader->source.bytes;
    if (size > bytes.size() - reader->position) {
        reader->position = bytes.size();
        png_error(png, "the file ends early");
    }
    std::memcpy(data, bytes.data() + reader->position, size);
    reader->position += size;
}

/// libpng takes memory for what a chunk claims to hold before it reads it: so each must be there.
void check_chunks(const Source& source) {
    const std::string_view bytes = source.bytes;
    constexpr size_t kSignature = 8, kFrame = 12;  // length, type and checksum around the data
    for (size_t at = kSignature; at != bytes.size();) {
        if (bytes.size() - at < kFrame) source.fail("the PNG ends within a chunk", bytes.size());
        uint64_t length = 0;
        for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(bytes[at + i]);
        const std::string_view type = bytes.substr(at + 4, 4);
        if (length > bytes.size() - at - kFrame)
            source.fail(fmt::format("the PNG chunk {} claims {} bytes, the file has {} left", escape_for_display(type),
                                    length, bytes.size() - at - kFrame),
                        at);
        if (type == "IEND") return;
        at += kFrame + length;
    }
    source.fail("the PNG ends without its last chunk", bytes.size());
}

/// The header, with everything expanded to 8 or 16 bits of grey, grey + alpha, RGB or RGBA.
bool read_header(Reader& reader, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, &reader, on_read);
    // Sizes are checked by us, with better messages; text is bounded so that it cannot be a bomb.
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_chunk_malloc_max(png, 1 << 20);
    png_set_chunk_cache_max(png, 64);
    png_read_info(png, info);
    const png_byte type = png_get_color_type(png, info);
    if (type == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
    if (type == PNG_COLOR_TYPE_GRAY && png_get_bit_depth(png, info) < 8) png_set_expand_gray_1_2_4_to_8(png);
    if (png_get_valid(png, info, PNG_INFO_tRNS)) png_set_tRNS_to_alpha(png);
    if (png_get_bit_depth(png, info) == 16) png_set_swap(png);
    png_set_interlace_handling(png);
    return true;
}

bool update_info(png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_update_info(png, info);
    return true;
}

bool read_rows(Reader& reader, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, reader.rows.data());
    png_read_end(png, info);
    return true;
}

/// What the rows of the file take when they are unpacked from deflate.
uint64_t packed_bytes(png_structp png, png_infop info) {
    const uint64_t bits = uint64_t(png_get_bit_depth(png, info)) * png_get_channels(png, info);
    return ((png_get_image_width(png, info) * bits + 7) / 8 + 1) * png_get_image_height(png, info);
}

void check_header(const Reader& reader, png_structp png, png_infop info) {
    const Source& source = reader.source;
    const uint64_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    // At most four channels, and as floats in the end.
    source.check_size(width, height, width * height * 4);
    const uint64_t packed = packed_bytes(png, info);
    if (packed / kMaxDeflateRatio > source.bytes.size())
        source.fail(
            fmt::format("{} × {} pixels cannot be in a PNG file of {} bytes", width, height, source.bytes.size()), 16);
}

void allocate(Reader& reader, png_structp png, png_infop info) {
    RawImage& raw = reader.raw;
    raw.width = png_get_image_width(png, info);
    raw.height = png_get_image_height(png, info);
    raw.channels = png_get_channels(png, info);
    const bool wide = png_get_bit_depth(png, info) == 16;
    raw.format = wide ? TexelFormat::u16 : TexelFormat::u8;
    const size_t row_bytes = size_t(raw.width) * raw.channels * (wide ? 2 : 1);
    if (row_bytes != png_get_rowbytes(png, info)) reader.source.fail("the PNG's layout is not supported");
    const uint64_t as_floats = uint64_t(raw.width) * raw.height * raw.channels * sizeof(float);
    reader.source.check_size(raw.width, raw.height, as_floats);
    raw.data.resize(row_bytes * raw.height);
    for (size_t y = 0; y < raw.height; ++y)
        reader.rows.push_back(reinterpret_cast<png_bytep>(raw.data.data()) + y * row_bytes);
}

std::map<std::string, std::string> text_of(png_structp png, png_infop info) {
    png_textp texts = nullptr;
    const int count = png_get_text(png, info, &texts, nullptr);
    std::map<std::string, std::string> out;
    for (int i = 0; i < count; ++i)
        if (texts[i].key && texts[i].text) out.emplace(texts[i].key, texts[i].text);
    return out;
}

/// Owns libpng's two structures.
struct Session {
    png_structp png = nullptr;
    png_infop info = nullptr;
    explicit Session(Reader& reader) {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning);
        info = png ? png_create_info_struct(png) : nullptr;
    }
    ~Session() { png_destroy_read_struct(&png, &info, nullptr); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
};

}  // namespace

Decoded decode_png(const Source& source) {
    check_chunks(source);
    Reader reader{source, 0, {}, {}, {}};
    const Session session(reader);
    if (!session.info) throw std::bad_alloc();
    const auto check = [&](bool good) {
        if (!good) source.fail("cannot decode the PNG: " + escape_for_display(reader.message), reader.position);
    };
    check(read_header(reader, session.png, session.info));
    check_header(reader, session.png, session.info);
    check(update_info(session.png, session.info));
    allocate(reader, session.png, session.info);
    check(read_rows(reader, session.png, session.info));
    return {std::move(reader.raw), text_of(session.png, session.info)};
}

}  // namespace steradian::codec
