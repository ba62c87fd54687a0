// Renders a case through the whole path, from the text of its scene to its picture, and judges the result.
//
// Zero variance: one picture, every expected mean within the tolerance (1e-5 where nothing else is said).
//
// Stochastic: pictures of 16 independent seeds (32 in the long tier) give a mean and its standard error. The samples
// per pixel are raised until the standard error is at most 0.025 % of the value, each round with fresh seeds, so that
// the stop does not depend on the error that is judged. Then the error must be within four standard errors and within
// the larger of 0.1 % and the case's own tolerance. Where low-discrepancy samples leave less than that, rounding to
// float remains: errors below 1e-6 pass, which is 16 roundings of 2^-24.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analytic/case.h"
#include "steradian/load.h"
#include "steradian/render.h"

namespace steradian::analytic {

/// A scene ready to render again and again. Failures throw std::runtime_error with the library's message.
class PreparedCase {
public:
    PreparedCase(const std::string& scene_text, const std::vector<CaseFile>& files);
    /// What a file says must not have given a warning, and all of it must be honoured.
    explicit PreparedCase(LoadedScene loaded);

    /// The settings that the scene file asks for.
    RenderSettings settings;
    /// Throws also when a sample was bad or the picture is not complete.
    RenderResult render(const RenderSettings& with) const;
    Image picture(const RenderSettings& with) const { return render(with).image; }
    Image picture(uint64_t seed, uint64_t samples) const;

private:
    std::shared_ptr<const RenderScene> scene_;
};

/// Mean and standard error of some number over pictures of independent seeds.
struct Estimate {
    double mean = 0, standard_error = 0;
};
Estimate estimate(const std::vector<double>& values);

double mean_over(const Image& image, const Expected& region, int channel);

/// What the judgement saw, for messages and for the table of results.
struct Judgement {
    std::vector<std::string> failures;
    uint64_t samples = 0;  ///< per pixel and picture
    uint32_t pictures = 0;
    double worst_error = 0;           ///< relative
    double worst_deviation = 0;       ///< in standard errors
    double worst_standard_error = 0;  ///< relative to the value
};
Judgement judge(const Case& c);
/// The same for a scene that comes from elsewhere: the case says what is expected of it.
Judgement judge(const Case& c, const PreparedCase& prepared);

inline constexpr double kRounding = 1e-6;  ///< relative error that no variance has to explain
inline constexpr double kDeviations = 4;

}  // namespace steradian::analytic
