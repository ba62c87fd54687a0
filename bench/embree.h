// Embree's side of the benchmark: every setting of it that can be chosen for triangles.
#pragma once

#include <atomic>
#include <compare>

#include "race.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace steradian::bench {

/// What a hierarchy is built with.
struct EmbreeBuild {
    std::string isa;    ///< as in Embree's configuration
    bool high = false;  ///< spatial splits, else medium quality
    bool robust = false;

    std::string str() const;
    auto operator<=>(const EmbreeBuild&) const = default;
};

/// How rays are handed over.
struct EmbreeFeed {
    enum class Kind : uint8_t { single, packet, stream, soa_stream };  // rtcIntersect1, 4/8/16, 1M, Np
    Kind kind = Kind::single;
    uint32_t width = 1;     ///< rays in a packet
    bool coherent = false;  ///< the flag of the context

    std::string str() const;
    auto operator<=>(const EmbreeFeed&) const = default;
};

/// The instruction sets that both the machine and the library have.
std::vector<std::string> embree_isas();

class EmbreeScene {
public:
    /// Medium or high quality over the mesh's own arrays; `threads` 0 is all of the machine's. Throws
    /// std::runtime_error when Embree refuses.
    EmbreeScene(const BenchMesh& mesh, const EmbreeBuild& build, uint32_t threads = 0);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// Those which this instruction set has natively. `coherent`: with the flag and without, else without.
    std::vector<EmbreeFeed> feeds(bool coherent) const;
    /// The scene must outlive the tracers.
    MakeTracer tracer(const EmbreeFeed& feed) const;

    double wall_build_seconds() const { return wall_seconds_; }  ///< from an empty scene, devices already there
    double cpu_build_seconds() const { return cpu_seconds_; }
    int64_t bytes() const { return bytes_; }            ///< held, as the memory monitor counts
    int64_t peak_bytes() const { return peak_bytes_; }  ///< during the build

private:
    bool count_memory(int64_t bytes);

    RTCDeviceTy* device_ = nullptr;
    RTCSceneTy* scene_ = nullptr;
    double wall_seconds_ = 0, cpu_seconds_ = 0;
    std::atomic<int64_t> bytes_ = 0, peak_bytes_ = 0;
};

}  // namespace steradian::bench
