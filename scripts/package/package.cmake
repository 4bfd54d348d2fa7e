# The libraries as others link them, installed or through add_subdirectory: targets Quadrille::model, Quadrille::golden and Quadrille::c, headers
# <quadrille/...>, the CMake package Quadrille.
#
# They hold the objects of the project's own libraries, which are compiled with the flags that the bits need (quadrille_options), and
# pass on none of these: an archive, an include directory and C++20. A public header defines no function with floating-point
# arithmetic, so that the flags of a user change no bit; public_headers.cmake refuses one that includes a header that is not here.
set(model_headers
  clocked.hpp
  drive.hpp
  port/config.hpp
  port/config_keys.h
  port/draw_state.hpp
  port/fragment_arrays.hpp
  support/lane_target.hpp
  port/performance_counters.hpp
  port/records.hpp
  port/snap.hpp
  port/stages.hpp
  untimed.hpp)
list(TRANSFORM model_headers PREPEND model/)
set(golden_headers
  analysis/error_bound.hpp
  analysis/hardware_cost.hpp
  analysis/range_proof.hpp
  explain/explain.hpp
  methods/method.hpp
  reference/exact_coverage.hpp
  reference/coverage_rows.hpp
  reference/paper_float.hpp
  reference/sample.hpp
  reference/truth.hpp
  reference/truth_lanes.hpp
  scenes/corner_quads.hpp
  scenes/mesh.hpp
  scenes/procedural_texture.hpp
  scenes/projection.hpp
  scenes/random_mesh.hpp
  scenes/random_quads.hpp
  scenes/random_state.hpp
  scenes/scenes.hpp
  scenes/stress.hpp)
list(TRANSFORM golden_headers PREPEND golden/)
set(public_headers ${model_headers} ${golden_headers})

set(package ${PROJECT_SOURCE_DIR}/scripts/package)
set(include ${PROJECT_BINARY_DIR}/include)
configure_file(${package}/version.h.in ${include}/quadrille/version.h @ONLY)
list(TRANSFORM public_headers PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE header_files)
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/public_headers.stamp
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DDESTINATION=${include}/quadrille "-DHEADERS=${public_headers}"
          -P ${package}/public_headers.cmake
  COMMAND ${CMAKE_COMMAND} -E touch ${PROJECT_BINARY_DIR}/public_headers.stamp
  DEPENDS ${header_files} ${package}/public_headers.cmake ${package}/package.cmake VERBATIM COMMENT "Public headers")
add_custom_target(quadrille_headers DEPENDS ${PROJECT_BINARY_DIR}/public_headers.stamp)

# quadrille_package(component libraries...): the archive of their objects as Quadrille::component.
function(quadrille_package component)
  set(target quadrille_package_${component})
  list(TRANSFORM ARGN REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
  add_library(${target} STATIC ${objects})
  add_library(Quadrille::${component} ALIAS ${target})
  add_dependencies(${target} quadrille_headers)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component} OUTPUT_NAME quadrille_${component} LINKER_LANGUAGE CXX
    ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${include}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()
quadrille_package(model quadrille_model quadrille_support)
quadrille_package(golden quadrille_analysis quadrille_explain quadrille_methods quadrille_reference quadrille_scenes)
target_link_libraries(quadrille_package_golden INTERFACE quadrille_package_model quadmath)

# The C interface (model/c_api) is a shared library by itself.
configure_file(${PROJECT_SOURCE_DIR}/model/c_api/quadrille.h ${include}/quadrille/quadrille.h COPYONLY)
target_include_directories(quadrille_c INTERFACE $<BUILD_INTERFACE:${include}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

if(QUADRILLE_INSTALL)
  include(CMakePackageConfigHelpers)
  set(directory ${CMAKE_INSTALL_LIBDIR}/cmake/Quadrille)
  configure_package_config_file(${package}/QuadrilleConfig.cmake.in ${PROJECT_BINARY_DIR}/QuadrilleConfig.cmake INSTALL_DESTINATION ${directory}
    PATH_VARS CMAKE_INSTALL_LIBDIR)
  # Before 1.0 a new minor version may change an interface.
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/QuadrilleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  # Optional: the program alone can be installed when nothing else was built (scripts/cosim.sh).
  install(TARGETS quadrille_package_model quadrille_package_golden quadrille_c EXPORT QuadrilleTargets ARCHIVE OPTIONAL LIBRARY OPTIONAL)
  install(DIRECTORY ${include}/quadrille DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(DIRECTORY model/examples DESTINATION share/quadrille)
  install(EXPORT QuadrilleTargets NAMESPACE Quadrille:: DESTINATION ${directory})
  install(FILES ${PROJECT_BINARY_DIR}/QuadrilleConfig.cmake ${PROJECT_BINARY_DIR}/QuadrilleConfigVersion.cmake DESTINATION ${directory})
endif()
