// What a parser noticed and did not stop for, with a bound on how many different things are kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace steradian::obj {

/// Remarks are told apart by kind and word; `word` must outlive the object. A hostile file can make any number of
/// different ones: beyond kMaxDifferent they share one remark of their kind with an empty word.
template <class Kind>
class Notes {
public:
    struct Note {
        Kind kind;
        std::string_view word;
        size_t offset;  ///< of the first occurrence
        uint64_t count;
    };
    static constexpr size_t kMaxDifferent = 32;

    void add(Kind kind, std::string_view word, size_t offset, uint64_t count = 1) {
        if (raise(kind, word, count)) return;
        if (notes_.size() >= kMaxDifferent) {
            word = {};
            if (raise(kind, word, count)) return;
        }
        notes_.push_back({kind, word, offset, count});
    }
    void append(const Notes& other) {
        for (const Note& note : other.notes_) add(note.kind, note.word, note.offset, note.count);
    }
    const std::vector<Note>& all() const { return notes_; }

private:
    bool raise(Kind kind, std::string_view word, uint64_t count) {
        for (Note& note : notes_)
            if (note.kind == kind && note.word == word) {
                note.count += count;
                return true;
            }
        return false;
    }
    std::vector<Note> notes_;
};

}  // namespace steradian::obj
