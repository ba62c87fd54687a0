// How the parsers of model files fail inside; one place per format turns it into an Error.
#pragma once

#include <cstddef>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "steradian/result.h"

namespace steradian {

/// Thrown by parsers; `offset` is the byte where the fault is.
struct ParseFailure {
    size_t offset = 0;
    std::string message;
    std::string hint;
    ErrorCode code = ErrorCode::bad_input;
};

/// Fails at the start of a text that is UTF-16 or UTF-32.
inline void refuse_foreign_encoding(std::string_view text) {
    if (const char* encoding = foreign_encoding(text))
        throw ParseFailure{0, std::string("the text is ") + encoding + ", expected UTF-8", "save the file as UTF-8"};
}

/// A word of the file in quotes, fit for a message.
inline std::string quoted(std::string_view word, size_t max_bytes = 40) {
    std::string out(1, '\'');
    out += escape_for_display(word, max_bytes);
    out += '\'';
    return out;
}

/// The place of a byte in a text file.
inline SourceLocation text_location(std::string_view text, const std::string& name, size_t offset) {
    const TextPosition at = locate(text, offset);
    return {name, at.line, at.column, {}};
}

inline Error text_error(std::string_view text, const std::string& name, ParseFailure failure) {
    TextPosition at = locate(text, failure.offset);
    return {failure.code,
            std::move(failure.message),
            {name, at.line, at.column, {}},
            std::move(at.excerpt),
            std::move(failure.hint)};
}

inline Error out_of_memory(const std::string& name) {
    return {ErrorCode::resources, "not enough memory to load this file", {name, 0, 0, {}}, {}, {}};
}

}  // namespace steradian
