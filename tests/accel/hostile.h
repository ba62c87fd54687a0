// Scenes and rays out of bytes, for the fuzzer and for the tests: whatever the bytes are, there is a scene, and every
// way of asking about it must give the bits of the loop over everything.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenes.h"

namespace steradian::test {

/// A few primitives and instances that coincide, touch, are nested over many orders of magnitude, degenerate, far away
/// or not finite; rays that aim at them in bundles and alone.
struct HostileCase {
    TestScene scene{"bytes"};
    std::vector<Ray> rays;         ///< 1 to 100
    std::vector<uint8_t> batches;  ///< sizes of the spans in which the rays go out, in turn; 1 to 100
    std::vector<Hit> after;        ///< for each ray, to go on from; not always a hit of it
    uint32_t max_depth = 64;
};
HostileCase hostile_case(std::span<const uint8_t> bytes);

/// How hard the cases are, so that a test can see that they are not all empty.
struct HostileCounts {
    size_t cases = 0, refused = 0, rays = 0, hits = 0, ties = 0, cut_outs = 0;
    size_t opened = 0;  ///< hierarchies with parts of instances
};

/// Every builder, kernel, call, and the spans that the case asks for, against brute force. Says what differs; empty
/// when nothing does.
std::string check_hostile_case(const HostileCase& hostile, HostileCounts& counts);

}  // namespace steradian::test
