// steradian convert: a picture from one format to another.
#include <memory>
#include <string>

#include "command.h"
#include "steradian/image_io.h"

namespace steradian::cli {
namespace {

struct ConvertOptions {
    std::string input, output;
    PictureOptions picture;
};

int run_convert(const ConvertOptions& options) {
    const std::string outputs[] = {options.output}, inputs[] = {options.input};
    if (auto status = check_not_inputs(outputs, inputs); !status) return report(status.error());
    if (auto status = check_outputs(outputs, options.picture); !status) return report(status.error());
    const auto image = read_image(options.input);
    if (!image) return report(image.error());
    Diagnostics diagnostics;
    const Status status = write_image(options.output, *image, options.picture.write(), &diagnostics);
    report(diagnostics);
    return status ? kDone : report(status.error());
}

constexpr const char* kFooter =
    "PNG and JPEG are linearised from sRGB when they are read. A PNG is written in 8-bit sRGB: brighter than 1 is\n"
    "clipped, or brought into range by a view transform.\n"
    "\n"
    "Examples:\n"
    "  steradian convert a.exr a.png                          clipped at 1\n"
    "  steradian convert a.exr a.png --exposure 1.5           1.5 stops brighter\n"
    "  steradian convert a.exr a.png --view agx               highlights roll off as on film\n"
    "  steradian convert sky.hdr sky.exr --half               16-bit floats, half the size\n"
    "  steradian convert a.exr a.pfm                          raw floats for a script";

}  // namespace

void add_convert(CLI::App& app, Action& action) {
    auto options = std::make_shared<ConvertOptions>();
    CLI::App* c =
        add_command(app, action, "convert", "A picture from one format to another, for viewing or for other programs",
                    options, run_convert);
    c->footer(kFooter);
    c->add_option("IN", options->input, "The picture to read: EXR, HDR, PFM, PNG, JPEG or WebP")->required();
    c->add_option("OUT", options->output, "The picture to write: .exr, .hdr, .pfm or .png by its name")->required();
    add_picture_options(c, options->picture, "Options");
}

}  // namespace steradian::cli
