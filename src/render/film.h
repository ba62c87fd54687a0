// The sums. Block b of a pixel is samples [64 b, 64 b + 64), whatever the total; within a block samples are added in
// order, blocks are folded in ascending order, both in double. A block that is finished early is held back. So the
// result does not depend on who computed which block when, and stays exact enough for 10⁹ samples a pixel.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include "render/aov.h"
#include "render/sums.h"
#include "steradian/image.h"
#include "steradian/settings.h"

namespace steradian {

inline constexpr uint32_t kBlockSamples = 64;

/// Pixels [x0, x1) × [y0, y1) in absolute coordinates.
struct TileRect {
    uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    uint32_t width() const { return x1 - x0; }
    uint32_t pixels() const { return (x1 - x0) * (y1 - y0); }
};

class Film {
public:
    Film(Crop window, uint32_t tile_size, AovSet aovs = {});

    /// What a tile takes besides its sums, for estimates of memory.
    static size_t tile_bytes() noexcept { return sizeof(Tile) + sizeof(TileRect); }
    size_t tiles() const noexcept { return tiles_.size(); }
    const TileRect& rect(size_t tile) const noexcept { return tiles_[tile].rect; }

    /// The sums of a tile without samples.
    TileSums empty_sums(size_t tile) const { return {tiles_[tile].rect.pixels(), kinds_}; }
    /// Hands over the sums of one block of one tile; from any thread, each block once.
    void commit(size_t tile, uint64_t block, uint32_t samples, TileSums sums);

    /// For blocks in parts, one after the other: the sums of the open block of a tile, and what they have become after
    /// `samples` more samples a pixel. A block that is full is folded.
    TileSums open_sums(size_t tile) const;
    void extend(size_t tile, uint32_t samples, TileSums sums);

    /// R, G, B means over the samples that were folded, and the AOVs; 0 where there are none. Safe while others commit.
    Image develop() const;
    struct Range {
        uint64_t min = 0, max = 0;
    };
    Range samples_per_pixel() const;

private:
    struct Block {
        uint32_t samples = 0;
        TileSums sums;
    };
    struct Tile {
        TileRect rect;
        mutable std::mutex mutex;
        uint64_t next_block = 0;
        uint64_t samples = 0;
        TileSums sums;
        std::map<uint64_t, Block> held_back;
        Block open;  ///< begun, of extend()
    };
    Crop window_;
    SumKinds kinds_;
    PictureChannels channels_;
    std::vector<Tile> tiles_;
};

}  // namespace steradian
