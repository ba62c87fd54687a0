#include "formats/mesh/parse_failure.h"
#include "formats/obj/records.h"
#include "meshes/check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace steradian;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto file = parse_obj(text, "fuzz.obj", "no-such-folder", {.allow_outside_paths = false});
    check(file);
    // Small chunks must find the same records or the same fault.
    const auto summary = [&](size_t chunk) -> std::pair<size_t, size_t> {
        try {
            const obj::Records records = obj::read_records(text, chunk);
            size_t corners = 0;
            for (const obj::Run& run : records.runs) corners += run.corners.size();
            return {records.positions.size() + records.uvs.size() + records.normals.size(), corners};
        } catch (const ParseFailure& failure) {
            return {SIZE_MAX, failure.offset};
        }
    };
    require(summary(7) == summary(size + 1));
    return 0;
}
