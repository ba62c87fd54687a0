// JSON text as a tree in which every value and every key knows where it stands. Strict RFC 8259 on top of RapidJSON's
// iterative reader: no recursion while reading, walking or destroying, however deep the text nests.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "steradian/result.h"

namespace steradian::json {

enum class Kind : uint8_t { null, boolean, number, string, array, object };

/// "a number", "an array", … for messages.
std::string_view kind_name(Kind kind) noexcept;

class Document;

/// A value of a document: a handle, cheap to copy, valid as long as its document and the document's text. Asking for
/// what the value is not is a precondition violation.
class Value {
public:
    Kind kind() const noexcept;
    bool is(Kind k) const noexcept { return kind() == k; }
    /// Of the value's first byte in Document::text().
    size_t offset() const noexcept;

    bool boolean() const noexcept;
    double number() const noexcept;  ///< always finite
    /// The number as it was written.
    std::string_view number_text() const noexcept;
    /// UTF-8, escapes resolved; may contain U+0000.
    std::string_view string() const noexcept;
    /// Elements of an array or members of an object.
    size_t size() const noexcept;

    class Elements;
    class Members;
    Elements elements() const noexcept;
    Members members() const noexcept;

private:
    friend class Document;
    friend class TreeBuilder;
    Value(const Document& document, uint32_t node) : document_(&document), node_(node) {}
    uint32_t next_sibling() const noexcept;

    const Document* document_;
    uint32_t node_;
};

/// The values of an array, in order.
class Value::Elements {
public:
    class Iterator {
    public:
        explicit Iterator(Value value) : value_(value) {}
        Value operator*() const noexcept { return value_; }
        Iterator& operator++() noexcept;
        bool operator==(const Iterator& other) const noexcept { return value_.node_ == other.value_.node_; }

    private:
        Value value_;
    };
    Elements(Value first, Value end) : first_(first), end_(end) {}
    Iterator begin() const noexcept { return Iterator(first_); }
    Iterator end() const noexcept { return Iterator(end_); }

private:
    Value first_, end_;
};

struct Member {
    std::string_view key;
    size_t key_offset;
    Value value;
};

/// The members of an object, in the order of the text.
class Value::Members {
public:
    class Iterator {
    public:
        explicit Iterator(Value key) : key_(key) {}
        Member operator*() const noexcept;
        Iterator& operator++() noexcept;
        bool operator==(const Iterator& other) const noexcept { return key_.node_ == other.key_.node_; }

    private:
        Value key_;
    };
    Members(Value first, Value end) : first_(first), end_(end) {}
    Iterator begin() const noexcept { return Iterator(first_); }
    Iterator end() const noexcept { return Iterator(end_); }

private:
    Value first_, end_;
};

inline constexpr uint64_t kMaxTextBytes = uint64_t(1) << 30;

/// The tree lies in one array in document order (16 bytes a value) beside one string with all decoded text, so its
/// memory is at most about twenty times the file's size.
class Document {
public:
    /// Refuses, with a place: anything that is not JSON in UTF-8 (a byte order mark is skipped), NUL bytes, numbers
    /// beyond double's range, nesting deeper than max_depth (with the JSON pointer of what is too deep, or where
    /// that is long of something around it), text over kMaxTextBytes. `text` must outlive the document;
    /// `name` stands for the file in errors. `begin`: where in the file the text lies, if that is a binary one: places
    /// are then bytes of it.
    static Result<Document> parse(std::string_view text, const std::string& name, uint32_t max_depth,
                                  std::optional<uint64_t> begin = std::nullopt);

    Value root() const noexcept { return Value(*this, 0); }
    /// What was parsed, without a byte order mark: offsets count from its start.
    std::string_view text() const noexcept { return text_; }
    /// The JSON pointer (RFC 6901) of the innermost value that a byte of the text is part of; a key belongs to its
    /// value. "" is the root. Takes time in proportion to the sizes of the containers on the way.
    std::string pointer(size_t offset) const;
    /// Calls `visit` with the pointer of each value that begins at one of `offsets`, which ascend, in their order;
    /// takes one walk through the document.
    void each_pointer(std::span<const size_t> offsets,
                      const std::function<void(size_t number, const std::string& pointer)>& visit) const;

    struct Duplicate {
        std::string_view key;
        size_t first_offset, second_offset;
    };
    /// The first key of the text that its object had before. RFC 8259 leaves the meaning open; scenes refuse it.
    std::optional<Duplicate> duplicate_key() const;

private:
    friend class Value;
    friend class TreeBuilder;
    struct Node {
        Kind kind;
        uint32_t offset;
        /// boolean: 0 or 1; number: the double's bits; string: begin << 32 | length in strings_;
        /// array, object: size << 32 | index of the node behind the last child.
        uint64_t payload;
    };
    Document() = default;

    std::string_view text_;
    std::vector<Node> nodes_;
    std::string strings_;
};

/// An error at a byte of a text: its line, column and excerpt.
Error error_at(std::string_view text, const std::string& name, size_t offset, std::string message,
               std::string hint = {}, ErrorCode code = ErrorCode::bad_input);

}  // namespace steradian::json
