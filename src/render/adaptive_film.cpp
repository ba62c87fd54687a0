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
Channels mean_of(const TileSums& sums, uint64_t samples) {
    RgbSum sum;
    for (const RgbSum& s : sums.color) sum += s;
    // Every pixel has kGroupReplicates sums, each of samples / kGroupReplicates samples.
    const double count = double(samples) * double(sums.color.size()) / kGroupReplicates;
    return {sum.r / count, sum.g / count, sum.b / count};
}

GroupSums group_of(const TileSums& sums, uint64_t samples, uint32_t pixel) {
    return {std::span(sums.color).subspan(size_t(pixel) * kGroupReplicates, kGroupReplicates),
            double(samples) / kGroupReplicates};
}

}  // namespace

SumKinds AdaptiveFilm::kinds_of(AovSet aovs) noexcept {
    SumKinds kinds(aovs);
    kinds.squares = false;
    return kinds;
}

TileSums AdaptiveFilm::empty_sums(const TileRect& tile) const {
    TileSums out(tile.pixels(), kinds_);
    out.color.resize(size_t(tile.pixels()) * kGroupReplicates);
    return out;
}

AdaptiveFilm::AdaptiveFilm(Crop window, double target, uint64_t most_samples, AovSet aovs)
    : window_(window), kinds_(kinds_of(aovs)), channels_(aovs), target_(target), limits_(limits_of(most_samples)) {
    columns_ = window.x1 > window.x0 ? (window.x1 - 1) / kCellSize - window.x0 / kCellSize + 1 : 0;
    for (uint32_t y = window.y0 / kCellSize * kCellSize; y < window.y1; y += kCellSize)
        for (uint32_t x = window.x0 / kCellSize * kCellSize; x < window.x1; x += kCellSize) {
            Cell cell;
            cell.tile = {std::max(x, window.x0), std::max(y, window.y0), std::min(x + kCellSize, window.x1),
                         std::min(y + kCellSize, window.y1)};
            for (Group& group : cell.groups) group.sums = empty_sums(cell.tile);
            cells_.push_back(std::move(cell));
        }
    for (std::vector<uint64_t>& wanted : wanted_) wanted.resize(cells_.size(), limits_.least);
}

TileSums AdaptiveFilm::sums(size_t unit) const {
    const Cell& cell = cells_[pass_[unit].cell];
    if (pass_[unit].again) return empty_sums(cell.tile);
    const std::lock_guard lock(mutex_);
    return cell.groups[pass_[unit].group].sums;
}

void AdaptiveFilm::commit(size_t unit, TileSums sums) {
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
        out.error += group_error(group_of(group.sums, group.samples, i), around);
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
            error_ += pixel_error(group_of(a.sums, a.samples, i), group_of(b.sums, b.samples, i), around);
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

/// Both groups have the same say, whatever their numbers of samples: those of the smaller one count several times, a
/// whole number, since both numbers are powers of two times the least. A group without samples, of a picture that was
/// stopped, has no say.
PixelSums AdaptiveFilm::pixel_of(const Cell& cell, uint32_t pixel) const {
    const Group &a = cell.groups[0], &b = cell.groups[1];
    const uint64_t most = std::max(a.samples, b.samples);
    const auto times = [&](const Group& g) { return static_cast<uint32_t>(g.samples > 0 ? most / g.samples : 0); };
    PixelSums out = features_of({{&a.sums, times(a)}, {&b.sums, times(b)}}, pixel);
    out.samples = cell.samples();
    out.weight = double(most) * ((a.samples > 0) + (b.samples > 0));
    for (const Group& group : cell.groups) {
        if (group.samples == 0) continue;
        const GroupSums sums = group_of(group.sums, group.samples, pixel);
        for (RgbSum sum : sums.replicates) out.color += sum *= times(group);
        // Replicates are independent, whatever the samples of each are among each other.
        const Channels v = group_variance(sums);
        RgbSum variance{v[0], v[1], v[2]};
        const double share = double(most) / out.weight;
        out.variance += variance *= share * share;
    }
    return out;
}

Image AdaptiveFilm::develop() const {
    const std::lock_guard lock(mutex_);
    Image image;
    image.width = window_.x1 - window_.x0;
    image.height = window_.y1 - window_.y0;
    channels_.describe(image);
    image.pixels.resize(size_t(image.width) * image.height * channels_.count());
    for (const Cell& cell : cells_) {
        const TileRect& t = cell.tile;
        for (uint32_t i = 0; i < t.pixels(); ++i) {
            const size_t x = t.x0 - window_.x0 + i % t.width(), y = t.y0 - window_.y0 + i / t.width();
            channels_.develop(pixel_of(cell, i), &image.pixels[(y * image.width + x) * channels_.count()]);
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
