// Ends what begin_sse4.inl, begin_avx2.inl and begin_avx512.inl begin.

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
