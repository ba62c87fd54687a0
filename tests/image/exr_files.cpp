#include "image/exr_files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <map>

#include "support/support.h"

namespace steradian::test {
namespace {

int floor_div(int a, int b) { return a / b - (a % b < 0); }

/// Values of all channels of a header and the frame buffer that points at them.
struct Planes {
    std::map<std::string, std::vector<float>> values;
    Imf::FrameBuffer frame;

    Planes(const Imf::Header& header, float (*value)(const std::string&, int, int)) {
        const Imath::Box2i window = header.dataWindow();
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
            const int xs = c.channel().xSampling, ys = c.channel().ySampling;
            std::vector<float>& plane = values[c.name()];
            const int columns = floor_div(window.max.x, xs) - floor_div(window.min.x + xs - 1, xs) + 1;
            for (int y = window.min.y; y <= window.max.y; ++y)
                for (int x = window.min.x; x <= window.max.x; ++x)
                    if (x % xs == 0 && y % ys == 0) plane.push_back(value(c.name(), x, y));
            frame.insert(c.name(), Imf::Slice::Make(Imf::FLOAT, plane.data(), window, sizeof(float),
                                                    sizeof(float) * static_cast<size_t>(columns), xs, ys));
        }
    }
};

}  // namespace

std::string exr_file(Imf::Header header, float (*value)(const std::string&, int, int)) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.exr");
    Planes planes(header, value);
    if (header.hasTileDescription()) {
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(planes.frame);
        for (int level = 0; level < file.numLevels(); ++level) {
            if (level > 0) continue;
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(planes.frame);
        file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
    }
    return slurp(path);
}

std::string two_part_exr() {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.exr");
    std::vector<Imf::Header> headers(2, Imf::Header(4, 3));
    headers[0].setName("depth");
    headers[0].channels().insert("Z", Imf::Channel(Imf::FLOAT));
    headers[1].setName("beauty");
    for (const char* name : {"R", "G", "B"}) headers[1].channels().insert(name, Imf::Channel(Imf::FLOAT));
    for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
    {
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
        for (int i = 0; i < 2; ++i) {
            Planes planes(headers[static_cast<size_t>(i)],
                          [](const std::string& channel, int, int) { return channel == "Z" ? 1.0f : 2.0f; });
            Imf::OutputPart part(file, i);
            part.setFrameBuffer(planes.frame);
            part.writePixels(3);
        }
    }
    return slurp(path);
}

std::string deep_exr() {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.exr");
    Imf::Header header(2, 2);
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    unsigned counts[4] = {1, 1, 1, 1};
    float sample = 1;
    float* pointers[4] = {&sample, &sample, &sample, &sample};
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts), sizeof(unsigned), 2 * sizeof(unsigned)));
    for (const char* name : {"R", "G", "B"})
        frame.insert(name, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers), sizeof(float*),
                                          2 * sizeof(float*), sizeof(float)));
    {
        Imf::DeepScanLineOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(2);
    }
    return slurp(path);
}

}  // namespace steradian::test
