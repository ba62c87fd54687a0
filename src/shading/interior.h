// Which dielectric bodies a point is in, and which of them fills it.
#pragma once

#include <array>
#include <cstdint>

#include "math/ray.h"
#include "math/vector.h"
#include "steradian/scene.h"

namespace steradian {

struct ShadingScene;

/// What a material makes of the inside of its surfaces.
struct Dielectric {
    float eta = 1.5f;  ///< over vacuum where there is a priority, else over what is around it
    Medium medium;
    Priority priority;
};

inline constexpr uint32_t kVacuum = 0xffffffffu;

/// A list of bodies, which are named by their materials: all surfaces of one material bound one body, their union.
/// The last of the list fills the point, nothing stands for vacuum. Among bodies with priorities the order is theirs. A
/// body without one comes last when it is entered, so that inside it priorities begin anew. More than kMost at a time
/// are not kept track of: another one is not entered, and leaving it changes nothing.
class Interior {
public:
    static constexpr uint32_t kMost = 8;

    void enter(const ShadingScene& scene, uint32_t material) noexcept;
    void leave(uint32_t material) noexcept;
    bool contains(uint32_t material) const noexcept { return find(material) < count_; }
    /// The material whose body fills the point.
    uint32_t filling() const noexcept { return count_ > 0 ? bodies_[count_ - 1].material : kVacuum; }
    /// The index of refraction over vacuum.
    float index(const ShadingScene& scene) const noexcept;
    /// Null for vacuum.
    const Medium* medium(const ShadingScene& scene) const noexcept;

private:
    struct Body {
        uint32_t material = kVacuum;
        uint32_t times = 1;  ///< entered more often than left
    };
    uint32_t find(uint32_t material) const noexcept;

    std::array<Body, kMost> bodies_{};
    uint32_t count_ = 0;
};

/// Whether of two bodies with priorities the first one is where both are.
bool covers(const ShadingScene& scene, uint32_t first, uint32_t second) noexcept;

inline bool scatters(const Medium& medium) { return !is_black(medium.scattering); }

/// What is left of light, absorbed and scattered away, after so many metres, which may be infinite.
Rgb transmittance(const Medium& medium, double distance) noexcept;

/// Where a path is scattered, by the coefficient of one channel: `u` decides which, in proportion to the throughput,
/// and how far; infinite where it does not scatter. (One-sample multiple importance sampling by the balance heuristic,
/// Veach 1997, section 9.2.4; of wavelengths Wilkie et al. 2014, "Hero Wavelength Spectral Sampling".)
double sample_scattering(const Medium& medium, Rgb throughput, Vec2 u) noexcept;

/// What becomes of the throughput of such a path that has come so far and is scattered there, or has reached a surface
/// or infinity: as a factor, over the density with which any of the channels would have brought it there.
Rgb scattering_weight(const Medium& medium, Rgb throughput, double distance, bool scattered) noexcept;

}  // namespace steradian
