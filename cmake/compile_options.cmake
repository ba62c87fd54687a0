# How every file of the project is compiled. The pictures are defined by IEEE arithmetic as written: no contraction into
# fused multiply-adds, no fast-math, and for the same reason no -march beyond the baseline.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_library(steradian_options INTERFACE)
target_compile_options(steradian_options INTERFACE
  -ffp-contract=off -fno-math-errno -fno-fast-math
  # GCC 12 drops the rounding to float of double -> float -> double when it vectorises straight-line code on x86, see
  # docs/decisions/0007. The kernels do not depend on the vectoriser.
  $<$<CXX_COMPILER_ID:GNU>:-fno-tree-vectorize>
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
  # GCC 12 reports the strings within aggregates that are moved, and "literal" + string.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<BOOL:${STERADIAN_WERROR}>:-Werror>)

if(STERADIAN_SANITIZE)
  string(REPLACE "," ";" sanitizers "${STERADIAN_SANITIZE}")
  foreach(sanitizer IN LISTS sanitizers)
    add_compile_options(-fsanitize=${sanitizer})
    add_link_options(-fsanitize=${sanitizer})
  endforeach()
  add_compile_options(-fno-omit-frame-pointer -fno-sanitize-recover=all)
endif()

if(STERADIAN_BUILD_FUZZ)
  # The libraries tell the fuzzer which of their branches an input reached.
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
