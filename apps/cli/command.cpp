#include "command.h"

#include <iostream>

namespace steradian::cli {

int exit_code(ErrorCode code) {
    switch (code) {
        case ErrorCode::render_failed:
            return kRenderFailed;
        case ErrorCode::usage:
            return kUsage;
        case ErrorCode::bad_input:
            return kBadInput;
        case ErrorCode::resources:
            return kResources;
    }
    return kRenderFailed;
}

int report(const Error& error) {
    std::cerr << error.str() << std::endl;
    return exit_code(error.code);
}

void report(const Diagnostics& diagnostics) {
    for (const Warning& warning : diagnostics.warnings()) std::cerr << warning.str() << '\n';
    std::cerr.flush();
}

}  // namespace steradian::cli
