// Showing how a build and a render get on: one line that rewrites itself on a terminal, a plain line now and then
// elsewhere.
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
    /// The same before the render: how much of the hierarchy is built, so many seconds after that began.
    void show_build(double fraction, double seconds);
    /// Ends the line on a terminal.
    void finish();

private:
    void print(const std::string& line, double seconds);

    bool quiet_, terminal_;
    bool line_open_ = false;
    double next_ = 0;  ///< seconds of what is shown; for plain lines the distance grows with its length
};

}  // namespace steradian::cli
