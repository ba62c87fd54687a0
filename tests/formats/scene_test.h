// Scenes in the tests are written as text; errors are expected at a mark in that text.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "steradian/load.h"
#include "support/support.h"

namespace steradian::test {

inline constexpr std::string_view kMark = "§";  ///< stands right before the byte that an error must point at

/// A folder that does not exist: scenes that name no files need none.
inline Result<LoadedScene> load_text(std::string_view text, const std::string& folder = "/nonexistent") {
    return load_scene_json(text, "test.json", folder);
}

inline LoadedScene load_good(std::string_view text, const std::string& folder = "/nonexistent") {
    auto loaded = load_text(text, folder);
    if (!loaded) throw std::runtime_error(loaded.error().str());
    return std::move(loaded).value();
}

/// `marked` with its mark must be refused at the mark, with these parts in the message and the hint, and with that
/// line as its excerpt.
inline void expect_error(std::string_view marked, std::string_view message, std::string_view hint = {},
                         const std::string& folder = "/nonexistent") {
    SCOPED_TRACE(marked);
    const size_t mark = marked.find(kMark);
    ASSERT_NE(mark, marked.npos) << "no mark";
    std::string text(marked);
    text.erase(mark, kMark.size());
    uint32_t line = 1, column = 1;
    for (const char c : text.substr(0, mark)) {
        ++column;
        if (c == '\n') ++line, column = 1;
    }
    const auto loaded = load_text(text, folder);
    ASSERT_FALSE(loaded.ok()) << "was accepted";
    const Error& error = loaded.error();
    EXPECT_EQ(error.where.file, "test.json") << error.str();
    EXPECT_EQ(error.where.line, line) << error.str();
    EXPECT_EQ(error.where.column, column) << error.str();
    EXPECT_NE(error.message.find(message), std::string::npos) << error.str();
    EXPECT_NE(error.hint.find(hint), std::string::npos) << error.str();
    if (hint.empty()) {
        EXPECT_EQ(error.message.find('\n'), std::string::npos);
    }
    EXPECT_FALSE(error.excerpt.empty()) << error.str();
}

/// A scene of ours with these members besides the version and a camera.
inline std::string scene_with(std::string_view members) {
    return std::string("{\"version\": 1, \"camera\": {\"position\": [0, 0, 5], \"look_at\": [0, 0, 0]}") +
           (members.empty() ? "" : ",\n") + std::string(members) + "}";
}
inline std::string scene_with_object(std::string_view object) {
    return scene_with("\"objects\": [" + std::string(object) + "]");
}
inline std::string scene_with_light(std::string_view light) {
    return scene_with("\"lights\": [" + std::string(light) + "]");
}

}  // namespace steradian::test
