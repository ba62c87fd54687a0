#include "steradian/result.h"

#include <algorithm>

#include "base/text.h"

namespace steradian {

std::string SourceLocation::str() const {
    if (file.empty()) return {};
    std::string out = escape_for_display(file, 4096);
    if (line) out.append(":").append(std::to_string(line));
    if (line && column) out.append(":").append(std::to_string(column));
    if (byte) out.append(": byte ").append(std::to_string(*byte));
    if (!pointer.empty()) out.append(" (").append(escape_for_display(pointer)).append(")");
    return out;
}

namespace {

/// How the excerpt is shown: a tab as one space, everything else escaped.
std::string shown(std::string_view excerpt) {
    std::string text(excerpt);
    std::replace(text.begin(), text.end(), '\t', ' ');
    return escape_for_display(text, 4 * kExcerptWidth);
}

/// Characters, not bytes: those that continue a UTF-8 sequence take no column of their own.
size_t columns(std::string_view text) {
    return static_cast<size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

}  // namespace

std::string Error::str() const {
    const std::string place = where.str();
    std::string out = place.empty() ? "error: " + message : place + ": error: " + message;
    if (!excerpt.empty()) {
        // locate() keeps kExcerptMargin bytes before the place, or all there are.
        const size_t before = where.column ? std::min<size_t>({where.column - 1u, kExcerptMargin, excerpt.size()}) : 0;
        out.append("\n  ").append(shown(excerpt));
        if (where.column)
            out.append("\n  ").append(columns(shown(std::string_view(excerpt).substr(0, before))), ' ').append("^");
    }
    if (!hint.empty()) out += "\n  hint: " + hint;
    return out;
}

Error make_error(ErrorCode code, std::string message, std::string hint) {
    Error error;
    error.code = code;
    error.message = std::move(message);
    error.hint = std::move(hint);
    return error;
}

std::string Warning::str() const {
    const std::string place = where.str();
    std::string out = place.empty() ? "warning: " + message : place + ": warning: " + message;
    if (count > 1) out += " (" + std::to_string(count) + " times)";
    return out;
}

void Diagnostics::warn(std::string message, SourceLocation where, uint64_t count, std::string rule) {
    const auto same =
        std::find_if(warnings_.begin(), warnings_.end(), [&](const Warning& w) { return w.message == message; });
    if (same != warnings_.end())
        same->count += count;
    else
        warnings_.push_back({std::move(message), std::move(where), count, std::move(rule)});
}

void Diagnostics::append(const Diagnostics& other) {
    for (const Warning& w : other.warnings_) warn(w.message, w.where, w.count, w.rule);
}

}  // namespace steradian
