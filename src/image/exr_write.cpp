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

/// A channel by itself, in another type than the picture's. Half has no values beyond ±65504, a whole number none
/// outside 0 … 2³² - 1: clamps those, and says how many. NaN stays in half and is 0 as a whole number.
struct Plane {
    std::vector<half> halves;
    std::vector<uint32_t> wholes;
};

Plane plane_of(const Image& image, size_t channel, Imf::PixelType type, uint64_t& clamped) {
    Plane out;
    const size_t channels = image.channels.size(), count = image.pixels.size() / channels;
    type == Imf::HALF ? out.halves.reserve(count) : out.wholes.reserve(count);
    for (size_t i = channel; i < image.pixels.size(); i += channels) {
        float value = image.pixels[i];
        if (type == Imf::HALF) {
            clamped += value > kHalfMax || value < -kHalfMax;
            if (value > kHalfMax || value < -kHalfMax) value = value > 0 ? kHalfMax : -kHalfMax;
            out.halves.emplace_back(value);
        } else {
            const bool inside = value >= 0 && value < 0x1p32f;
            clamped += !inside;
            out.wholes.push_back(inside ? static_cast<uint32_t>(value) : value > 0 ? 0xffffffffu : 0);
        }
    }
    return out;
}

/// Depths, positions, texture coordinates and variances, as AOVs call them: half has neither the range nor the digits
/// for them, whoever writes them.
bool is_measurement(std::string_view channel) {
    return channel == "Z" || channel.starts_with("P.") || channel.starts_with("uv.") ||
           channel.starts_with("variance.");
}

Imf::PixelType type_of(const Image& image, size_t channel, ExrPrecision precision) {
    const ChannelType type = image.types.empty() ? ChannelType::by_options : image.types[channel];
    if (type == ChannelType::uint32) return Imf::UINT;
    if (type == ChannelType::single || is_measurement(image.channels[channel])) return Imf::FLOAT;
    return precision == ExrPrecision::half ? Imf::HALF : Imf::FLOAT;
}

void warn_clamped(uint64_t halves, uint64_t wholes, const std::string& path, Diagnostics& diagnostics) {
    if (halves)
        diagnostics.warn("a value beyond ±65504 was clamped, the most that half precision holds", {path, 0, 0, {}},
                         halves);
    if (wholes)
        diagnostics.warn("a value in a channel of whole numbers was not one from 0 to 4294967295", {path, 0, 0, {}},
                         wholes);
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
    const size_t channels = image.channels.size(), pixel_size = sizeof(float) * channels;
    uint64_t clamped_halves = 0, clamped_wholes = 0;
    std::vector<Plane> planes(channels);
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < channels; ++c) {
        const Imf::PixelType type = type_of(image, c, precision);
        header.channels().insert(image.channels[c], Imf::Channel(type));
        // OpenEXR only reads what it is to write.
        const auto add = [&](const auto* values, size_t pixel_step) {
            char* base = reinterpret_cast<char*>(
                const_cast<std::remove_const_t<std::remove_pointer_t<decltype(values)>>*>(values));
            frame.insert(image.channels[c], Imf::Slice(type, base, pixel_step, pixel_step * image.width));
        };
        if (type != Imf::FLOAT)
            planes[c] = plane_of(image, c, type, type == Imf::HALF ? clamped_halves : clamped_wholes);
        if (type == Imf::FLOAT)
            add(image.pixels.data() + c, pixel_size);
        else if (type == Imf::HALF)
            add(planes[c].halves.data(), sizeof(half));
        else
            add(planes[c].wholes.data(), sizeof(uint32_t));
    }
    warn_clamped(clamped_halves, clamped_wholes, path, diagnostics);
    MemoryWriter writer;
    {
        Imf::OutputFile file(writer, header, 0);
        file.setFrameBuffer(frame);
        file.writePixels(static_cast<int>(image.height));
    }  // the destructor writes the table of offsets
    return writer.take();
}

}  // namespace steradian::codec
