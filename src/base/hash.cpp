#include "base/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
#include <cstring>
#include <new>

namespace steradian {

static_assert(std::endian::native == std::endian::little, "hashes are defined over little-endian bytes");

Hasher::Hasher() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(static_cast<XXH3_state_t*>(state_));
}

Hasher::~Hasher() { XXH3_freeState(static_cast<XXH3_state_t*>(state_)); }

void Hasher::bytes(const void* data, size_t size) {
    if (size) XXH3_128bits_update(static_cast<XXH3_state_t*>(state_), data, size);
}

std::string Hasher::hex() const {
    static constexpr char kHex[] = "0123456789abcdef";
    const XXH128_hash_t digest = XXH3_128bits_digest(static_cast<const XXH3_state_t*>(state_));
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, digest);
    std::string out;
    for (const unsigned char byte : canonical.digest) out += {kHex[byte >> 4], kHex[byte & 15]};
    return out;
}

uint32_t murmur_hash3(std::string_view bytes, uint32_t seed) noexcept {
    const auto scrambled = [](uint32_t word) { return std::rotl(word * 0xcc9e2d51u, 15) * 0x1b873593u; };
    uint32_t hash = seed;
    std::string_view rest = bytes;
    for (; rest.size() >= 4; rest.remove_prefix(4)) {
        uint32_t word = 0;
        std::memcpy(&word, rest.data(), 4);
        hash = std::rotl(hash ^ scrambled(word), 13) * 5 + 0xe6546b64u;
    }
    uint32_t tail = 0;
    std::memcpy(&tail, rest.data(), rest.size());
    hash ^= scrambled(tail);
    hash ^= static_cast<uint32_t>(bytes.size());
    hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
    return hash ^ (hash >> 16);
}

}  // namespace steradian
