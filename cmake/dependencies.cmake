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
