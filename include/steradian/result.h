// Errors as values. Nothing throws across the public API: a call that can fail returns Result<T>.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace steradian {

/// What kind of trouble it was. The command line turns it into its exit code (docs/conventions.md).
enum class ErrorCode : uint8_t {
    render_failed,  ///< the render itself went wrong (exit code 1)
    usage,          ///< the caller's arguments make no sense (exit code 2)
    bad_input,      ///< a scene, an asset or an image is missing or malformed (exit code 3)
    resources,      ///< disk, memory or a documented limit (exit code 4)
};

/// A place in a file. Text files have line and column (1-based, column in bytes), binary files a byte offset; of glTF
/// also what stands there.
struct SourceLocation {
    std::string file;
    uint32_t line = 0;    ///< 0: unknown
    uint32_t column = 0;  ///< 0: unknown
    std::optional<uint64_t> byte = std::nullopt;
    std::string pointer = {};  ///< JSON pointer (RFC 6901); empty: unknown

    /// "file:line:column", "file: byte 17" or "file", perhaps with " (/a/json/pointer)"; empty when nothing is known.
    /// Control characters are escaped.
    std::string str() const;
};

/// One problem, complete enough to act on.
struct Error {
    ErrorCode code = ErrorCode::bad_input;
    std::string message;  ///< one line: what is wrong and what was expected
    SourceLocation where;
    std::string excerpt;  ///< the offending source line without its newline, for text files
    std::string hint;     ///< optional: what to do ("did you mean 'radius'?")

    /// The first line is complete by itself (location and message); then the excerpt, a caret and the hint.
    std::string str() const;
};

/// An error that no place in a file belongs to.
Error make_error(ErrorCode code, std::string message, std::string hint = {});

/// Things that did not stop the work but that the user should know. Repeated ones are counted, not repeated.
struct Warning {
    std::string message;
    SourceLocation where;  ///< of the first occurrence
    uint64_t count = 1;
    std::string rule = {};  ///< of the rule of lint (lint.h) that says the same; empty: none

    std::string str() const;
};

class Diagnostics {
public:
    /// Adds a warning; one with the same message as an earlier one only raises that one's count.
    void warn(std::string message, SourceLocation where = {}, uint64_t count = 1, std::string rule = {});
    void append(const Diagnostics& other);
    const std::vector<Warning>& warnings() const noexcept { return warnings_; }
    bool empty() const noexcept { return warnings_.empty(); }

private:
    std::vector<Warning> warnings_;
};

/// Either a value or an Error. `value()` of a failed result and `error()` of a good one are precondition violations.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : data_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : data_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const noexcept { return data_.index() == 0; }
    explicit operator bool() const noexcept { return ok(); }

    T& value() & { return std::get<0>(data_); }
    const T& value() const& { return std::get<0>(data_); }
    T&& value() && { return std::get<0>(std::move(data_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    Error& error() & { return std::get<1>(data_); }
    const Error& error() const& { return std::get<1>(data_); }
    Error&& error() && { return std::get<1>(std::move(data_)); }

private:
    std::variant<T, Error> data_;
};

/// Success without a value.
struct Ok {};
using Status = Result<Ok>;

}  // namespace steradian
