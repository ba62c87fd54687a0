#include <fmt/format.h>

#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <new>
// After cstdio and cstddef, whose types it uses.
#include <jerror.h>
#include <jpeglib.h>

#include "base/text.h"
#include "image/codec.h"

namespace steradian::codec {
namespace {

/// libjpeg's state with ours around it. Nothing in here has a destructor that longjmp could skip.
struct Session {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    std::jmp_buf jump;
    uint64_t max_work = 0;  ///< scans × pixels
    char message[JMSG_LENGTH_MAX] = {};
    bool out_of_memory = false;
};

Session& session_of(j_common_ptr jpeg) { return *static_cast<Session*>(jpeg->client_data); }

[[noreturn]] void on_error(j_common_ptr jpeg) {
    Session& session = session_of(jpeg);
    session.out_of_memory = jpeg->err->msg_code == JERR_OUT_OF_MEMORY;
    jpeg->err->format_message(jpeg, session.message);
    std::longjmp(session.jump, 1);
}

/// Warnings that mean missing or invented pixels are errors; the others are harmless.
void on_message(j_common_ptr jpeg, int level) {
    if (level >= 0) return;
    switch (jpeg->err->msg_code) {
        case JWRN_JPEG_EOF:
        case JWRN_HIT_MARKER:
        case JWRN_HUFF_BAD_CODE:
        case JWRN_MUST_RESYNC:
            on_error(jpeg);
        default:
            return;
    }
}

void on_output(j_common_ptr) {}

/// A progressive file can repeat scans that cost a byte each and a pass over the picture each.
void on_progress(j_common_ptr jpeg) {
    Session& session = session_of(jpeg);
    const uint64_t pixels = uint64_t(session.jpeg.image_width) * session.jpeg.image_height;
    if (static_cast<uint64_t>(session.jpeg.input_scan_number) * pixels <= session.max_work) return;
    std::snprintf(session.message, sizeof session.message, "%d scans are too many for a file of this size",
                  session.jpeg.input_scan_number);
    std::longjmp(session.jump, 1);
}

bool read_header(Session& session, std::string_view bytes) {
    if (setjmp(session.jump)) return false;
    jpeg_create_decompress(&session.jpeg);
    jpeg_mem_src(&session.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()),
                 static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&session.jpeg, TRUE);
    return true;
}

bool read_pixels(Session& session, unsigned char* out, size_t row_bytes) {
    if (setjmp(session.jump)) return false;
    session.jpeg.progress = &session.progress;
    // Raw and the same everywhere: the exact integer transform, and nothing smoothed over.
    session.jpeg.dct_method = JDCT_ISLOW;
    session.jpeg.do_fancy_upsampling = TRUE;
    session.jpeg.do_block_smoothing = FALSE;
    session.jpeg.out_color_space = session.jpeg.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_start_decompress(&session.jpeg);
    while (session.jpeg.output_scanline < session.jpeg.output_height) {
        JSAMPROW row = out + session.jpeg.output_scanline * row_bytes;
        jpeg_read_scanlines(&session.jpeg, &row, 1);
    }
    jpeg_finish_decompress(&session.jpeg);
    return true;
}

struct Destroyer {
    Session& session;
    ~Destroyer() { jpeg_destroy_decompress(&session.jpeg); }
};

void check_header(const Source& source, Session& session) {
    const jpeg_decompress_struct& jpeg = session.jpeg;
    const bool grey = jpeg.num_components == 1 && jpeg.jpeg_color_space == JCS_GRAYSCALE;
    const bool colour =
        jpeg.num_components == 3 && (jpeg.jpeg_color_space == JCS_YCbCr || jpeg.jpeg_color_space == JCS_RGB);
    if (jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK)
        source.fail("CMYK pictures are not supported, expected a grey or an RGB JPEG");
    if (!grey && !colour)
        source.fail(fmt::format("a JPEG of {} components is not supported, expected grey or RGB", jpeg.num_components));
    const uint64_t values = uint64_t(jpeg.image_width) * jpeg.image_height * static_cast<uint64_t>(jpeg.num_components);
    // Bytes and then floats; with several scans, 16-bit coefficients of the whole picture before them.
    const bool buffered = jpeg_has_multiple_scans(&session.jpeg);
    source.check_size(jpeg.image_width, jpeg.image_height, values * (sizeof(float) + (buffered ? 2 : 0)));
    session.max_work = std::max(kFreeBytes, source.bytes.size() * kMaxExpansion);
}

}  // namespace

Decoded decode_jpeg(const Source& source) {
    Session session;
    session.jpeg.err = jpeg_std_error(&session.errors);
    session.errors.error_exit = on_error;
    session.errors.emit_message = on_message;
    session.errors.output_message = on_output;
    session.progress.progress_monitor = on_progress;
    session.jpeg.client_data = &session;
    const Destroyer destroyer{session};
    const auto check = [&](bool good) {
        if (good) return;
        if (session.out_of_memory) throw std::bad_alloc();
        const size_t left = session.jpeg.src ? session.jpeg.src->bytes_in_buffer : 0;
        source.fail("cannot decode the JPEG: " + escape_for_display(session.message),
                    source.bytes.size() - std::min(left, source.bytes.size()));
    };
    check(read_header(session, source.bytes));
    check_header(source, session);
    Decoded out;
    out.raw.width = session.jpeg.image_width;
    out.raw.height = session.jpeg.image_height;
    out.raw.channels = static_cast<uint8_t>(session.jpeg.num_components);
    const size_t row_bytes = size_t(out.raw.width) * out.raw.channels;
    out.raw.data.resize(row_bytes * out.raw.height);
    check(read_pixels(session, reinterpret_cast<unsigned char*>(out.raw.data.data()), row_bytes));
    return out;
}

}  // namespace steradian::codec
