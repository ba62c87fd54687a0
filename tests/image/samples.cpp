#include "image/samples.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <webp/encode.h>
#include <zlib.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <jpeglib.h>

#include "support/support.h"

namespace steradian::test {

Image sample_image(uint32_t width, uint32_t height, std::vector<std::string> channels) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = std::move(channels);
    const size_t count = size_t(width) * height * image.channels.size();
    for (size_t i = 0; i < count; ++i) {
        const auto x = static_cast<float>((i * 2654435761u % 100003) / 100003.0);
        image.pixels.push_back(std::ldexp(i % 5 == 4 ? -x : x, static_cast<int>(i % 17) - 6));
    }
    return image;
}

std::string encoded(const Image& image, const std::string& name, const ImageWriteOptions& options,
                    Diagnostics* diagnostics) {
    const TemporaryFolder folder;
    const auto status = write_image(folder.file(name), image, options, diagnostics);
    if (!status) throw std::runtime_error(status.error().str());
    return slurp(folder.file(name));
}

std::string jpeg_file(uint32_t width, uint32_t height, int components, bool progressive,
                      const std::vector<unsigned char>& pixels) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* buffer = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &buffer, &size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = components;
    jpeg.in_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < height) {
        auto* row =
            const_cast<unsigned char*>(&pixels[size_t(jpeg.next_scanline) * width * static_cast<size_t>(components)]);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    std::string out(reinterpret_cast<char*>(buffer), size);
    jpeg_destroy_compress(&jpeg);
    std::free(buffer);
    return out;
}

namespace {

std::string big_endian(uint32_t v) {
    return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
}

}  // namespace

std::string png_chunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const auto crc =
        static_cast<uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
    return big_endian(static_cast<uint32_t>(data.size())) + body + big_endian(crc);
}

std::string png_file(uint32_t width, uint32_t height, int bit_depth, int colour_type, const std::string& rows) {
    uLongf size = compressBound(static_cast<uLong>(rows.size()));
    std::string packed(size, '\0');
    compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
              static_cast<uLong>(rows.size()), 9);
    packed.resize(size);
    const std::string header = big_endian(width) + big_endian(height) + static_cast<char>(bit_depth) +
                               static_cast<char>(colour_type) + std::string(3, '\0');
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

std::string webp_file(uint32_t width, uint32_t height, int channels, bool lossless,
                      const std::vector<unsigned char>& pixels) {
    WebPConfig config;
    WebPPicture picture;
    WebPMemoryWriter writer;
    WebPConfigInit(&config), WebPPictureInit(&picture), WebPMemoryWriterInit(&writer);
    config.lossless = lossless ? 1 : 0;
    config.exact = 1;
    picture.use_argb = 1;
    picture.width = static_cast<int>(width), picture.height = static_cast<int>(height);
    picture.writer = WebPMemoryWrite, picture.custom_ptr = &writer;
    const int stride = static_cast<int>(width) * channels;
    const bool good = (channels == 4 ? WebPPictureImportRGBA : WebPPictureImportRGB)(&picture, pixels.data(), stride) &&
                      WebPEncode(&config, &picture);
    std::string out(reinterpret_cast<char*>(writer.mem), good ? writer.size : 0);
    WebPPictureFree(&picture), WebPMemoryWriterClear(&writer);
    return out;
}

Cost cost_of(int (*body)(const void*), const void* argument) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(body(argument));
    int status = 0;
    rusage usage{};
    ::wait4(child, &status, 0, &usage);
    Cost cost;
    cost.peak_bytes = static_cast<uint64_t>(usage.ru_maxrss) * 1024;
    cost.seconds = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                   1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    cost.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return cost;
}

}  // namespace steradian::test
