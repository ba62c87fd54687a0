// Refusing what would not fit, before the work.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/parallel.h"
#include "render/adaptive_film.h"
#include "steradian/render.h"

namespace steradian {

inline Crop window_of(const RenderSettings& s) { return s.crop.value_or(Crop{0, 0, s.width, s.height}); }

/// Pixels of the largest unit of work, once the window has cut it.
inline uint32_t largest_tile(const RenderSettings& s, const Execution& e) {
    const Crop window = window_of(s);
    const uint32_t tile = std::min(e.tile_size, window.x1 - window.x0) * std::min(e.tile_size, window.y1 - window.y0);
    return s.target_error > 0 ? std::max(tile, AdaptiveFilm::kCellSize * AdaptiveFilm::kCellSize) : tile;
}

inline uint32_t workers_of(const Execution& e) { return e.threads ? e.threads : hardware_threads(); }

/// What the arrays of a mesh hold.
uint64_t mesh_bytes(const Mesh& mesh);

/// Of valid settings: the sums, the picture that is made of them and what the threads work in.
uint64_t picture_bytes(const RenderSettings& settings, const Execution& execution);

/// `resources` when there is less memory than that. Needs no scene, so that none is loaded for nothing.
Status check_picture_memory(const RenderSettings& settings, const Execution& execution);

/// `resources` when there is less memory than what comes on top of the scene, which is there already.
Status check_scene_memory(const MemoryEstimate& estimate);

}  // namespace steradian
