#include "steradian/result.h"

#include <algorithm>

#include "base/text.h"

namespace steradian {

std::string SourceLocation::str() const {
    if (file.empty()) return {};
    std::string out = escape_for_display(file, 4096);
    if (line) out += ":" + std::to_string(line);
    if (line && column) out += ":" + std::to_string(column);
    if (byte) out += ": byte " + std::to_string(*byte);
    return out;
}

std::string Error::str() const {
    const std::string place = where.str();
    std::string out = place.empty() ? "error: " + message : place + ": error: " + message;
    if (!excerpt.empty()) {
        // A long line was cut around the error, so the caret stands at the column only while that is in the excerpt.
        constexpr size_t kMargin = 80;
        const size_t raw = where.column ? where.column - 1 : 0;
        const size_t column = std::min({raw, raw > kMargin ? kMargin : raw, excerpt.size()});
        out += "\n  " + escape_for_display(excerpt, 400);
        out += "\n  " + std::string(escape_for_display(std::string_view(excerpt).substr(0, column), 400).size(), ' ') + "^";
    }
    if (!hint.empty()) out += "\n  hint: " + hint;
    return out;
}

std::string Warning::str() const {
    const std::string place = where.str();
    std::string out = place.empty() ? "warning: " + message : place + ": warning: " + message;
    if (count > 1) out += " (" + std::to_string(count) + " times)";
    return out;
}

void Diagnostics::warn(std::string message, SourceLocation where, uint64_t count) {
    const auto same = std::find_if(warnings_.begin(), warnings_.end(), [&](const Warning& w) { return w.message == message; });
    if (same != warnings_.end()) same->count += count;
    else warnings_.push_back({std::move(message), std::move(where), count});
}

void Diagnostics::append(const Diagnostics& other) {
    for (const Warning& w : other.warnings_) warn(w.message, w.where, w.count);
}

}  // namespace steradian
