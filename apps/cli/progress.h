// Showing how a render gets on: one line that rewrites itself on a terminal, a plain line now and then elsewhere.
#pragma once

#include <string>

#include "steradian/render.h"

namespace steradian::cli {

/// "1:02:03", "2:03" or "0:07".
std::string format_duration(double seconds);
/// "1.2 k", "34.5 M": three digits and a prefix.
std::string format_quantity(double value);

class ProgressMeter {
public:
    explicit ProgressMeter(bool quiet);
    /// Call as often as you like; it decides what is worth showing.
    void show(const RenderProgress& progress);
    /// Ends the line on a terminal.
    void finish();

private:
    bool quiet_, terminal_;
    bool line_open_ = false;
    double next_plain_ = 2;  ///< seconds; the distance grows with the length of the render
};

}  // namespace steradian::cli
