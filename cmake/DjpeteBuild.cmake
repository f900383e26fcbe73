# How every target of this project is built: C++17, portable flags, warnings as errors.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)

include(GNUInstallDirs)

# -ffp-contract=off: the same sums on every machine, whatever it may fuse.
function(djpete_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Werror
                                           -ffp-contract=off)
endfunction()

# MRPT's and Eigen's headers take most of the compile time: they are parsed once, for all libraries that
# rest on obs. Nothing of ours is in there. Who prefers ccache (CMAKE_CXX_COMPILER_LAUNCHER) switches this
# off: ccache hashes the large parsed file for every source.
option(DJPETE_PRECOMPILED_HEADERS "Parse MRPT's and Eigen's headers once" ON)
function(djpete_make_precompiled_headers)
  if(NOT DJPETE_PRECOMPILED_HEADERS)
    return()
  endif()
  file(WRITE ${CMAKE_BINARY_DIR}/djpete_pch.cpp "// see DjpeteBuild.cmake\n")
  add_library(djpete_pch OBJECT ${CMAKE_BINARY_DIR}/djpete_pch.cpp)
  target_link_libraries(djpete_pch PRIVATE Eigen3::Eigen mrpt::obs mrpt::maps mrpt::opengl)
  djpete_compile_options(djpete_pch)
  target_precompile_headers(djpete_pch PRIVATE
    <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <string> <vector>
    <Eigen/Dense> <mrpt/config/CConfigFileMemory.h> <mrpt/config/CLoadableOptions.h>
    <mrpt/obs/CObservationGPS.h> <mrpt/obs/CObservationIMU.h> <mrpt/obs/CObservationImage.h>
    <mrpt/obs/CObservationPointCloud.h> <mrpt/obs/CObservationStereoImages.h>
    <mrpt/opengl/CSetOfObjects.h> <mrpt/poses/CPose3D.h> <mrpt/serialization/CArchive.h>)
endfunction()
function(djpete_use_precompiled_headers target)
  if(TARGET djpete_pch)
    target_precompile_headers(${target} REUSE_FROM djpete_pch)
  endif()
endfunction()

# djpete_library(room SOURCES ... PUBLIC ... PRIVATE ...): libs/<room> as target djpete::<room>.
function(djpete_library room)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(djpete_${room} ${ARG_SOURCES})
  add_library(djpete::${room} ALIAS djpete_${room})
  set_target_properties(djpete_${room} PROPERTIES EXPORT_NAME ${room})
  target_include_directories(djpete_${room} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(djpete_${room} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  target_compile_features(djpete_${room} PUBLIC cxx_std_17)
  djpete_compile_options(djpete_${room})
  djpete_use_precompiled_headers(djpete_${room})
  install(TARGETS djpete_${room} EXPORT djpete-targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/include)
    install(DIRECTORY include/djpete DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  endif()
endfunction()

# djpete_program(name SOURCES ... LINK ...): an installed executable.
function(djpete_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  djpete_compile_options(${name})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# djpete_test(room SOURCES ... LINK ...): one GoogleTest executable per room, each test in ctest.
function(djpete_test room)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(djpete_${room}_test ${ARG_SOURCES})
  target_link_libraries(djpete_${room}_test PRIVATE ${ARG_LINK} djpete_test_support
                                                    GTest::gmock GTest::gtest_main)
  djpete_compile_options(djpete_${room}_test)
  gtest_discover_tests(djpete_${room}_test TEST_PREFIX "${room}." DISCOVERY_TIMEOUT 60
    WORKING_DIRECTORY ${CMAKE_BINARY_DIR} PROPERTIES TIMEOUT 600)
endfunction()
