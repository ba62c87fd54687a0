// Findings of lint on standard output, for the commands that have some.
#pragma once

#include <iosfwd>

#include "command.h"
#include "steradian/lint.h"

namespace steradian::cli {

/// One a line, each with its hint below it; then what was not kept.
void print_findings(std::ostream& out, const LintReport& report, const std::string& indent);
/// As the members "findings", "more", "warnings" and "notes" of an object that has been begun.
void write_findings(JsonWriter& w, const LintReport& report);

}  // namespace steradian::cli
