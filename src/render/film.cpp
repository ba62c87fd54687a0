#include "render/film.h"

#include <algorithm>

namespace steradian {
namespace {

/// Tiles lie on a grid in absolute coordinates, so a crop cuts them but does not shift them.
std::vector<TileRect> cut(Crop window, uint32_t size) {
    std::vector<TileRect> out;
    for (uint32_t ty = window.y0 / size; ty * size < window.y1; ++ty)
        for (uint32_t tx = window.x0 / size; tx * size < window.x1; ++tx)
            out.push_back({std::max(tx * size, window.x0), std::max(ty * size, window.y0),
                           std::min((tx + 1) * size, window.x1), std::min((ty + 1) * size, window.y1)});
    return out;
}

/// Of the mean of `n` samples, as if they were independent: Σ(X - mean)² / (n - 1), over n. 0 for a single one.
double variance(double sum, double squares, double n) {
    return n < 2 ? 0 : max_of(squares - sum / n * sum, 0.0) / (n - 1) / n;
}

/// `later`: of the block that is open, or nothing.
PixelSums pixel_of(const TileSums& sums, const TileSums* later, size_t i, uint64_t samples) {
    PixelSums out = later ? features_of({{&sums}, {later}}, i) : features_of({{&sums}}, i);
    out.samples = samples, out.weight = static_cast<double>(samples);
    out.color = sums.color[i];
    if (later) out.color += later->color[i];
    if (!sums.squares.empty()) {
        SquareSum squares = sums.squares[i];
        if (later) squares += later->squares[i];
        out.variance = {variance(out.color.r, squares.r, out.weight), variance(out.color.g, squares.g, out.weight),
                        variance(out.color.b, squares.b, out.weight)};
    }
    return out;
}

}  // namespace

Film::Film(Crop window, uint32_t tile_size, AovSet aovs) : window_(window), kinds_(aovs), channels_(aovs) {
    const std::vector<TileRect> rects = cut(window, tile_size);
    tiles_ = std::vector<Tile>(rects.size());
    for (size_t i = 0; i < rects.size(); ++i) {
        tiles_[i].rect = rects[i];
        tiles_[i].sums = empty_sums(i);
    }
}

void Film::commit(size_t tile_index, uint64_t block, uint32_t samples, TileSums sums) {
    Tile& tile = tiles_[tile_index];
    const std::lock_guard lock(tile.mutex);
    tile.held_back.emplace(block, Block{samples, std::move(sums)});
    for (auto next = tile.held_back.begin(); next != tile.held_back.end() && next->first == tile.next_block;
         next = tile.held_back.erase(next)) {
        tile.sums += next->second.sums;
        tile.samples += next->second.samples;
        ++tile.next_block;
    }
}

TileSums Film::open_sums(size_t tile_index) const {
    const Tile& tile = tiles_[tile_index];
    const std::lock_guard lock(tile.mutex);
    return tile.open.samples > 0 ? tile.open.sums : empty_sums(tile_index);
}

void Film::extend(size_t tile_index, uint32_t samples, TileSums sums) {
    Tile& tile = tiles_[tile_index];
    const std::lock_guard lock(tile.mutex);
    tile.open.sums = std::move(sums);
    tile.open.samples += samples;
    tile.samples += samples;
    if (tile.open.samples < kBlockSamples) return;
    tile.sums += tile.open.sums;
    tile.open = {};
    ++tile.next_block;
}

Image Film::develop() const {
    Image image;
    image.width = window_.x1 - window_.x0;
    image.height = window_.y1 - window_.y0;
    channels_.describe(image);
    image.pixels.resize(size_t(image.width) * image.height * channels_.count());
    for (const Tile& tile : tiles_) {
        const std::lock_guard lock(tile.mutex);
        const TileSums* open = tile.open.samples > 0 ? &tile.open.sums : nullptr;
        for (uint32_t i = 0; i < tile.rect.pixels(); ++i) {
            const size_t x = tile.rect.x0 - window_.x0 + i % tile.rect.width();
            const size_t y = tile.rect.y0 - window_.y0 + i / tile.rect.width();
            channels_.develop(tile.samples > 0 ? pixel_of(tile.sums, open, i, tile.samples) : PixelSums{},
                              &image.pixels[(y * image.width + x) * channels_.count()]);
        }
    }
    return image;
}

Film::Range Film::samples_per_pixel() const {
    Range range{~uint64_t(0), 0};
    for (const Tile& tile : tiles_) {
        const std::lock_guard lock(tile.mutex);
        range.min = std::min(range.min, tile.samples);
        range.max = std::max(range.max, tile.samples);
    }
    return tiles_.empty() ? Range{} : range;
}

}  // namespace steradian
