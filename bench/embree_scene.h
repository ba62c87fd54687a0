// Embree 3 behind the calls that the benchmark makes.
#pragma once

#include <memory>
#include <span>

#include "workload.h"

namespace steradian::bench {

class EmbreeScene {
public:
    /// One triangle mesh, medium build quality; `threads` 0 is all of the machine's.
    EmbreeScene(const BenchMesh& mesh, bool robust, unsigned threads);
    ~EmbreeScene();
    EmbreeScene(EmbreeScene&&) noexcept;

    /// One ray at a time.
    void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
    void occluded(std::span<const Ray> rays, std::span<uint8_t> result) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace steradian::bench
