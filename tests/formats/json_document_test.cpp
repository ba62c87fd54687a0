#include "formats/json/document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "support/support.h"

namespace steradian::json {
namespace {

Result<Document> parse(std::string_view text, uint32_t depth = 256) {
    return Document::parse(text, "test.json", depth);
}

struct Place {
    uint32_t line, column;
};
void expect_refused(std::string_view text, Place place, std::string_view message, std::string_view hint = {}) {
    SCOPED_TRACE(std::string(text.substr(0, 80)));
    const auto document = parse(text);
    ASSERT_FALSE(document.ok());
    EXPECT_EQ(document.error().where.line, place.line) << document.error().str();
    EXPECT_EQ(document.error().where.column, place.column) << document.error().str();
    EXPECT_NE(document.error().message.find(message), std::string::npos) << document.error().str();
    EXPECT_NE(document.error().hint.find(hint), std::string::npos) << document.error().str();
}

TEST(JsonDocument, EveryValueKnowsItsPlace) {
    const std::string_view text =
        " {\"a\": [1, -2.5e3 ,true,false, null,\"x\\\"y\\\\\"], \"b\\\"\\\\\":{} , \"\": \"\"}";
    const auto document = parse(text);
    ASSERT_TRUE(document.ok());
    const Value root = document->root();
    EXPECT_EQ(root.kind(), Kind::object);
    EXPECT_EQ(root.offset(), 1u);
    EXPECT_EQ(root.size(), 3u);
    std::vector<Member> members;
    for (const Member member : root.members()) members.push_back(member);
    ASSERT_EQ(members.size(), 3u);
    EXPECT_EQ(members[0].key, "a");
    EXPECT_EQ(members[1].key, "b\"\\");
    EXPECT_EQ(members[2].key, "");
    EXPECT_EQ(members[0].key_offset, text.find("\"a\""));
    EXPECT_EQ(members[1].key_offset, text.find("\"b"));
    EXPECT_EQ(members[2].key_offset, text.find("\"\":"));
    EXPECT_EQ(members[1].value.offset(), text.find("{}"));
    EXPECT_EQ(members[1].value.size(), 0u);
    EXPECT_EQ(members[2].value.offset(), text.size() - 3);

    std::vector<Value> elements;
    for (const Value element : members[0].value.elements()) elements.push_back(element);
    ASSERT_EQ(elements.size(), 6u);
    const std::string_view expected[] = {"1,", "-2.5e3", "true", "false", "null", "\"x"};
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(elements[i].offset(), text.find(expected[i])) << i;
    EXPECT_EQ(elements[1].number(), -2500);
    EXPECT_EQ(elements[1].number_text(), "-2.5e3");
    EXPECT_TRUE(elements[2].boolean());
    EXPECT_FALSE(elements[3].boolean());
    EXPECT_EQ(elements[4].kind(), Kind::null);
    EXPECT_EQ(elements[5].string(), "x\"y\\");
}

TEST(JsonDocument, NestedContainersAreSkippedAsAWhole) {
    const auto document = parse("[[1,[2]],{\"k\":[3,4]},5]");
    ASSERT_TRUE(document.ok());
    std::vector<Kind> kinds;
    for (const Value element : document->root().elements()) kinds.push_back(element.kind());
    EXPECT_EQ(kinds, (std::vector{Kind::array, Kind::object, Kind::number}));
}

TEST(JsonDocument, NumbersAreTheNearestDoubles) {
    const auto document = parse("[0.1, 1e-999, -0, 123456789012345678901234567890, 1.7976931348623157e308, 5e-324]");
    ASSERT_TRUE(document.ok());
    std::vector<double> numbers;
    for (const Value element : document->root().elements()) numbers.push_back(element.number());
    EXPECT_EQ(numbers[0], 0.1);
    EXPECT_EQ(numbers[1], 0.0);
    EXPECT_TRUE(numbers[2] == 0 && std::signbit(numbers[2]));
    EXPECT_EQ(numbers[3], 123456789012345678901234567890.0);
    EXPECT_EQ(numbers[4], 1.7976931348623157e308);
    EXPECT_EQ(numbers[5], 5e-324);
}

TEST(JsonDocument, NumbersBeyondDoubleAreRefused) {
    expect_refused("[1,\n 1e999]", {2, 2}, "too large");
    expect_refused("[-1e400]", {1, 2}, "too large");
    expect_refused("[1.8e308]", {1, 2}, "too large");
    const std::string million_digits(1'000'000, '7');
    expect_refused("[" + million_digits + "]", {1, 2}, "too large");
    const std::string small = "[0." + std::string(1'000'000, '0') + "7]";
    ASSERT_TRUE(parse(small).ok());
    EXPECT_EQ((*parse(small)->root().elements().begin()).number(), 0.0);
}

TEST(JsonDocument, SyntaxErrorsPointAtTheirPlace) {
    expect_refused("", {1, 1}, "empty");
    expect_refused("  \n ", {2, 2}, "empty");
    expect_refused("{\"a\": 1,}", {1, 9}, "key in double quotes", "remove the ','");
    expect_refused("[1,2,]", {1, 6}, "expected a JSON value", "remove the ','");
    expect_refused("[1 2]", {1, 4}, "',' or ']'");
    expect_refused("{\"a\" 1}", {1, 6}, "':'");
    expect_refused("{\"a\": 1 \"b\": 2}", {1, 9}, "',' or '}'");
    expect_refused("{a: 1}", {1, 2}, "key in double quotes");
    expect_refused("{'a': 1}", {1, 2}, "key in double quotes", "double quotes");
    expect_refused("[1, // one\n 2]", {1, 5}, "JSON value", "no comments");
    expect_refused("[NaN]", {1, 2}, "JSON value", "finite");
    expect_refused("[1.]", {1, 4}, "digit behind the decimal point");
    expect_refused("[1e]", {1, 4}, "digit in the exponent");
    expect_refused("[.5]", {1, 2}, "JSON value", "starts with");
    expect_refused("[0x10]", {1, 3}, "',' or ']'");
    expect_refused("[\"a\\q\"]", {1, 4}, "escape sequence");
    expect_refused("[\"\\ud800\"]", {1, 3}, "surrogate");
    expect_refused("[\"\xff\"]", {1, 3}, "UTF-8");
    expect_refused("{} x", {1, 4}, "end of the file");
    expect_refused("[1.2.3]", {1, 5}, "',' or ']'");
    expect_refused("[\n1,\r\n2,\r3;]", {4, 2}, "',' or ']'");
}

TEST(JsonDocument, EncodingsOtherThanUtf8AreNamed) {
    expect_refused(std::string_view("\xff\xfe{\0}\0", 6), {1, 1}, "UTF-16 (little-endian)", "UTF-8");
    expect_refused(std::string_view("\xfe\xff\0{\0}", 6), {1, 1}, "UTF-16 (big-endian)", "UTF-8");
    expect_refused(std::string_view("{\0}\0", 4), {1, 1}, "UTF-16 (little-endian)");
    expect_refused(std::string_view("\0{\0}", 4), {1, 1}, "UTF-16 (big-endian)");
    expect_refused(std::string_view("\xff\xfe\0\0{\0\0\0", 8), {1, 1}, "UTF-32 (little-endian)", "UTF-8");
    expect_refused(std::string_view("\0\0\xfe\xff\0\0\0{", 8), {1, 1}, "UTF-32 (big-endian)", "UTF-8");
    expect_refused(std::string_view("{\0\0\0}\0\0\0", 8), {1, 1}, "UTF-32 (little-endian)");
    expect_refused(std::string_view("\0\0\0{\0\0\0}", 8), {1, 1}, "UTF-32 (big-endian)");
    expect_refused(std::string_view("{\"a\":\n\"x\0y\"}", 12), {2, 3}, "NUL");
    expect_refused(std::string_view("{}\0", 3), {1, 3}, "NUL");
}

TEST(JsonDocument, AByteOrderMarkIsSkipped) {
    const auto document = parse("\xef\xbb\xbf{\"a\": 1}");
    ASSERT_TRUE(document.ok());
    EXPECT_EQ(document->root().offset(), 0u);
    expect_refused("\xef\xbb\xbf{x}", {1, 2}, "key");
}

TEST(JsonDocument, DepthIsLimitedWithoutRecursion) {
    const auto nested = [](size_t depth, char open, char close) {
        return std::string(depth, open) + std::string(depth, close);
    };
    EXPECT_TRUE(parse(nested(256, '[', ']')).ok());
    expect_refused(nested(257, '[', ']'), {1, 257}, "deeper than the limit of 256");
    expect_refused(std::string(1'000'000, '['), {1, 257}, "deeper than the limit of 256");
    std::string objects;
    for (int i = 0; i < 1000; ++i) objects += "{\"a\":";
    expect_refused(objects, {1, 256 * 5 + 1}, "deeper than the limit of 256");
    const auto pointer_of = [](std::string_view text, uint32_t depth) {
        const auto document = parse(text, depth);
        return document.ok() ? "(good)" : document.error().where.pointer;
    };
    EXPECT_EQ(pointer_of("[1, [], {\"x\": {\"deep\": [1]}, \"a/b~\": [[2], {\"y\": 1}, [[3]]]}]", 4), "/2/a~1b~0/2/0");
    EXPECT_EQ(pointer_of("[]", 0), "");
    EXPECT_EQ(pointer_of(objects, 3), "/a/a/a");
    // As much of it as somebody may want to read.
    EXPECT_EQ(pointer_of("[{\"a\": {\"" + std::string(1000, 'k') + "\": []}}]", 3), "/0/a");
    // Even a million levels are read, walked and destroyed where somebody allows them.
    const std::string million = nested(1'000'000, '[', ']');
    const auto deep = parse(million, 2'000'000);
    ASSERT_TRUE(deep.ok());
    EXPECT_EQ(deep->root().size(), 1u);
    EXPECT_FALSE(deep->duplicate_key());
}

TEST(JsonDocument, FindsTheFirstDuplicateKey) {
    const std::string_view text = "{\"a\": {\"x\": 1, \"y\": 2}, \"b\": [{\"x\": 1, \"\\u0078\": 2}], \"a\": 3}";
    const auto document = parse(text);
    ASSERT_TRUE(document.ok());
    const auto duplicate = document->duplicate_key();
    ASSERT_TRUE(duplicate);
    EXPECT_EQ(duplicate->key, "x");
    EXPECT_EQ(duplicate->second_offset, text.find("\"\\u0078"));
    EXPECT_EQ(duplicate->first_offset, text.find("\"x\": 1, \"\\"));
    EXPECT_FALSE(parse("{\"a\": {\"a\": [{\"a\": 1}, {\"a\": 2}]}}")->duplicate_key());
}

TEST(JsonDocument, ManyKeysAreCheckedInReasonableTime) {
    std::string text = "{";
    for (int i = 0; i < 200'000; ++i) text += "\"key" + std::to_string(i) + "\":0,";
    text += "\"key7\":1}";
    const auto document = parse(text);
    ASSERT_TRUE(document.ok());
    ASSERT_TRUE(document->duplicate_key());
    EXPECT_EQ(document->duplicate_key()->key, "key7");
}

TEST(JsonSuite, AcceptsAndRefusesWhatItMust) {
    const auto shared = test::shared_folder();
    if (!shared) GTEST_SKIP() << "the folder of outside test files is missing";
    const auto folder = *shared / "suites" / "json_testsuite" / "test_parsing";
    size_t accepted = 0, refused = 0, either = 0;
    std::set<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.insert(entry.path());
    for (const auto& path : paths) {
        const std::string name = path.filename().string(), text = test::slurp(path);
        SCOPED_TRACE(name);
        const auto document = Document::parse(text, name, 1000);
        if (name.starts_with("y_")) {
            EXPECT_TRUE(document.ok()) << document.error().str();
            ++accepted;
        } else if (name.starts_with("n_")) {
            ASSERT_FALSE(document.ok());
            EXPECT_GE(document.error().where.line, 1u);
            EXPECT_GE(document.error().where.column, 1u);
            EXPECT_FALSE(document.error().message.empty());
            ++refused;
        } else {
            ++either;
        }
    }
    EXPECT_EQ(accepted, 95u);
    EXPECT_EQ(refused, 188u);
    EXPECT_EQ(either, 35u);
}

}  // namespace
}  // namespace steradian::json
