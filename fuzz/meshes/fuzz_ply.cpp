#include "meshes/check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace steradian;
    check(parse_ply({reinterpret_cast<const char*>(data), size}, "fuzz.ply", {}));
    return 0;
}
