// steradian convert: a picture from one format to another.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "base/text.h"
#include "command.h"
#include "image/tone.h"
#include "steradian/image_io.h"

namespace steradian::cli {
namespace {

struct ConvertOptions {
    std::string input, output;
    ImageWriteOptions write;
    bool half = false;
    bool shown = false;  ///< --exposure or --view was given
};

int usage(std::string message, std::string hint = {}) {
    return report(Error{ErrorCode::usage, std::move(message), {}, {}, std::move(hint)});
}

int run_convert(const ConvertOptions& options) {
    const std::string extension = extension_of(options.output);
    std::error_code ignored;
    if (options.input == options.output || std::filesystem::equivalent(options.input, options.output, ignored))
        return usage("input and output are the same file, which would be replaced", "give the output another name");
    if (options.shown && extension != ".png")
        return usage("--exposure and --view are for PNG: the other formats hold linear light as it is");
    if (options.half && extension != ".exr") return usage("--half is for EXR");
    const auto image = read_image(options.input);
    if (!image) return report(image.error());
    Diagnostics diagnostics;
    const Status status = write_image(options.output, *image, options.write, &diagnostics);
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
        app.add_subcommand("convert", "A picture from one format to another, for viewing or for other programs");
    c->footer(kFooter);
    c->add_option("IN", options->input, "The picture to read: EXR, HDR, PFM, PNG or JPEG")->required();
    c->add_option("OUT", options->output, "The picture to write: .exr, .hdr, .pfm or .png by its name")->required();
    auto* exposure =
        c->add_option("--exposure", options->write.exposure, "Stops of exposure for PNG: each one doubles the light");
    std::string views;
    for (const std::string_view view : view_names()) views += (views.empty() ? "" : ", ") + std::string(view);
    auto* view =
        c->add_option("--view", options->write.view, "View transform for PNG: " + views)->capture_default_str();
    c->add_flag("--half", options->half, "EXR in half precision (values beyond 65504 are clamped and counted)");
    c->callback([options, exposure, view, &action] {
        options->shown = exposure->count() || view->count();
        if (options->half) options->write.exr = ExrPrecision::half;
        action = [options] { return run_convert(*options); };
    });
}

}  // namespace steradian::cli
