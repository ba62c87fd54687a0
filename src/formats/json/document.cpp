#include "formats/json/document.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <span>

// The reader allocates one stack; out of memory must become std::bad_alloc there as everywhere else.
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include "base/text.h"

namespace steradian::json {
namespace {

struct ThrowingAllocator {
    void* Malloc(size_t size) { return size == 0 ? nullptr : checked(std::malloc(size)); }
    void* Realloc(void* old, size_t, size_t size) {
        if (size == 0) return Free(old), nullptr;
        return checked(std::realloc(old, size));
    }
    static void Free(void* pointer) { std::free(pointer); }

private:
    static void* checked(void* pointer) {
        if (!pointer) throw std::bad_alloc();
        return pointer;
    }
};

const char* syntax_message(rapidjson::ParseErrorCode code) {
    switch (code) {
        case rapidjson::kParseErrorDocumentEmpty:
            return "the file is empty, expected a JSON value";
        case rapidjson::kParseErrorDocumentRootNotSingular:
            return "expected the end of the file behind the closing bracket";
        case rapidjson::kParseErrorValueInvalid:
            return "expected a JSON value: an object, array, string, number, true, false or null";
        case rapidjson::kParseErrorObjectMissName:
            return "expected a key in double quotes";
        case rapidjson::kParseErrorObjectMissColon:
            return "expected ':' behind the key";
        case rapidjson::kParseErrorObjectMissCommaOrCurlyBracket:
            return "expected ',' or '}' behind the member";
        case rapidjson::kParseErrorArrayMissCommaOrSquareBracket:
            return "expected ',' or ']' behind the element";
        case rapidjson::kParseErrorStringUnicodeEscapeInvalidHex:
            return "expected four hexadecimal digits behind '\\u'";
        case rapidjson::kParseErrorStringUnicodeSurrogateInvalid:
            return "this '\\u' escape is half of a surrogate pair without its other half";
        case rapidjson::kParseErrorStringEscapeInvalid:
            return "not an escape sequence: expected one of \\\" \\\\ \\/ \\b \\f \\n \\r \\t \\uXXXX";
        case rapidjson::kParseErrorStringMissQuotationMark:
            return "the string does not end: expected a closing '\"'";
        case rapidjson::kParseErrorStringInvalidEncoding:
            return "this is not valid UTF-8 text";
        case rapidjson::kParseErrorNumberTooBig:
            return "the number is too large";
        case rapidjson::kParseErrorNumberMissFraction:
            return "expected a digit behind the decimal point";
        case rapidjson::kParseErrorNumberMissExponent:
            return "expected a digit in the exponent";
        default:
            return "this is not JSON";
    }
}

/// What people write because other formats allow it.
std::string syntax_hint(rapidjson::ParseErrorCode code, std::string_view rest) {
    if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with("#")) return "JSON has no comments";
    if (rest.starts_with("'")) return "JSON strings stand in double quotes";
    if (rest.starts_with("NaN") || rest.starts_with("Inf") || rest.starts_with("-Inf") || rest.starts_with("nan"))
        return "numbers must be finite";
    if (code == rapidjson::kParseErrorObjectMissName && rest.starts_with("}")) return "remove the ',' before it";
    if (code == rapidjson::kParseErrorValueInvalid && rest.starts_with("]")) return "remove the ',' before it";
    if (rest.starts_with("+") || rest.starts_with(".")) return "a number starts with '-' or a digit";
    if (rest.starts_with("True") || rest.starts_with("False")) return "true and false are written in lower case";
    return {};
}

/// RFC 6901, section 3.
void append_token(std::string& pointer, std::string_view token) {
    pointer += '/';
    for (const char c : token) c == '~' ? pointer += "~0" : c == '/' ? pointer += "~1" : pointer += c;
}

Error whole_text_error(const std::string& name, ErrorCode code, std::string message, std::string hint) {
    Error error;
    error.code = code;
    error.message = std::move(message);
    error.where.file = name;
    error.where.line = error.where.column = 1;
    error.hint = std::move(hint);
    return error;
}

}  // namespace

std::string_view kind_name(Kind kind) noexcept {
    static constexpr std::string_view kNames[] = {"null",     "true or false", "a number",
                                                  "a string", "an array",      "an object"};
    return kNames[static_cast<size_t>(kind)];
}

Error error_at(std::string_view text, const std::string& name, size_t offset, std::string message, std::string hint,
               ErrorCode code) {
    TextPosition at = locate(text, offset);
    return {code, std::move(message), {name, at.line, at.column, {}}, std::move(at.excerpt), std::move(hint)};
}

/// Receives the reader's events. Offsets come from the stream: at an opening bracket it stands on it, behind any other
/// token's end when that token is reported.
class TreeBuilder {
public:
    TreeBuilder(Document& document, const rapidjson::MemoryStream& stream, uint32_t max_depth)
        : document_(document), stream_(stream), max_depth_(max_depth) {}

    struct Failure {
        size_t offset;
        std::string message;
        ErrorCode code;
        std::string pointer = {};
    };
    const std::optional<Failure>& failure() const { return failure_; }

    bool Null() { return add(Kind::null, stream_.Tell() - 4, 0); }
    bool Bool(bool value) { return add(Kind::boolean, stream_.Tell() - (value ? 4 : 5), value); }
    bool RawNumber(const char*, rapidjson::SizeType, bool) {
        // Whatever stands before a number is not one of a number's characters.
        const std::string_view before = document_.text_.substr(0, stream_.Tell());
        const size_t last = before.find_last_not_of("0123456789+-.eE");
        const size_t start = last == before.npos ? 0 : last + 1;
        const auto value = parse_double(before.substr(start));
        if (!value || !std::isfinite(*value)) return fail(start, "the number is too large", ErrorCode::bad_input);
        return add(Kind::number, start, std::bit_cast<uint64_t>(*value));
    }
    bool String(const char* bytes, rapidjson::SizeType length, bool) {
        const uint64_t begin = document_.strings_.size();
        document_.strings_.append(bytes, length);
        return add(Kind::string, opening_quote(), begin << 32 | length);
    }
    bool Key(const char* bytes, rapidjson::SizeType length, bool copy) { return String(bytes, length, copy); }
    bool StartObject() { return open(Kind::object); }
    bool StartArray() { return open(Kind::array); }
    bool EndObject(rapidjson::SizeType members) { return close(members); }
    bool EndArray(rapidjson::SizeType elements) { return close(elements); }

    // Never called: numbers arrive as text.
    bool Int(int) { return false; }
    bool Uint(unsigned) { return false; }
    bool Int64(int64_t) { return false; }
    bool Uint64(uint64_t) { return false; }
    bool Double(double) { return false; }

private:
    bool add(Kind kind, size_t offset, uint64_t payload) {
        document_.nodes_.push_back({kind, static_cast<uint32_t>(offset), payload});
        return true;
    }
    bool open(Kind kind) {
        const size_t offset = stream_.Tell();
        if (open_.size() >= max_depth_) {
            fail(offset, "nested deeper than the limit of " + std::to_string(max_depth_) + " levels",
                 ErrorCode::resources);
            failure_->pointer = pointer_of_next();
            return false;
        }
        open_.push_back(static_cast<uint32_t>(document_.nodes_.size()));
        return add(kind, offset, 0);
    }
    bool close(uint64_t size) {
        document_.nodes_[open_.back()].payload = size << 32 | document_.nodes_.size();
        open_.pop_back();
        return true;
    }
    /// Of the value that comes next; of one around it where that would be longer than anybody reads.
    std::string pointer_of_next() const {
        constexpr size_t kLongest = 1000;
        std::string out;
        for (size_t level = 0; level < open_.size(); ++level) {
            const uint32_t node = open_[level];
            const auto child =
                level + 1 < open_.size() ? open_[level + 1] : static_cast<uint32_t>(document_.nodes_.size());
            const size_t bytes = out.size();
            append_token(out, document_.nodes_[node].kind == Kind::object ? Value(document_, child - 1).string()
                                                                          : std::to_string(number_of(node, child)));
            if (out.size() <= kLongest) continue;
            out.resize(bytes);
            break;
        }
        return out;
    }
    /// Of an element of an array that is still open.
    size_t number_of(uint32_t array, uint32_t element) const {
        size_t out = 0;
        for (uint32_t i = array + 1; i < element; ++out) i = Value(document_, i).next_sibling();
        return out;
    }
    /// Of the string that ends right before the stream's position. A quote inside a string has an odd number of
    /// backslashes before it, the opening one has none.
    size_t opening_quote() const {
        const std::string_view text = document_.text_;
        size_t i = stream_.Tell() - 1;
        while (true) {
            const size_t quote = text.rfind('"', i - 1);
            size_t slash = quote;
            while (slash > 0 && text[slash - 1] == '\\') --slash;
            if ((quote - slash) % 2 == 0) return quote;
            i = slash;
        }
    }
    bool fail(size_t offset, std::string message, ErrorCode code) {
        failure_ = Failure{offset, std::move(message), code};
        return false;
    }

    Document& document_;
    const rapidjson::MemoryStream& stream_;
    uint32_t max_depth_;
    std::vector<uint32_t> open_;
    std::optional<Failure> failure_;
};

Result<Document> Document::parse(std::string_view text, const std::string& name, uint32_t max_depth,
                                 std::optional<uint64_t> begin) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text.starts_with(kByteOrderMark)) {
        text.remove_prefix(kByteOrderMark.size());
        if (begin) *begin += kByteOrderMark.size();
    }
    const auto placed = [&](Error error, size_t offset) {
        if (begin) error.where = {name, 0, 0, *begin + offset, std::move(error.where.pointer)};
        return error;
    };
    const auto fail = [&](size_t offset, std::string message, std::string hint = {},
                          ErrorCode code = ErrorCode::bad_input) {
        return placed(error_at(text, name, offset, std::move(message), std::move(hint), code), offset);
    };
    if (text.size() > kMaxTextBytes)
        return placed(
            whole_text_error(name, ErrorCode::resources,
                             "the JSON text has more than the limit of " + std::to_string(kMaxTextBytes) + " bytes",
                             "put large meshes into OBJ or PLY files"),
            0);
    if (const char* encoding = foreign_encoding(text))
        return placed(whole_text_error(name, ErrorCode::bad_input,
                                       std::string("the file is encoded in ") + encoding + ", expected UTF-8",
                                       "save it as UTF-8"),
                      0);
    if (const size_t nul = text.find('\0'); nul != text.npos)
        return fail(nul, "the file contains a NUL byte, expected text");

    Document document;
    document.text_ = text;
    rapidjson::MemoryStream stream(text.data(), text.size());
    TreeBuilder builder(document, stream, max_depth);
    ThrowingAllocator allocator;
    rapidjson::GenericReader<rapidjson::UTF8<>, rapidjson::UTF8<>, ThrowingAllocator> reader(&allocator);
    constexpr unsigned kFlags =
        rapidjson::kParseIterativeFlag | rapidjson::kParseValidateEncodingFlag | rapidjson::kParseNumbersAsStringsFlag;
    const rapidjson::ParseResult result = reader.Parse<kFlags>(stream, builder);
    if (const auto& failure = builder.failure()) {
        Error error = error_at(text, name, failure->offset, failure->message, {}, failure->code);
        error.where.pointer = failure->pointer;
        return placed(std::move(error), failure->offset);
    }
    if (result.IsError()) {
        const size_t at = std::min(result.Offset(), text.size());
        return fail(at, syntax_message(result.Code()), syntax_hint(result.Code(), text.substr(at)));
    }
    return document;
}

std::string Document::pointer(size_t offset) const {
    std::string out;
    Value value = root();
    while (true) {
        // Of the children, which stand in the order of the text, the last one that does not begin behind the offset.
        std::optional<Value> inside;
        std::string token;
        if (value.is(Kind::object)) {
            for (const Member member : value.members()) {
                if (member.key_offset > offset) break;
                inside = member.value;
                token = member.key;
            }
        } else if (value.is(Kind::array)) {
            size_t i = 0;
            for (const Value element : value.elements()) {
                if (element.offset() > offset) break;
                inside = element;
                token = std::to_string(i++);
            }
        }
        if (!inside || offset == value.offset()) return out;
        append_token(out, token);
        value = *inside;
    }
}

void Document::each_pointer(std::span<const size_t> offsets,
                            const std::function<void(size_t, const std::string&)>& visit) const {
    struct Level {
        uint32_t end;       ///< the node behind its last child
        bool object;        ///< its children have keys
        size_t next = 0;    ///< number of the next element of an array
        size_t path_bytes;  ///< of its own pointer
    };
    std::string path;
    std::vector<Level> open;
    size_t number = 0;
    for (uint32_t i = 0; i < nodes_.size() && number < offsets.size(); ++i) {
        while (!open.empty() && i == open.back().end) open.pop_back();
        if (!open.empty()) {
            Level& level = open.back();
            path.resize(level.path_bytes);
            if (level.object)
                append_token(path, Value(*this, i++).string());
            else
                append_token(path, std::to_string(level.next++));
        }
        const Node& node = nodes_[i];
        for (; number < offsets.size() && offsets[number] <= node.offset; ++number)
            if (offsets[number] == node.offset) visit(number, path);
        if (node.kind == Kind::array || node.kind == Kind::object)
            open.push_back({static_cast<uint32_t>(node.payload), node.kind == Kind::object, 0, path.size()});
    }
}

std::optional<Document::Duplicate> Document::duplicate_key() const {
    std::optional<Duplicate> found;
    std::vector<Member> members;
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_[i].kind != Kind::object) continue;
        members.clear();
        for (const Member member : Value(*this, i).members()) members.push_back(member);
        const auto before = [](const Member& a, const Member& b) {
            return a.key != b.key ? a.key < b.key : a.key_offset < b.key_offset;
        };
        std::sort(members.begin(), members.end(), before);
        for (size_t k = 1; k < members.size(); ++k) {
            if (members[k].key != members[k - 1].key) continue;
            if (!found || members[k].key_offset < found->second_offset)
                found = Duplicate{members[k].key, members[k - 1].key_offset, members[k].key_offset};
        }
    }
    return found;
}

Kind Value::kind() const noexcept { return document_->nodes_[node_].kind; }
size_t Value::offset() const noexcept { return document_->nodes_[node_].offset; }
bool Value::boolean() const noexcept { return document_->nodes_[node_].payload != 0; }
double Value::number() const noexcept { return std::bit_cast<double>(document_->nodes_[node_].payload); }
size_t Value::size() const noexcept { return document_->nodes_[node_].payload >> 32; }

std::string_view Value::number_text() const noexcept {
    const std::string_view rest = document_->text_.substr(offset());
    return rest.substr(0, rest.find_first_not_of("0123456789+-.eE"));
}

std::string_view Value::string() const noexcept {
    const uint64_t payload = document_->nodes_[node_].payload;
    return std::string_view(document_->strings_).substr(payload >> 32, payload & 0xffffffffu);
}

uint32_t Value::next_sibling() const noexcept {
    const auto& node = document_->nodes_[node_];
    const bool container = node.kind == Kind::array || node.kind == Kind::object;
    return container ? static_cast<uint32_t>(node.payload) : node_ + 1;
}

Value::Elements Value::elements() const noexcept {
    return {Value(*document_, node_ + 1), Value(*document_, next_sibling())};
}
Value::Members Value::members() const noexcept {
    return {Value(*document_, node_ + 1), Value(*document_, next_sibling())};
}

Value::Elements::Iterator& Value::Elements::Iterator::operator++() noexcept {
    value_.node_ = value_.next_sibling();
    return *this;
}

Member Value::Members::Iterator::operator*() const noexcept {
    return {key_.string(), key_.offset(), Value(*key_.document_, key_.node_ + 1)};
}

Value::Members::Iterator& Value::Members::Iterator::operator++() noexcept {
    key_.node_ = Value(*key_.document_, key_.node_ + 1).next_sibling();
    return *this;
}

}  // namespace steradian::json
