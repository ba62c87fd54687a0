// The first half of reading an OBJ file: its text as numbers, in file order.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "formats/obj/notes.h"
#include "steradian/vec.h"

namespace steradian::obj {

inline constexpr int32_t kNone = -1;

/// Indices into the file's lists, counted from 0; kNone where the file gives none. Always in range.
struct Corner {
    int32_t position = kNone, uv = kNone, normal = kNone;
};

/// What `usemtl`, `s`, `o` and `g` have said; nothing where none has come yet. The views point into the text.
struct State {
    std::optional<std::string_view> material;
    std::optional<std::string_view> group;
    std::optional<uint32_t> smoothing;  ///< 0: off
};

/// Faces that follow each other under one state.
struct Run {
    State state;
    std::vector<uint32_t> sizes;  ///< corners per face, each >= 3
    std::vector<Corner> corners;  ///< of all the faces, one after the other
};

enum class Remark : uint8_t {
    points,     ///< p
    lines,      ///< l
    free_form,  ///< curves and surfaces
    unknown_keyword,
    uvs_missing,      ///< faces refer to vt, and the file has none
    normals_missing,  ///< faces refer to vn, and the file has none
    bad_smoothing,    ///< neither a number nor on or off
};

struct Library {
    std::string_view names;  ///< all that follows `mtllib`
    size_t offset;           ///< of the names
};

struct Records {
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;    ///< as in the file
    std::vector<Rgb> colors;  ///< of the positions, as in the file; empty where none has one
    std::vector<Run> runs;
    std::vector<Library> libraries;
    Notes<Remark> notes;
};

/// Throws ParseFailure for the first fault in the text. Works on chunks of the text in parallel; the result does not
/// depend on how many threads there are.
Records read_records(std::string_view text);

/// The same with chunks of about `chunk_bytes`, for tests.
Records read_records(std::string_view text, size_t chunk_bytes);

}  // namespace steradian::obj
