// Keeps the lengths inside of binary glTF right, so that mutations reach what is behind the container: one chunk at a
// time is mutated and the file is put together again. One time in eight, and for text, the bytes are mutated as they
// are.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

uint32_t word_at(const std::string& bytes, size_t at) {
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

void put_word(std::string& bytes, uint32_t word) {
    char raw[4];
    std::memcpy(raw, &word, sizeof word);
    bytes.append(raw, sizeof raw);
}

/// Type and content of each chunk; empty where the container is broken.
struct Chunk {
    uint32_t type;
    std::string content;
};
std::vector<Chunk> chunks_of(const std::string& bytes) {
    std::vector<Chunk> out;
    if (bytes.size() < 12 || bytes.compare(0, 4, "glTF") != 0) return {};
    for (size_t at = 12; at + 8 <= bytes.size();) {
        const uint32_t length = word_at(bytes, at);
        if (length > bytes.size() - at - 8) return {};
        out.push_back({word_at(bytes, at + 4), bytes.substr(at + 8, length)});
        at += 8 + length;
    }
    return out;
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
    std::vector<Chunk> chunks = chunks_of({reinterpret_cast<const char*>(data), size});
    if (chunks.empty() || seed % 8 == 0) return LLVMFuzzerMutate(data, size, max_size);
    std::string& content = chunks[seed / 8 % chunks.size()].content;
    const size_t length = content.size(), room = max_size > size + 4 ? max_size - size - 4 : 0;
    content.resize(length + room);
    content.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(content.data()), length, content.size()));
    std::string out;
    for (Chunk& chunk : chunks) {
        chunk.content.resize((chunk.content.size() + 3) / 4 * 4, ' ');
        put_word(out, static_cast<uint32_t>(chunk.content.size()));
        put_word(out, chunk.type);
        out += chunk.content;
    }
    std::string head = "glTF";
    put_word(head, 2);
    put_word(head, static_cast<uint32_t>(out.size() + 12));
    out = head + out;
    if (out.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(data, out.data(), out.size());
    return out.size();
}
