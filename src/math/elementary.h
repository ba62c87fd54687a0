// The elementary functions. The C library's differ between machines and versions, so pictures use these: only IEEE
// + - * / and sqrt on double inside, the same bits everywhere. Errors are stated in units in the last place (ulp) of
// the result type and are checked by the tests against the C library.
#pragma once

#include "math/fp_contract.h"

namespace steradian::math {

// double in, double out. Below 1 ulp unless said otherwise. Special values as in C's Annex F.
double sin(double x);  ///< NaN for |x| > 2^52, in all four
double cos(double x);
struct SinCos {
    double sin, cos;
};
SinCos sin_cos(double x);  ///< the bits of sin(x) and cos(x), for less than both
double tan(double x);      ///< below 2 ulp
double exp(double x);
double log(double x);  ///< x < 0: NaN; 0: -infinity
double log2(double x);
double pow(double x, double y);  ///< via exp and log with extra digits
double atan2(double y, double x);
double acos(double x);
double asin(double x);

// float in, float out: computed in double and rounded once, so at most one rounding away from correctly rounded.
inline float sin(float x) { return static_cast<float>(sin(static_cast<double>(x))); }
inline float cos(float x) { return static_cast<float>(cos(static_cast<double>(x))); }
inline float tan(float x) { return static_cast<float>(tan(static_cast<double>(x))); }
inline float exp(float x) { return static_cast<float>(exp(static_cast<double>(x))); }
inline float log(float x) { return static_cast<float>(log(static_cast<double>(x))); }
inline float pow(float x, float y) { return static_cast<float>(pow(static_cast<double>(x), static_cast<double>(y))); }
inline float atan2(float y, float x) {
    return static_cast<float>(atan2(static_cast<double>(y), static_cast<double>(x)));
}
inline float acos(float x) { return static_cast<float>(acos(static_cast<double>(x))); }
inline float asin(float x) { return static_cast<float>(asin(static_cast<double>(x))); }

}  // namespace steradian::math
