# SPDX-License-Identifier: BSD-3-Clause
# How tests are compiled, and what ctest is told of them.

# Threads of Mesa's software renderer. LeakSanitizer takes what it notes of the thread-local memory of OpenGL's drivers, which are
# loaded while a program runs, for something else and crashes at its end: it is told to note nothing of it.
set(test_environment LP_NUM_THREADS=2)
set(only_figures "")
if(LIDAR_OBSTACLES_SANITIZE)
  # Tests that only ask for figures of whole recordings, or compare whole runs.
  string(JOIN : only_figures *Agreement* *Accuracy* *AsRoughAsReal* StaticMap.What* *FindMoreThanEither*
    *SameBytesForAnySharding* *TwoRunsAtOnce*)
  set(test_environment ASAN_OPTIONS=intercept_tls_get_addr=0)  # one variable: gtest_discover_tests takes no list of them
endif()

# Programs with threads of their own, and the tracker: the preset tsan builds and runs these. What libraries do is left out.
set(threads_tests live_library_tests live_app_test live_test live_runs_test live_clients_test live_hostile_test player_test
  sequence_test track_memory_test tracking_tests)
if(LIDAR_OBSTACLES_SANITIZE_THREADS)
  set(test_environment
    TSAN_OPTIONS=suppressions=${CMAKE_CURRENT_SOURCE_DIR}/threads.supp:log_path=${PROJECT_BINARY_DIR}/races/report)
endif()
add_custom_target(threads)

# Tests are compiled without optimisation, which halves the time it takes, and without UndefinedBehaviorSanitizer of their
# own; what they test keeps the flags of its preset. GoogleTest and the headers of what is tested are read once.
set(test_options -fPIC -O0)
if(LIDAR_OBSTACLES_SANITIZE)
  list(APPEND test_options -fno-sanitize=undefined)
endif()
file(CONFIGURE OUTPUT test_headers.cpp CONTENT "")
foreach(library core mrpt_bridge)
  set(headers lidar_obstacles_${library}_test_headers)
  add_library(${headers} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
  target_link_libraries(${headers} PRIVATE
    lidar_obstacles::${library} GTest::gmock nlohmann_json::nlohmann_json lidar_obstacles_build_flags)
  target_compile_options(${headers} PRIVATE ${test_options})
endforeach()
target_precompile_headers(lidar_obstacles_core_test_headers PRIVATE
  ${PROJECT_SOURCE_DIR}/mrpt_module/src/pch.h <gmock/gmock.h> <gtest/gtest.h> <nlohmann/json.hpp>)
target_precompile_headers(lidar_obstacles_mrpt_bridge_test_headers PRIVATE
  ${PROJECT_SOURCE_DIR}/mrpt_module/src/mrpt_bridge/pch.h <gmock/gmock.h> <gtest/gtest.h> <nlohmann/json.hpp>)

# lidar_obstacles_test(NAME LIBRARY... [FILES FILE...]): NAME.cpp, or each FILE.cpp, becomes a program, each TEST in it an
# entry of ctest; or, with LIDAR_OBSTACLES_TEST_PROGRAMS and under AddressSanitizer, the program is: with the libraries
# behind MRPT's a program takes a second to start, longer than most tests. Where CMAKE_UNITY_BUILD joins the libraries'
# files, it joins these as well, eight at a time: to load the precompiled headers and what every test makes of them takes
# longer than most files.
function(lidar_obstacles_test name)
  cmake_parse_arguments(PARSE_ARGV 1 test "" "" FILES)
  set(libraries ${test_UNPARSED_ARGUMENTS})
  if(test_FILES)
    list(TRANSFORM test_FILES APPEND .cpp)
    add_executable(${name} ${test_FILES})
    set_target_properties(${name} PROPERTIES UNITY_BUILD "${lidar_obstacles_join_files}")
  else()
    add_executable(${name} ${name}.cpp)
  endif()
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${libraries} GTest::gmock_main lidar_obstacles_build_flags)
  target_compile_options(${name} PRIVATE ${test_options})
  if("lidar_obstacles::mrpt_bridge" IN_LIST libraries)
    target_precompile_headers(${name} REUSE_FROM lidar_obstacles_mrpt_bridge_test_headers)
  else()
    target_precompile_headers(${name} REUSE_FROM lidar_obstacles_core_test_headers)
  endif()
  set(properties "")
  if(name IN_LIST threads_tests)
    list(APPEND properties LABELS threads)
    add_dependencies(threads ${name})
  endif()
  if(name MATCHES "window")  # two drawn by software at once are slow enough to miss keys
    list(APPEND properties RESOURCE_LOCK display)
  endif()
  if(LIDAR_OBSTACLES_SANITIZE OR LIDAR_OBSTACLES_TEST_PROGRAMS)
    add_test(NAME ${name} COMMAND ${name} --gtest_filter=-${only_figures})
    set_tests_properties(${name} PROPERTIES TIMEOUT 1800 ENVIRONMENT ${test_environment} ${properties})
  else()
    # The first start reads some 170 libraries from the disk: 7 s were seen, 5 s is what CMake grants.
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120
      PROPERTIES TIMEOUT 300 ENVIRONMENT ${test_environment} ${properties})
  endif()
endfunction()
