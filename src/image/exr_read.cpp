#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/text.h"
#include "image/codec.h"
#include "image/colour_space.h"
#include "image/exr_header.h"
#include "image/exr_luma.h"

namespace steradian::codec {
namespace {

/// The file, with the headers that OpenEXR may see.
class MemoryReader : public Imf::IStream {
public:
    MemoryReader(const Source& source, const std::string& headers)
        : IStream("picture"), source_(source), headers_(headers) {}
    bool read(char c[], int n) override {
        const uint64_t size = source_.bytes.size();
        if (n < 0 || position_ > size || static_cast<uint64_t>(n) > size - position_)
            source_.fail("the EXR file ends early", size);
        const auto count = static_cast<size_t>(n);
        std::memcpy(c, source_.bytes.data() + position_, count);
        if (position_ < headers_.size())
            std::memcpy(c, headers_.data() + position_, std::min<size_t>(count, headers_.size() - position_));
        position_ += count;
        return position_ < size;
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

private:
    const Source& source_;
    const std::string& headers_;
    uint64_t position_ = 0;
};

/// A file of which one part is read.
class Reader {
public:
    explicit Reader(const Source& source)
        : source_(source), headers_(scan_exr(source)), stream_(source, headers_.safe_bytes) {
        const std::vector<ExrPart>& parts = headers_.parts;
        const auto flat = [](const ExrPart& p) { return !p.deep; };
        const auto coloured = [&](const ExrPart& p) {
            return flat(p) && ((p.find("R") && p.find("G") && p.find("B")) || p.find("Y"));
        };
        auto at = std::find_if(parts.begin(), parts.end(), coloured);
        if (at == parts.end()) at = std::find_if(parts.begin(), parts.end(), flat);
        if (at == parts.end()) source.fail("deep pictures are not supported, expected a flat EXR file");
        index_ = static_cast<int>(at - parts.begin());
        const uint64_t values = part().data.width() * part().data.height() * part().channels.size();
        const uint64_t shown = part().display.width() * part().display.height() * part().channels.size();
        source.check_size(part().data.width(), part().data.height(), std::max(values, shown) * sizeof(float));
    }

    const ExrPart& part() const { return headers_.parts[static_cast<size_t>(index_)]; }
    const Source& source() const { return source_; }

    void read(const Imf::FrameBuffer& frame) {
        Imf::MultiPartInputFile file(stream_, 0, true);
        Imf::InputPart input(file, index_);
        const Imath::Box2i window = input.header().dataWindow();
        const ExrWindow& ours = part().data;
        if (ours != ExrWindow{window.min.x, window.min.y, window.max.x, window.max.y})
            source_.fail("the EXR header contradicts itself");
        input.setFrameBuffer(frame);
        input.readPixels(window.min.y, window.max.y);
    }

private:
    const Source& source_;
    ExrHeaders headers_;
    MemoryReader stream_;
    int index_ = 0;
};

Imath::V2i origin(const ExrWindow& window) { return {static_cast<int>(window.x0), static_cast<int>(window.y0)}; }

/// Channels of one type, interleaved, over the data window.
template <class T>
void read_interleaved(Reader& reader, const std::vector<std::string>& names, Imf::PixelType type, T* out) {
    const ExrWindow& window = reader.part().data;
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < names.size(); ++c) {
        const size_t step = names.size() * sizeof(T);
        frame.insert(names[c], Imf::Slice::Make(type, out + c, origin(window), static_cast<int64_t>(window.width()),
                                                static_cast<int64_t>(window.height()), step, step * window.width()));
    }
    reader.read(frame);
}

/// "Y" with "RY" and "BY", which are usually subsampled.
bool is_luma_chroma(const ExrPart& part) { return part.find("Y") && part.find("RY") && part.find("BY"); }

/// R, G, B and perhaps A from luminance and chroma, over the data window.
Image read_luma_chroma(Reader& reader) {
    const ExrPart& part = reader.part();
    LumaChroma planes;
    Imf::FrameBuffer frame;
    const auto add = [&](const char* name, Plane& plane) {
        const ExrChannel* channel = part.find(name);
        plane.x_sampling = channel->x_sampling;
        plane.y_sampling = channel->y_sampling;
        plane.width = part.data.width() / channel->x_sampling;
        plane.height = part.data.height() / channel->y_sampling;
        const bool aligned =
            part.data.width() % channel->x_sampling == 0 && part.data.height() % channel->y_sampling == 0;
        if (!aligned || channel->x_sampling > 16 || channel->y_sampling > 16)
            reader.source().fail("the subsampled channels of the EXR file do not fit its data window");
        plane.values.resize(plane.width * plane.height);
        frame.insert(name,
                     Imf::Slice::Make(Imf::FLOAT, plane.values.data(), origin(part.data),
                                      static_cast<int64_t>(part.data.width()), static_cast<int64_t>(part.data.height()),
                                      sizeof(float), sizeof(float) * plane.width, static_cast<int>(channel->x_sampling),
                                      static_cast<int>(channel->y_sampling)));
    };
    add("Y", planes.y);
    add("RY", planes.ry);
    add("BY", planes.by);
    if (part.find("A")) add("A", planes.alpha.emplace());
    reader.read(frame);
    const auto weights = luminance_weights(part.chromaticities.value_or(kRec709Primaries));
    if (!weights || !((*weights)[1] > 1e-6)) reader.source().fail("the chromaticities of the EXR file make no sense");
    return to_rgb(planes, *weights, static_cast<uint32_t>(part.data.width()),
                  static_cast<uint32_t>(part.data.height()));
}

/// Whether the channel is one of a Cryptomatte's, whose ids are bits and not numbers: NAME00.R and so on for a layer
/// that the attribute cryptomatte/KEY/name tells.
bool is_matte(const std::map<std::string, std::string>& strings, const std::string& channel) {
    return std::any_of(strings.begin(), strings.end(), [&](const auto& attribute) {
        const auto& [key, layer] = attribute;
        return key.starts_with("cryptomatte/") && key.ends_with("/name") && channel.starts_with(layer);
    });
}

/// All channels as floats over the data window, in the order that they were written in or else the usual one.
Image read_channels(Reader& reader) {
    const ExrPart& part = reader.part();
    if (is_luma_chroma(part)) return read_luma_chroma(reader);
    if (part.subsampled())
        reader.source().fail("subsampled channels are supported only as luminance and chroma: Y, RY and BY");
    Image image;
    image.width = static_cast<uint32_t>(part.data.width());
    image.height = static_cast<uint32_t>(part.data.height());
    for (const ExrChannel& channel : part.channels) image.channels.push_back(channel.name);
    std::sort(image.channels.begin(), image.channels.end(), channel_before);
    if (const auto order = part.strings.find(kChannelOrder); order != part.strings.end()) {
        std::vector<std::string> wanted;
        for (size_t begin = 0; begin <= order->second.size();) {
            const size_t end = std::min(order->second.find(',', begin), order->second.size());
            wanted.push_back(order->second.substr(begin, end - begin));
            begin = end + 1;
        }
        if (std::is_permutation(wanted.begin(), wanted.end(), image.channels.begin(), image.channels.end()))
            image.channels = wanted;
    }
    image.pixels.resize(size_t(image.width) * image.height * image.channels.size());
    read_interleaved(reader, image.channels, Imf::FLOAT, image.pixels.data());
    for (const std::string& name : image.channels)
        image.types.push_back(part.find(name)->type == ExrType::uint32 ? ChannelType::uint32
                              : is_matte(part.strings, name)           ? ChannelType::single
                                                                       : ChannelType::by_options);
    return image;
}

std::optional<ColourMatrix> conversion(const Reader& reader) {
    const auto& chromaticities = reader.part().chromaticities;
    if (!chromaticities || is_rec709(*chromaticities)) return std::nullopt;
    const auto matrix = rec709_from_primaries(*chromaticities);
    if (!matrix) reader.source().fail("the chromaticities of the EXR file make no sense");
    return matrix;
}

/// Every R, G, B of a layer.
void convert_colours(const ColourMatrix& matrix, Image& image) {
    const auto index = [&](const std::string& name) {
        return static_cast<size_t>(std::find(image.channels.begin(), image.channels.end(), name) -
                                   image.channels.begin());
    };
    const size_t channels = image.channels.size();
    for (const std::string& red : image.channels) {
        if (red != "R" && !red.ends_with(".R")) continue;
        const std::string layer = red.substr(0, red.size() - 1);
        const size_t r = index(red), g = index(layer + "G"), b = index(layer + "B");
        if (g == channels || b == channels) continue;
        for (float* pixel = image.pixels.data(); pixel != image.pixels.data() + image.pixels.size();
             pixel += channels) {
            const Rgb c = matrix * Rgb{pixel[r], pixel[g], pixel[b]};
            pixel[r] = c.r, pixel[g] = c.g, pixel[b] = c.b;
        }
    }
}

/// The part of the data window inside the display window, black around it.
Image placed(Image image, const ExrWindow& data, const ExrWindow& display) {
    if (data == display) return image;
    Image out;
    out.width = static_cast<uint32_t>(display.width());
    out.height = static_cast<uint32_t>(display.height());
    out.channels = image.channels;
    out.types = image.types;
    const size_t channels = out.channels.size();
    out.pixels.resize(size_t(out.width) * out.height * channels);
    const int64_t x0 = std::max(data.x0, display.x0), x1 = std::min(data.x1, display.x1);
    if (x1 < x0) return out;
    for (int64_t y = std::max(data.y0, display.y0); y <= std::min(data.y1, display.y1); ++y) {
        const size_t from = static_cast<size_t>(y - data.y0) * data.width() + static_cast<size_t>(x0 - data.x0);
        const size_t to = static_cast<size_t>(y - display.y0) * display.width() + static_cast<size_t>(x0 - display.x0);
        std::copy_n(image.pixels.begin() + static_cast<ptrdiff_t>(from * channels),
                    static_cast<size_t>(x1 - x0 + 1) * channels,
                    out.pixels.begin() + static_cast<ptrdiff_t>(to * channels));
    }
    return out;
}

/// The channels of a texture: colour of the first layer that has it, or grey, or the only channel there is.
std::vector<std::string> texture_channels(const Reader& reader) {
    const ExrPart& part = reader.part();
    std::vector<std::string> sorted;
    for (const ExrChannel& channel : part.channels) sorted.push_back(channel.name);
    std::sort(sorted.begin(), sorted.end(), channel_before);
    for (const std::string& red : sorted) {
        if (red != "R" && !red.ends_with(".R")) continue;
        const std::string layer = red.substr(0, red.size() - 1);
        if (!part.find(layer + "G") || !part.find(layer + "B")) continue;
        std::vector<std::string> names = {red, layer + "G", layer + "B"};
        if (part.find(layer + "A")) names.push_back(layer + "A");
        return names;
    }
    if (part.find("Y")) return part.find("A") ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"Y"};
    if (sorted.size() == 1) return sorted;
    reader.source().fail(
        fmt::format("expected channels R, G and B, or Y, or a single one; the EXR file has {}", join(sorted)));
}

RawImage raw_floats(const Image& image) {
    RawImage raw;
    raw.width = image.width;
    raw.height = image.height;
    raw.channels = static_cast<uint8_t>(image.channels.size());
    raw.format = TexelFormat::f32;
    raw.data.resize(image.pixels.size() * sizeof(float));
    std::memcpy(raw.data.data(), image.pixels.data(), raw.data.size());
    return raw;
}

}  // namespace

Image decode_exr_image(const Source& source) {
    Reader reader(source);
    const ExrPart& part = reader.part();
    const auto matrix = conversion(reader);
    Image image = read_channels(reader);
    if (matrix) convert_colours(*matrix, image);
    image = placed(std::move(image), part.data, part.display);
    for (const auto& [key, text] : part.strings)
        if (key != kChannelOrder && key != "name" && key != "view") image.metadata.emplace(key, text);
    return image;
}

Decoded decode_exr_texels(const Source& source) {
    Reader reader(source);
    const ExrPart& part = reader.part();
    const auto matrix = conversion(reader);
    if (is_luma_chroma(part)) {
        Image image = read_luma_chroma(reader);
        if (matrix) convert_colours(*matrix, image);
        return {raw_floats(image), {}};
    }
    const std::vector<std::string> names = texture_channels(reader);
    bool all_half = true;
    for (const std::string& name : names) {
        const ExrChannel& channel = *part.find(name);
        if (channel.x_sampling != 1 || channel.y_sampling != 1)
            source.fail("subsampled channels are supported only as luminance and chroma: Y, RY and BY");
        all_half = all_half && channel.type == ExrType::half;
    }
    Image image;
    image.width = static_cast<uint32_t>(part.data.width());
    image.height = static_cast<uint32_t>(part.data.height());
    image.channels = names;
    const size_t count = size_t(image.width) * image.height * names.size();
    if (all_half && !matrix) {
        RawImage raw{image.width, image.height, static_cast<uint8_t>(names.size()), TexelFormat::f16, {}};
        raw.data.resize(count * sizeof(half));
        read_interleaved(reader, names, Imf::HALF, reinterpret_cast<half*>(raw.data.data()));
        return {std::move(raw), {}};
    }
    image.pixels.resize(count);
    read_interleaved(reader, names, Imf::FLOAT, image.pixels.data());
    if (matrix) convert_colours(*matrix, image);
    return {raw_floats(image), {}};
}

}  // namespace steradian::codec
