// Whether two ways to render a scene have the same mean in every pixel.
#pragma once

#include "analytic/check.h"

namespace steradian::analytic {

/// Per pixel and channel: the means of pictures of independent seeds by both settings, by Welch's t-test. The chance of
/// a false alarm anywhere is 1 in 1000, by Šidák's correction. Both must be noisy in most pixels where they are not
/// black, so that it is a comparison of noise.
void expect_same_means(const PreparedCase& scene, const RenderSettings& a, const RenderSettings& b);
/// The same for two scenes, with pictures of one size.
void expect_same_means(const PreparedCase& scene, const RenderSettings& a, const PreparedCase& other,
                       const RenderSettings& b);

/// How many pixels and channels of the two differ by such a test.
size_t different_means(const PreparedCase& scene, const RenderSettings& a, const PreparedCase& other,
                       const RenderSettings& b);
size_t different_means(const PreparedCase& scene, const RenderSettings& a, const RenderSettings& b);

/// Light samples alone, and the directions that surfaces and media choose alone, against `both`.
void expect_strategies_agree(const PreparedCase& scene, const RenderSettings& both);
/// Russian roulette from the first bounce on against none; and that it takes place.
void expect_roulette_keeps_the_mean(const PreparedCase& scene, RenderSettings often);

}  // namespace steradian::analytic
