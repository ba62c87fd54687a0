#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/text.h"
#include "image/codec.h"

namespace steradian::codec {
namespace {

constexpr float kHalfMax = 65504;

/// Collects what OpenEXR writes; it seeks back to fill in the table of offsets.
class MemoryWriter : public Imf::OStream {
public:
    MemoryWriter() : OStream("memory") {}
    void write(const char c[], int n) override {
        const auto count = static_cast<size_t>(n);
        if (bytes_.size() < position_ + count) bytes_.resize(position_ + count);
        std::memcpy(bytes_.data() + position_, c, count);
        position_ += count;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = static_cast<size_t>(position); }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    size_t position_ = 0;
};

/// Rec. 709 primaries and D65, which are also OpenEXR's defaults; stated so that readers need not guess.
Imf::Header make_header(const Image& image, const std::string& path) {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());
    for (const auto& [key, text] : image.metadata) {
        // The names that OpenEXR itself gives a meaning and another type would make an unreadable file.
        static constexpr std::string_view kReserved[] = {
            "name", "type", "tiles", "version", "chunkCount", "preview", "maxSamplesPerPixel", "view"};
        const bool taken = header.find(key.c_str()) != header.end() ||
                           std::find(std::begin(kReserved), std::end(kReserved), key) != std::end(kReserved);
        if (key.empty() || key.size() > 255 || key.find('\0') != key.npos || taken)
            throw Failure{
                {ErrorCode::usage,
                 fmt::format("'{}' cannot be the name of a text attribute of an EXR file", escape_for_display(key)),
                 {path, 0, 0, {}},
                 {},
                 {}}};
        header.insert(key, Imf::StringAttribute(text));
    }
    return header;
}

/// Half has no values beyond ±65504: clamps those, infinities too, and says how many. NaN stays.
std::vector<half> to_half(const std::vector<float>& pixels, const std::string& path, Diagnostics& diagnostics) {
    std::vector<half> out;
    out.reserve(pixels.size());
    uint64_t clamped = 0;
    for (float value : pixels) {
        if (value > kHalfMax || value < -kHalfMax) {
            ++clamped;
            value = value > 0 ? kHalfMax : -kHalfMax;
        }
        out.emplace_back(value);
    }
    if (clamped)
        diagnostics.warn("a value beyond ±65504 was clamped, the most that half precision holds", {path, 0, 0, {}},
                         clamped);
    return out;
}

}  // namespace

std::string encode_exr(const Image& image, ExrPrecision precision, const std::string& path, Diagnostics& diagnostics) {
    Imf::Header header = make_header(image, path);
    if (!std::is_sorted(image.channels.begin(), image.channels.end(), channel_before)) {
        // EXR sorts its channels; a picture in another than the usual order says so, to be read back as it was.
        std::string order;
        for (const std::string& name : image.channels) order += (order.empty() ? "" : ",") + name;
        header.insert(kChannelOrder, Imf::StringAttribute(order));
    }
    const bool as_half = precision == ExrPrecision::half;
    const Imf::PixelType type = as_half ? Imf::HALF : Imf::FLOAT;
    const std::vector<half> halves = as_half ? to_half(image.pixels, path, diagnostics) : std::vector<half>();
    const char* base =
        as_half ? reinterpret_cast<const char*>(halves.data()) : reinterpret_cast<const char*>(image.pixels.data());
    const size_t value_size = as_half ? sizeof(half) : sizeof(float);
    const size_t pixel_size = value_size * image.channels.size();

    Imf::FrameBuffer frame;
    for (size_t c = 0; c < image.channels.size(); ++c) {
        header.channels().insert(image.channels[c], Imf::Channel(type));
        frame.insert(image.channels[c],
                     Imf::Slice(type, const_cast<char*>(base + c * value_size), pixel_size, pixel_size * image.width));
    }
    MemoryWriter writer;
    {
        Imf::OutputFile file(writer, header, 0);
        file.setFrameBuffer(frame);
        file.writePixels(static_cast<int>(image.height));
    }  // the destructor writes the table of offsets
    return writer.take();
}

}  // namespace steradian::codec
