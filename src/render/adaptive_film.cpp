#include "render/adaptive_film.h"

#include <algorithm>
#include <bit>

namespace steradian {
namespace {

/// What a group begins with. Sobol points are at their best where there is a power of two of them in every replicate.
constexpr uint64_t kFirstSamples = 8 * kGroupReplicates;

SampleLimits limits_of(uint64_t most_samples) {
    const uint64_t most = std::bit_floor(std::max<uint64_t>(most_samples / kReplicates, 2)) * kGroupReplicates;
    return {std::min(kFirstSamples, most), most};
}

/// Over all pixels of a cell.
Channels mean_of(const std::vector<RgbSum>& sums, uint64_t samples) {
    RgbSum sum;
    for (const RgbSum& s : sums) sum += s;
    // Every pixel has kGroupReplicates sums, each of samples / kGroupReplicates samples.
    const double count = double(samples) * double(sums.size()) / kGroupReplicates;
    return {sum.r / count, sum.g / count, sum.b / count};
}

GroupSums pixel_of(const std::vector<RgbSum>& sums, uint64_t samples, uint32_t pixel) {
    return {std::span(sums).subspan(size_t(pixel) * kGroupReplicates, kGroupReplicates),
            double(samples) / kGroupReplicates};
}

}  // namespace

AdaptiveFilm::AdaptiveFilm(Crop window, double target, uint64_t most_samples)
    : window_(window), target_(target), limits_(limits_of(most_samples)) {
    columns_ = window.x1 > window.x0 ? (window.x1 - 1) / kCellSize - window.x0 / kCellSize + 1 : 0;
    for (uint32_t y = window.y0 / kCellSize * kCellSize; y < window.y1; y += kCellSize)
        for (uint32_t x = window.x0 / kCellSize * kCellSize; x < window.x1; x += kCellSize) {
            Cell cell;
            cell.tile = {std::max(x, window.x0), std::max(y, window.y0), std::min(x + kCellSize, window.x1),
                         std::min(y + kCellSize, window.y1)};
            for (Group& group : cell.groups) group.sums.resize(size_t(cell.tile.pixels()) * kGroupReplicates);
            cells_.push_back(std::move(cell));
        }
    for (std::vector<uint64_t>& wanted : wanted_) wanted.resize(cells_.size(), limits_.least);
}

std::vector<RgbSum> AdaptiveFilm::sums(size_t unit) const {
    const std::lock_guard lock(mutex_);
    const std::vector<RgbSum>& sums = cells_[pass_[unit].cell].groups[pass_[unit].group].sums;
    return pass_[unit].again ? std::vector<RgbSum>(sums.size()) : sums;
}

void AdaptiveFilm::commit(size_t unit, std::vector<RgbSum> sums) {
    const std::lock_guard lock(mutex_);
    const WorkUnit& work = pass_[unit].work;
    Group& group = cells_[pass_[unit].cell].groups[pass_[unit].group];
    group.sums = std::move(sums);
    group.samples = work.first_sample + work.samples;
}

/// Up to so many; from the beginning where there are more already.
void AdaptiveFilm::sample_to(size_t cell, size_t group, uint64_t samples) {
    const uint64_t now = cells_[cell].groups[group].samples;
    if (samples == now) return;
    WorkUnit work;
    work.tile = cells_[cell].tile;
    work.first_sample = samples > now ? now : 0;
    work.samples = static_cast<uint32_t>(samples - work.first_sample);
    work.replicates = kGroupReplicates;
    work.first_replicate = static_cast<uint32_t>(group) * kGroupReplicates;
    work.all_replicates = kReplicates;
    pass_.push_back({cell, group, samples < now, work});
}

/// Nothing of the other group is looked at.
CellError AdaptiveFilm::cell_error(const Cell& cell, size_t which) const {
    const Group& group = cell.groups[which];
    CellError out;
    out.samples = group.samples;
    const Channels around = mean_of(group.sums, group.samples);
    for (uint32_t i = 0; i < cell.tile.pixels(); ++i)
        out.error += group_error(pixel_of(group.sums, group.samples, i), around);
    return out;
}

/// A group knows what a cell needs when it has had half of that itself; what has less gets twice as many as before.
void AdaptiveFilm::find_out(size_t group) {
    std::vector<CellError> errors;
    for (const Cell& cell : cells_) errors.push_back(cell_error(cell, group));
    wanted_[group] = allocate(errors, columns_, target_, limits_);
    knows_[group] = true;
    for (size_t i = 0; i < cells_.size(); ++i) {
        if (wanted_[group][i] <= 2 * errors[i].samples) continue;
        knows_[group] = false;
        sample_to(i, group, 2 * errors[i].samples);
    }
}

/// Each group as much as the other one found out.
void AdaptiveFilm::sample_what_counts() {
    for (size_t i = 0; i < cells_.size(); ++i)
        for (size_t group = 0; group < 2; ++group) sample_to(i, group, wanted_[1 - group][i]);
}

void AdaptiveFilm::measure() {
    error_ = {};
    for (const Cell& cell : cells_) {
        const Group &a = cell.groups[0], &b = cell.groups[1];
        const Channels around_a = mean_of(a.sums, a.samples), around_b = mean_of(b.sums, b.samples);
        Channels around;
        for (size_t c = 0; c < around.size(); ++c) around[c] = (around_a[c] + around_b[c]) / 2;
        for (uint32_t i = 0; i < cell.tile.pixels(); ++i)
            error_ += pixel_error(pixel_of(a.sums, a.samples, i), pixel_of(b.sums, b.samples, i), around);
    }
}

void AdaptiveFilm::plan_what_is_to_come() {
    to_come_ = 0;
    for (size_t i = 0; i < cells_.size(); ++i)
        for (size_t group = 0; group < 2; ++group) {
            const uint64_t now = cells_[i].groups[group].samples, wanted = wanted_[1 - group][i];
            to_come_ += (wanted >= now ? wanted - now : wanted) * cells_[i].tile.pixels();
        }
}

bool AdaptiveFilm::begin_pass() {
    pass_.clear();
    if (phase_ == Phase::begin) {
        phase_ = Phase::finding_out;
        for (size_t i = 0; i < cells_.size(); ++i)
            for (size_t group = 0; group < 2; ++group) sample_to(i, group, limits_.least);
    } else if (phase_ == Phase::finding_out) {
        for (size_t group = 0; group < 2; ++group)
            if (!knows_[group]) find_out(group);
        if (pass_.empty()) {
            phase_ = Phase::counting;
            sample_what_counts();
        }
    }
    plan_what_is_to_come();
    if (pass_.empty()) measure();
    return !pass_.empty();
}

ErrorReport AdaptiveFilm::report() const {
    bool limited = false;
    for (const std::vector<uint64_t>& wanted : wanted_)
        for (const uint64_t samples : wanted) limited |= samples == limits_.most;
    return judge(error_, target_, limited);
}

Image AdaptiveFilm::develop() const {
    const std::lock_guard lock(mutex_);
    Image image;
    image.width = window_.x1 - window_.x0;
    image.height = window_.y1 - window_.y0;
    image.channels = {"R", "G", "B"};
    image.pixels.resize(size_t(image.width) * image.height * 3);
    for (const Cell& cell : cells_) {
        const TileRect& t = cell.tile;
        // A group without samples, of a picture that was stopped, has no say.
        const double groups = (cell.groups[0].samples > 0) + (cell.groups[1].samples > 0);
        for (uint32_t i = 0; i < t.pixels(); ++i) {
            RgbSum mean;
            for (const Group& group : cell.groups) {
                if (group.samples == 0) continue;
                const double share = 1 / (groups * double(group.samples));
                for (size_t r = 0; r < kGroupReplicates; ++r) {
                    const RgbSum& sum = group.sums[size_t(i) * kGroupReplicates + r];
                    mean += RgbSum{sum.r * share, sum.g * share, sum.b * share};
                }
            }
            const size_t x = t.x0 - window_.x0 + i % t.width(), y = t.y0 - window_.y0 + i / t.width();
            float* pixel = &image.pixels[3 * (y * image.width + x)];
            pixel[0] = static_cast<float>(mean.r);
            pixel[1] = static_cast<float>(mean.g);
            pixel[2] = static_cast<float>(mean.b);
        }
    }
    return image;
}

AdaptiveFilm::Samples AdaptiveFilm::samples() const {
    const std::lock_guard lock(mutex_);
    Samples out{~uint64_t(0), 0, 0};
    for (const Cell& cell : cells_) {
        out.min = std::min(out.min, cell.samples());
        out.max = std::max(out.max, cell.samples());
        out.total += cell.samples() * cell.tile.pixels();
    }
    return out;
}

}  // namespace steradian
