// The sums of a picture that is sampled up to a target for its error: which pixels get more samples, and what the error
// is. Everything is decided at the ends of passes, from sums that are fixed by the sample index, so the picture is the
// same whoever computed what when.
//
// Every pixel has kReplicates independent sequences, in two groups of half of them. Each group finds out by itself how
// many samples the cells of 8 × 8 pixels (in absolute coordinates) need, and goes on until it knows; then the *other*
// group is averaged over so many. So the number of samples that a mean is taken over has nothing to do with what they
// brought, and stopping makes no bias at all. Why, what it costs, and why the error is at most what is claimed, is in
// docs/decisions/0016; the figures are in docs/verification.md.
#pragma once

#include <array>
#include <mutex>
#include <vector>

#include "render/allocation.h"
#include "render/aov.h"
#include "render/error_estimate.h"
#include "render/film.h"
#include "render/integrator.h"

namespace steradian {

class AdaptiveFilm {
public:
    /// `most_samples` of a pixel: at least kReplicates × 2.
    AdaptiveFilm(Crop window, double target, uint64_t most_samples, AovSet aovs = {});

    static uint64_t bytes_per_pixel(AovSet aovs) noexcept {
        return kReplicates * sizeof(RgbSum) + 8 + 2 * (kinds_of(aovs).bytes_per_pixel() - sizeof(RgbSum));
    }
    static constexpr uint32_t kCellSize = 8;

    /// Ends a pass and decides the next one; false when there is none. No unit may be under way.
    bool begin_pass();
    /// Of the pass.
    size_t units() const noexcept { return pass_.size(); }
    const WorkUnit& work(size_t unit) const noexcept { return pass_[unit].work; }
    /// Whether the unit's samples have been rendered before: its group was sampled further than it counts.
    bool again(size_t unit) const noexcept { return pass_[unit].again; }
    /// The sums to which the unit is added, of colour one for each pixel and replicate; what they have become goes to
    /// commit().
    TileSums sums(size_t unit) const;
    void commit(size_t unit, TileSums sums);

    /// What is still to be rendered, over all pixels, as far as this pass's plan can tell.
    uint64_t samples_to_come() const noexcept { return to_come_; }
    /// R, G, B means and the AOVs. Safe while others commit.
    Image develop() const;
    struct Samples {
        uint64_t min = 0, max = 0;  ///< of a pixel
        uint64_t total = 0;
    };
    Samples samples() const;
    /// Once there is no pass any more.
    ErrorReport report() const;

private:
    /// Half of the replicates.
    struct Group {
        uint64_t samples = 0;  ///< of each pixel
        TileSums sums;         ///< of colour kGroupReplicates for each pixel
    };
    struct Cell {
        TileRect tile;
        std::array<Group, 2> groups;
        uint64_t samples() const noexcept { return groups[0].samples + groups[1].samples; }
    };
    struct Unit {
        size_t cell, group;
        bool again;
        WorkUnit work;
    };

    /// What the variance of a pixel is comes from its replicates.
    static SumKinds kinds_of(AovSet aovs) noexcept;
    TileSums empty_sums(const TileRect& tile) const;
    PixelSums pixel_of(const Cell& cell, uint32_t pixel) const;
    CellError cell_error(const Cell& cell, size_t group) const;
    void find_out(size_t group);
    void sample_to(size_t cell, size_t group, uint64_t samples);
    void sample_what_counts();
    void measure();
    void plan_what_is_to_come();

    const Crop window_;
    const SumKinds kinds_;
    const PictureChannels channels_;
    const double target_;
    const SampleLimits limits_;  ///< of a pixel in one group
    std::vector<Cell> cells_;    ///< row by row
    size_t columns_ = 0;
    std::vector<Unit> pass_;
    std::array<std::vector<uint64_t>, 2> wanted_;  ///< of each cell, as a group found out
    std::array<bool, 2> knows_{};                  ///< whether a group has found out
    enum class Phase { begin, finding_out, counting } phase_ = Phase::begin;
    uint64_t to_come_ = 0;
    ErrorSums error_;           ///< of the whole picture
    mutable std::mutex mutex_;  ///< guards sums and counts of cells_
};

}  // namespace steradian
