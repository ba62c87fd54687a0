// One kernel over trees from several builders: what a tree is worth apart from the kernel that traverses it.
#pragma once

#include <memory>
#include <optional>

#include "accel/binary_tree.h"
#include "options.h"
#include "report.h"

namespace steradian::bench {

/// A tree with the primitives that its leaves are ranges of. A triangle may be in several leaves.
struct BinaryTree {
    std::unique_ptr<BinaryPool> nodes;
    uint32_t root = 0;
    LargeArray<BuildPrimitive> primitives;
};

/// Over the triangles of a mesh by Embree's builder for trees of one's own (rtcBuildBVH), of medium or, with spatial
/// splits, of high quality. Throws std::runtime_error when Embree refuses.
BinaryTree embree_tree(const BenchMesh& mesh, bool high);

/// Our builders' trees and Embree's, all of them gathered into our wide nodes and traversed by our kernel.
std::optional<Error> measure_trees(const BenchMesh& mesh, const Options& options, Report& report);

}  // namespace steradian::bench
