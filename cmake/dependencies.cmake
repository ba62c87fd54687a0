# Everything comes from the system's packages; nothing is fetched.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(OpenEXR 3 CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(fmt REQUIRED)
# Headers only. RapidJSON's own CMake package names the folder without regard to a sysroot.
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_path(RapidJSON_INCLUDE_DIRS rapidjson/rapidjson.h REQUIRED)

# Libraries without a CMake package, or with one that does not know sysroots: a target each.
function(steradian_library name header library package)
  find_path(${name}_INCLUDE_DIR ${header})
  find_library(${name}_LIBRARY ${library})
  mark_as_advanced(${name}_INCLUDE_DIR ${name}_LIBRARY)
  if(NOT ${name}_INCLUDE_DIR OR NOT ${name}_LIBRARY)
    message(FATAL_ERROR "lib${library} and its header ${header} are needed; on Debian: apt-get install ${package}")
  endif()
endfunction()
steradian_library(WebP webp/decode.h webp libwebp-dev)
steradian_library(meshoptimizer meshoptimizer.h meshoptimizer libmeshoptimizer-dev)
steradian_library(Draco draco/mesh/mesh.h draco libdraco-dev)
