#include "base/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
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

}  // namespace steradian
