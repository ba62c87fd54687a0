#include "command.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "base/file.h"
#include "base/text.h"
#include "image/decode.h"
#include "image/tone.h"

namespace steradian::cli {

int exit_code(ErrorCode code) {
    switch (code) {
        case ErrorCode::render_failed:
            return kRenderFailed;
        case ErrorCode::usage:
            return kUsage;
        case ErrorCode::bad_input:
            return kBadInput;
        case ErrorCode::resources:
            return kResources;
    }
    return kRenderFailed;
}

int report(const Error& error) {
    std::cerr << error.str() << std::endl;
    return exit_code(error.code);
}

void report(const Diagnostics& diagnostics) {
    for (const Warning& warning : diagnostics.warnings()) std::cerr << warning.str() << '\n';
    std::cerr.flush();
}

Status finish_stdout() {
    if (std::cout.flush()) return Ok{};
    return make_error(ErrorCode::resources, "cannot write to standard output");
}

// --- Options ---------------------------------------------------------------------------------------------------

Error usage_error(std::string message, std::string hint) {
    return make_error(ErrorCode::usage, std::move(message), std::move(hint));
}

uint64_t parse_count(const std::string& option, const std::string& text, uint64_t lowest, uint64_t highest) {
    uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [p, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && p == end && value >= lowest && value <= highest) return value;
    throw CLI::ValidationError(option,
                               fmt::format("expected a whole number from {} to {}, not '{}'", lowest, highest, text));
}

double parse_real(const std::string& option, const std::string& text, double lowest, double highest) {
    const auto value = parse_double(text);
    if (value && std::isfinite(*value) && *value >= lowest && *value <= highest) return *value;
    throw CLI::ValidationError(option, fmt::format("expected a number from {} to {}, not '{}'", lowest, highest, text));
}

UnknownChoice::UnknownChoice(const std::string& option, const std::string& word,
                             std::span<const std::string_view> choices)
    : WrongText(option, "unknown value '" + word + "'", suggestion(word, choices)) {}

CLI::Option* add_text(CLI::App* c, const std::string& name, std::string& value, const std::string& hint,
                      const std::string& help) {
    const auto set = [&value, name, hint](const std::string& text) {
        if (text.empty()) throw WrongText(name, "the text is empty", hint);
        value = text;
    };
    return c->add_option_function<std::string>(name, set, help);
}

ImageWriteOptions PictureOptions::write() const {
    ImageWriteOptions out;
    if (half) out.exr = ExrPrecision::half;
    if (exposure) out.exposure = static_cast<float>(*exposure);
    if (view) out.view = *view;
    return out;
}

void add_picture_options(CLI::App* c, PictureOptions& options, const std::string& group) {
    c->add_flag("--half", options.half, "EXR with 16-bit instead of 32-bit floats; beyond 65504 they are clamped")
        ->group(group);
    add_real(c, "--exposure", options.exposure, -100, 100, "Stops, for PNG (+1: twice as bright)")->group(group);
    add_choice(c, "--view", options.view, view_names(),
               fmt::format("View transform for PNG: {}", fmt::join(view_names(), ", ")))
        ->default_str(ImageWriteOptions{}.view)
        ->group(group);
}

// --- Files -----------------------------------------------------------------------------------------------------

namespace {

bool has_extension(const std::string& path, std::span<const std::string_view> extensions) {
    return std::find(extensions.begin(), extensions.end(), extension_of(path)) != extensions.end();
}

/// The first bytes of a regular file; nothing of anything else.
std::string beginning_of(const std::string& path) {
    std::error_code error;
    std::string bytes(64, '\0');
    std::ifstream file;
    if (std::filesystem::is_regular_file(path, error)) file.open(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return bytes;
}

Status check_effect(std::span<const std::string> outputs, const PictureOptions& options) {
    const auto writes = [&](std::string_view extension) {
        return std::any_of(outputs.begin(), outputs.end(),
                           [&](const std::string& path) { return extension_of(path) == extension; });
    };
    if ((options.exposure || options.view) && !writes(".png"))
        return usage_error("--exposure and --view are for PNG: the other formats hold linear light as it is");
    if (options.half && !writes(".exr")) return usage_error("--half is for EXR");
    return Ok{};
}

}  // namespace

bool is_picture(const std::string& path) {
    static constexpr std::string_view kReadable[] = {".exr", ".hdr", ".pfm", ".png", ".jpg", ".jpeg"};
    return image_kind(beginning_of(path)) != ImageFileKind::unknown || has_extension(path, kReadable);
}

bool same_file(const std::string& a, const std::string& b) {
    struct stat x {
    }, y{};
    if (::stat(a.c_str(), &x) == 0 && ::stat(b.c_str(), &y) == 0) return x.st_dev == y.st_dev && x.st_ino == y.st_ino;
    const auto place = [](const std::string& path) {
        std::error_code error;
        const auto whole = std::filesystem::absolute(path, error);
        const auto canonical = std::filesystem::weakly_canonical(whole, error);
        return error ? whole.lexically_normal() : canonical;
    };
    return place(a) == place(b);
}

Status check_outputs(std::span<const std::string> outputs, const PictureOptions& options) {
    for (size_t i = 0; i < outputs.size(); ++i) {
        const std::string& path = outputs[i];
        const std::string shown = escape_for_display(path, 4096), extension = extension_of(path);
        if (!has_extension(path, kWritablePictures))
            return usage_error(
                fmt::format("output {}: unknown picture format '{}'", shown, escape_for_display(extension)),
                suggestion(extension, kWritablePictures));
        for (size_t j = 0; j < i; ++j)
            if (same_file(outputs[j], path)) return usage_error(fmt::format("output {}: given twice", shown));
        if (auto status = check_writable(path); !status) return status;
    }
    return check_effect(outputs, options);
}

Status check_not_inputs(std::span<const std::string> outputs, std::span<const std::string> inputs) {
    for (const std::string& output : outputs)
        for (const std::string& input : inputs)
            if (same_file(output, input))
                return usage_error(fmt::format("output {}: this would replace the input {}",
                                               escape_for_display(output, 4096), escape_for_display(input, 4096)),
                                   "give the output another name");
    return Ok{};
}

// --- JSON ------------------------------------------------------------------------------------------------------

void write_text(JsonWriter& w, std::string_view text) {
    const std::string safe = escape_for_display(text, 1 << 20);
    w.String(safe.data(), static_cast<rapidjson::SizeType>(safe.size()));
}

void write_field(JsonWriter& w, const char* key, std::string_view text) {
    w.Key(key);
    write_text(w, text);
}

}  // namespace steradian::cli
