// Included by everything that computes: the arithmetic of the project is IEEE 754 as written, nothing else.
#pragma once

#if defined(__FAST_MATH__)
#error "Steradian must be compiled without -ffast-math: its pictures are defined by IEEE arithmetic"
#endif
#if defined(__FLT_EVAL_METHOD__) && __FLT_EVAL_METHOD__ != 0
#error "Steradian needs float and double to be evaluated in their own precision"
#endif
