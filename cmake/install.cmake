# `cmake --install`: the libraries, the public headers, the program, and a CMake package, so that another project says
#     find_package(steradian REQUIRED)
#     target_link_libraries(its_target PRIVATE steradian::steradian)
include(CMakePackageConfigHelpers)

set(steradian_layers base math image accel scene shading formats lint render)
set(steradian_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/steradian)

# The one target for users; inside the project it has the same name.
add_library(steradian_all INTERFACE)
add_library(steradian::steradian ALIAS steradian_all)
set_target_properties(steradian_all PROPERTIES EXPORT_NAME steradian)
target_link_libraries(steradian_all INTERFACE steradian_formats steradian_lint steradian_render)

foreach(layer IN LISTS steradian_layers)
  set_target_properties(steradian_${layer} PROPERTIES EXPORT_NAME ${layer})
  install(TARGETS steradian_${layer} EXPORT steradianTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()
install(TARGETS steradian_all EXPORT steradianTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/steradian DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.h)
if(STERADIAN_BUILD_APPS)
  set_target_properties(steradian PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  install(TARGETS steradian RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

install(EXPORT steradianTargets NAMESPACE steradian:: DESTINATION ${steradian_package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/steradianConfig.cmake.in
  ${PROJECT_BINARY_DIR}/steradianConfig.cmake INSTALL_DESTINATION ${steradian_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/steradianConfigVersion.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/steradianConfig.cmake ${PROJECT_BINARY_DIR}/steradianConfigVersion.cmake
  DESTINATION ${steradian_package_dir})
