// steradian diff: how far two pictures are apart.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "command.h"
#include "image/compare.h"
#include "steradian/image_io.h"

namespace steradian::cli {
namespace {

constexpr int kSame = 0, kDifferent = 1, kTrouble = 2;

struct DiffOptions {
    std::string a, b, output;
    std::optional<double> max_abs, max_mse, max_rel_mse, min_psnr;
    bool json = false;
};

int trouble(const Error& error) {
    (void)report(error);
    return kTrouble;
}

/// Every bound that was given must hold; without one, every bit.
bool within(const ImageDifference& d, const DiffOptions& options) {
    if (!options.max_abs && !options.max_mse && !options.max_rel_mse && !options.min_psnr)
        return d.different_pixels == 0;
    const auto at_most = [](double value, const std::optional<double>& bound) { return !bound || value <= *bound; };
    return at_most(d.max_abs, options.max_abs) && at_most(d.mse, options.max_mse) &&
           at_most(d.rel_mse, options.max_rel_mse) &&
           at_most(-d.psnr, options.min_psnr ? std::optional(-*options.min_psnr) : std::nullopt);
}

void print_text(const ImageDifference& d, bool same) {
    std::cout << fmt::format("MSE     {:.9g}\n", d.mse);
    std::cout << fmt::format("relMSE  {:.9g}\n", d.rel_mse);
    std::cout << fmt::format("PSNR    {:.6g} dB\n", d.psnr);
    std::cout << fmt::format("max     {:.9g}", d.max_abs);
    if (d.max_abs > 0) std::cout << fmt::format(" at pixel ({}, {})", d.max_x, d.max_y);
    std::cout << fmt::format("\npixels  {} with any bit different\n", d.different_pixels);
    std::cout << (same ? "same" : "different") << '\n';
}

void print_json(const ImageDifference& d, bool same) {
    rapidjson::StringBuffer buffer;
    JsonWriter w(buffer);
    const auto number = [&](const char* key, double value) {
        w.Key(key), std::isfinite(value) ? w.Double(value) : w.Null();
    };
    w.StartObject();
    w.Key("same"), w.Bool(same);
    number("mse", d.mse);
    number("rel_mse", d.rel_mse);
    number("psnr", d.psnr);
    number("max_abs", d.max_abs);
    w.Key("max_at"), w.StartArray(), w.Uint(d.max_x), w.Uint(d.max_y), w.EndArray();
    w.Key("different_pixels"), w.Uint64(d.different_pixels);
    w.EndObject();
    std::cout << buffer.GetString() << '\n';
}

Status write_difference(const DiffOptions& options, const Image& a, const Image& b) {
    const auto picture = difference_image(a, b);
    if (!picture) return picture.error();
    Diagnostics diagnostics;
    Status status = write_image(options.output, *picture, {}, &diagnostics);
    report(diagnostics);
    return status;
}

Status check(const DiffOptions& options) {
    if (options.output.empty()) return Ok{};
    const std::string outputs[] = {options.output}, inputs[] = {options.a, options.b};
    if (auto status = check_not_inputs(outputs, inputs); !status) return status;
    return check_outputs(outputs, {});
}

int run_diff(const DiffOptions& options) {
    if (auto status = check(options); !status) return trouble(status.error());
    const auto a = read_image(options.a);
    if (!a) return trouble(a.error());
    const auto b = read_image(options.b);
    if (!b) return trouble(b.error());
    const auto difference = compare_images(*a, *b);
    if (!difference) return trouble(difference.error());
    if (!options.output.empty())
        if (auto status = write_difference(options, *a, *b); !status) return trouble(status.error());
    const bool same = within(*difference, options);
    options.json ? print_json(*difference, same) : print_text(*difference, same);
    if (auto status = finish_stdout(); !status) return trouble(status.error());
    return same ? kSame : kDifferent;
}

constexpr const char* kFooter =
    "MSE is the mean of (A - B)^2 over all pixels and channels, relMSE that of (A - B)^2 / (B^2 + 0.01), PSNR is for "
    "a\n"
    "peak of 1. The pictures must have the same size and channels.\n"
    "Exit code: 0 when all the given bounds hold (with none: when every bit agrees), 1 when not, 2 on trouble.\n"
    "With --json, numbers that are not finite are null: the PSNR of equal pictures is.\n"
    "\n"
    "Examples:\n"
    "  steradian diff a.exr b.exr                             are they the same bits?\n"
    "  steradian diff a.exr reference.exr --max-rel-mse 1e-3  close enough?\n"
    "  steradian diff a.exr b.exr --output d.exr              where are they apart?";

}  // namespace

void add_diff(CLI::App& app, Action& action) {
    auto options = std::make_shared<DiffOptions>();
    CLI::App* c =
        add_command(app, action, "diff", "How far two pictures are apart: MSE, relMSE, PSNR, the largest difference",
                    options, run_diff);
    c->footer(kFooter);
    c->add_option("A", options->a, "A picture")->required();
    c->add_option("B", options->b, "Another one, the reference")->required();
    add_text(c, "--output", options->output, "without --output no picture is written",
             "Write |A - B| as a picture: .exr, .hdr, .pfm or .png");
    const auto bound = [&](const char* name, std::optional<double>& value, double lowest, const char* help) {
        add_real(c, name, value, lowest, 1e300, help);
    };
    bound("--max-abs", options->max_abs, 0, "Bound on the largest |A - B| of any channel");
    bound("--max-mse", options->max_mse, 0, "Bound on the MSE");
    bound("--max-rel-mse", options->max_rel_mse, 0, "Bound on the relMSE");
    bound("--min-psnr", options->min_psnr, -1e300, "Bound on the PSNR, in dB");
    c->add_flag("--json", options->json, "As JSON");
}

}  // namespace steradian::cli
