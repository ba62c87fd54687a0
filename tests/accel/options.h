// What tests of all kinds of hierarchies and kernels go through.
#pragma once

#include <string>
#include <vector>

#include "accel/accel.h"
#include "accel/kernels/kernels.h"
#include "base/names.h"

namespace steradian::test {

/// Every builder with every kernel that the machine has, in the full layout; the compact layout by SAH with every
/// kernel and by each other builder with one of them.
inline std::vector<AccelOptions> all_options() {
    std::vector<AccelOptions> all;
    const std::vector<Isa> isas = supported_isas();
    for (uint8_t builder = 0; builder < names_of<BvhBuilder>().size(); ++builder)
        for (size_t i = 0; i < isas.size(); ++i)
            for (const BvhLayout layout : {BvhLayout::full, BvhLayout::compact}) {
                AccelOptions options;
                options.builder = static_cast<BvhBuilder>(builder);
                options.isa = isas[i];
                options.layout = layout;
                if (layout == BvhLayout::full || options.builder == BvhBuilder::sah || i == builder % isas.size())
                    all.push_back(options);
            }
    return all;
}

inline std::string describe(const AccelOptions& o) {
    return std::string(name_of(o.builder)) + ", " + std::string(name_of(o.isa)) + ", max depth " +
           std::to_string(o.max_depth) + ", " + std::string(name_of(o.layout)) +
           (o.open == OpenInstances::always ? ", opened" : "");
}

}  // namespace steradian::test
