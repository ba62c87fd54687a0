#include "formats/ply/header.h"

#include <algorithm>
#include <charconv>

#include "base/text.h"

namespace steradian::ply {
namespace {

struct TypeName {
    std::string_view name;
    Scalar type;
};
constexpr std::array<TypeName, 16> kTypes{{{"char", Scalar::i8},
                                           {"int8", Scalar::i8},
                                           {"uchar", Scalar::u8},
                                           {"uint8", Scalar::u8},
                                           {"short", Scalar::i16},
                                           {"int16", Scalar::i16},
                                           {"ushort", Scalar::u16},
                                           {"uint16", Scalar::u16},
                                           {"int", Scalar::i32},
                                           {"int32", Scalar::i32},
                                           {"uint", Scalar::u32},
                                           {"uint32", Scalar::u32},
                                           {"float", Scalar::f32},
                                           {"float32", Scalar::f32},
                                           {"double", Scalar::f64},
                                           {"float64", Scalar::f64}}};
constexpr std::array<std::string_view, 8> kKeywords{"ply",     "format",   "comment", "obj_info",
                                                    "element", "property", "list",    "end_header"};

/// Elements and properties together; real files have a few dozen. Keeps the searches for equal names short.
constexpr size_t kMaxEntries = 4096;

class HeaderReader {
public:
    explicit HeaderReader(std::string_view data) : data_(data) {}
    Header read();

private:
    bool next_line();
    std::string_view word();
    [[noreturn]] void fail(std::string_view at, std::string message, std::string hint = {}) const {
        throw ParseFailure{static_cast<size_t>(at.data() - data_.data()), std::move(message), std::move(hint)};
    }
    void end_of_line() {
        if (const std::string_view extra = word(); !extra.empty())
            fail(extra, "unexpected " + quoted(extra) + " at the end of the line");
    }
    void read_format();
    void read_element();
    void read_property();
    Scalar read_type();

    std::string_view data_, line_;
    size_t at_ = 0;
    Header header_;
    bool has_format_ = false;
    bool lone_cr_ = false;  ///< lines end with CR: an LF after end_header is data
    size_t entries_ = 0;
};

/// Sets line_ and moves past its end: LF, CR LF or CR.
bool HeaderReader::next_line() {
    if (at_ >= data_.size()) return false;
    const size_t end = std::min(data_.find_first_of("\r\n", at_), data_.size());
    line_ = data_.substr(at_, end - at_);
    const bool first = at_ == 0;
    at_ = std::min(end + 1, data_.size());
    const bool cr = end < data_.size() && data_[end] == '\r';
    const bool lf_follows = at_ < data_.size() && data_[at_] == '\n';
    if (first) lone_cr_ = cr && !lf_follows;
    if (cr && lf_follows && !lone_cr_) ++at_;
    return true;
}

std::string_view HeaderReader::word() {
    line_.remove_prefix(std::min(line_.find_first_not_of(" \t"), line_.size()));
    const std::string_view found = line_.substr(0, line_.find_first_of(" \t"));
    line_.remove_prefix(found.size());
    return found;
}

void HeaderReader::read_format() {
    const std::string_view name = word();
    if (name == "ascii")
        header_.encoding = Encoding::ascii;
    else if (name == "binary_little_endian")
        header_.encoding = Encoding::little_endian;
    else if (name == "binary_big_endian")
        header_.encoding = Encoding::big_endian;
    else {
        static constexpr std::array<std::string_view, 3> kFormats{"ascii", "binary_little_endian", "binary_big_endian"};
        fail(name, "unknown format " + quoted(name), suggestion(name, kFormats));
    }
    const std::string_view version = word();
    if (version != "1.0") fail(version, "unknown version " + quoted(version) + ", expected 1.0");
    if (has_format_) fail(name, "a second format line");
    has_format_ = true;
    end_of_line();
}

void HeaderReader::read_element() {
    Element element;
    element.name = word();
    element.offset = static_cast<size_t>(element.name.data() - data_.data());
    if (element.name.empty()) fail(element.name, "expected the name of an element");
    for (const Element& other : header_.elements)
        if (other.name == element.name) fail(element.name, "a second element " + quoted(element.name));
    const std::string_view count = word();
    const auto [stop, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || stop != count.data() + count.size())
        fail(count, quoted(count) + " is not a count of elements, expected a whole number");
    end_of_line();
    header_.elements.push_back(std::move(element));
}

Scalar HeaderReader::read_type() {
    const std::string_view name = word();
    const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeName& t) { return t.name == name; });
    if (found != kTypes.end()) return found->type;
    std::array<std::string_view, kTypes.size()> names;
    std::transform(kTypes.begin(), kTypes.end(), names.begin(), [](const TypeName& t) { return t.name; });
    fail(name, "unknown type " + quoted(name), suggestion(name, names));
}

void HeaderReader::read_property() {
    if (header_.elements.empty()) fail(line_, "a property before the first element");
    Element& element = header_.elements.back();
    Property property;
    const std::string_view left = line_;
    if (word() == "list") {
        property.is_list = true;
        property.count_type = read_type();
    } else {
        line_ = left;
    }
    property.type = read_type();
    property.name = word();
    if (property.name.empty()) fail(property.name, "expected the name of a property");
    if (element.find({property.name}) >= 0)
        fail(property.name, "a second property " + quoted(property.name) + " of element " + quoted(element.name));
    end_of_line();
    element.properties.push_back(property);
}

Header HeaderReader::read() {
    if (!next_line() || word() != "ply") throw ParseFailure{0, "not a PLY file: it does not begin with 'ply'", {}};
    end_of_line();
    while (next_line()) {
        const std::string_view keyword = word();
        if ((keyword == "element" || keyword == "property") && ++entries_ > kMaxEntries)
            throw ParseFailure{
                at_, "more than " + std::to_string(kMaxEntries) + " elements and properties", {}, ErrorCode::resources};
        if (keyword == "format")
            read_format();
        else if (keyword == "element")
            read_element();
        else if (keyword == "property")
            read_property();
        else if (keyword == "end_header") {
            if (!has_format_) fail(keyword, "the header has no format line");
            header_.end_line = static_cast<size_t>(keyword.data() - data_.data());
            header_.size = at_;
            return std::move(header_);
        } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
            fail(keyword, "unknown keyword " + quoted(keyword) + " in the header", suggestion(keyword, kKeywords));
        }
    }
    throw ParseFailure{data_.size(), "the file ends inside of the header, expected end_header", {}};
}

}  // namespace

bool Element::has_lists() const {
    return std::any_of(properties.begin(), properties.end(), [](const Property& p) { return p.is_list; });
}

uint64_t Element::least_bytes(Encoding encoding) const {
    uint64_t bytes = 0;
    // In ascii files a digit and a separator.
    for (const Property& p : properties)
        bytes += encoding == Encoding::ascii ? 2 : size_of(p.is_list ? p.count_type : p.type);
    return bytes;
}

int Element::find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view wanted : names)
        for (size_t i = 0; i < properties.size(); ++i)
            if (properties[i].name == wanted) return static_cast<int>(i);
    return -1;
}

Header read_header(std::string_view data) { return HeaderReader(data).read(); }

}  // namespace steradian::ply
