// What AOVs tell of the surface that a camera ray meets first, for each path of a batch.
#pragma once

#include <vector>

#include "render/integrator.h"
#include "shading/bsdf.h"
#include "shading/surface.h"

namespace steradian {

class FirstHits {
public:
    /// For `paths` paths at a time; for none where no AOV asks.
    FirstHits(const RenderContext& context, uint32_t paths);
    static uint64_t bytes_per_path(AovSet aovs) noexcept;

    bool wanted() const noexcept { return !states_.empty(); }
    /// A new camera sample, so far from the pixel's centre.
    void begin(uint32_t path, Vec2 offset) noexcept;
    /// The camera ray has arrived at `point`.
    void see(uint32_t path, const SampleKey& key, const SurfacePoint& point, Vec3 wo) noexcept;
    /// Adds the sample to the sums of its pixel. May throw std::bad_alloc, where a pixel shows many mattes.
    void add_to(TileSums& sums, uint32_t pixel, uint32_t path, float filter_weight) const;

private:
    struct State {
        bool found = false;
        Rgb albedo;
        Vec3 normal;
        CentreSample sample;
    };
    void see_bsdf(State& state, const SampleKey& key, const SurfacePoint& point, Vec3 wo) const noexcept;

    const RenderContext& c_;
    bool bsdfs_;  ///< whether an AOV asks for what a BSDF tells
    std::vector<State> states_;
};

}  // namespace steradian
