#pragma once

#include "embree.h"

namespace steradian::bench {

std::unique_ptr<Tracer> make_embree_tracer(RTCSceneTy* scene, const EmbreeFeed& feed, bool any_hit, size_t chunk);

}  // namespace steradian::bench
