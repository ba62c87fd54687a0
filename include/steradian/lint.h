// Mistakes in scenes that can be rendered nevertheless: what a renderer accepts and its user hardly means.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "steradian/load.h"
#include "steradian/result.h"
#include "steradian/scene.h"
#include "steradian/settings.h"

namespace steradian {

enum class Severity : uint8_t {
    note,     ///< good to know: the picture is as it was asked for
    warning,  ///< the picture is probably not what was meant
};

struct LintRule {
    std::string_view name;  ///< such as "open-glass"; stays as it is from version to version
    Severity severity{};
    std::string_view summary;  ///< what it finds, one line
};

/// All rules, in the order of docs/lint.md.
std::span<const LintRule> lint_rules() noexcept;

/// One mistake.
struct Finding {
    std::string_view rule;
    Severity severity{};
    std::string message;             ///< one line: what is wrong, with the names of what it is about
    std::string hint;                ///< what to do; may be empty
    std::optional<Element> element;  ///< what it is about; nothing: the scene as a whole, or what a reader says
    SourceLocation where;            ///< where that stands, as far as it is known

    /// "scene.json:12:5: warning: glass 'vase' … [open-glass]", without the hint.
    std::string str() const;
};

struct LintOptions {
    std::vector<std::string> disabled;  ///< names of rules; unknown ones are a usage error
    uint32_t max_per_rule = 10;         ///< findings of a rule that are kept; 0: all
};

struct LintReport {
    /// By place where they have one: the order of files, then of lines, bytes or elements. The same for the same scene.
    std::vector<Finding> findings;
    /// Of rules with more findings than were kept, in the order of lint_rules().
    struct More {
        std::string_view rule;
        Severity severity{};
        uint64_t count = 0;
    };
    std::vector<More> more;

    /// Of this severity, those that were not kept included.
    uint64_t count(Severity severity) const noexcept;
};

/// Looks at a scene that need not have been checked. Fails with bad_input where prepare would (an id that refers to
/// nothing, a number out of its range), with usage for unknown rules. Takes time in proportion to the scene's triangles
/// and texels, up to a logarithm, and about 60 bytes for each triangle of the largest mesh.
Result<LintReport> lint(const Scene& scene, const RenderSettings& settings, const LintOptions& options = {});

/// The same, with places, and with what the reader of the file had to say. Load with LoadOptions::locations.
Result<LintReport> lint(const LoadedScene& loaded, const LintOptions& options = {});

}  // namespace steradian
