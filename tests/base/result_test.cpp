#include "steradian/result.h"

#include <gtest/gtest.h>

#include <memory>

#include "base/text.h"

namespace steradian {
namespace {

/// The error at `offset` of a text, as a parser would make it.
Error error_at(const std::string& text, size_t offset) {
    const TextPosition at = locate(text, offset);
    return {ErrorCode::bad_input, "no", {"f", at.line, at.column, {}}, at.excerpt, {}};
}

/// The character above the caret, counting characters of the shown line.
std::string pointed_at(const Error& error) {
    const std::string text = error.str();
    const size_t first = text.find('\n'), second = text.find('\n', first + 1);
    EXPECT_NE(second, text.npos) << text;
    const std::string line = text.substr(first + 1, second - first - 1), caret = text.substr(second + 1);
    EXPECT_EQ(caret.find_first_not_of(' '), caret.size() - 1) << text;
    EXPECT_EQ(caret.back(), '^');
    size_t column = 0;
    for (size_t i = 0; i < line.size(); ++i) {
        if ((static_cast<unsigned char>(line[i]) & 0xc0) == 0x80) continue;
        if (column++ == caret.size() - 1) return line.substr(i, 1);
    }
    return "end";
}

TEST(Error, TheFirstLineIsCompleteByItself) {
    Error error{ErrorCode::bad_input, "expected a number", {"a.json", 3, 9, {}}, "  \"x\": no", "try 1"};
    EXPECT_EQ(error.str(), "a.json:3:9: error: expected a number\n    \"x\": no\n          ^\n  hint: try 1");
    error.where = {"b.exr", 0, 0, 17};
    error.excerpt.clear();
    error.hint.clear();
    EXPECT_EQ(error.str(), "b.exr: byte 17: error: expected a number");
    error.where = {};
    EXPECT_EQ(error.str(), "error: expected a number");
}

TEST(Error, TheCaretStandsUnderThePlace) {
    std::string text(300, '.');
    for (size_t offset = 0; offset < text.size(); ++offset) {
        std::string marked = "first\r\n" + text;
        marked[7 + offset] = '#';
        EXPECT_EQ(pointed_at(error_at(marked, 7 + offset)), "#") << offset;
    }
    EXPECT_EQ(pointed_at(error_at(text, text.size())), "end");
}

TEST(Error, TheCaretCountsCharactersAndEscapes) {
    const std::string text = "\t\tä\x01€ '#'";
    EXPECT_EQ(pointed_at(error_at(text, text.find('#'))), "#");
    EXPECT_EQ(error_at(text, 0).str().find('\t'), std::string::npos);
}

TEST(SourceLocation, EscapesWhatATerminalWouldActOn) {
    EXPECT_EQ((SourceLocation{"a\x1b[31mb", 2, 0, {}}.str()), "a\\x1b[31mb:2");
    EXPECT_EQ((SourceLocation{"", 2, 3, {}}.str()), "");
}

TEST(Diagnostics, CountsWhatRepeats) {
    Diagnostics a, b;
    a.warn("one", {"f", 1, 1, {}});
    a.warn("two");
    a.warn("one", {"g", 9, 9, {}}, 4);
    b.warn("one");
    b.append(a);
    ASSERT_EQ(a.warnings().size(), 2u);
    EXPECT_EQ(a.warnings()[0].str(), "f:1:1: warning: one (5 times)");
    EXPECT_EQ(a.warnings()[1].str(), "warning: two");
    EXPECT_EQ(b.warnings()[0].count, 6u);
    EXPECT_TRUE(Diagnostics().empty());
}

TEST(Result, HoldsOneOrTheOther) {
    Result<std::unique_ptr<int>> good(std::make_unique<int>(7));
    ASSERT_TRUE(good.ok());
    EXPECT_EQ(**good, 7);
    const std::unique_ptr<int> moved = *std::move(good);
    EXPECT_EQ(*moved, 7);
    const Result<int> bad(Error{ErrorCode::usage, "m", {}, {}, {}});
    EXPECT_FALSE(bad);
    EXPECT_EQ(bad.error().message, "m");
    EXPECT_THROW((void)bad.value(), std::bad_variant_access);
}

}  // namespace
}  // namespace steradian
