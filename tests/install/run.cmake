# SPDX-License-Identifier: BSD-3-Clause
# Installs the build tree BUILD_DIR under WORK_DIR, then configures, builds and runs the consumer project there, with the
# code that the documents show, and the example projects.
# cmake -D BUILD_DIR=... -D WORK_DIR=... -D GENERATOR=... -D CXX=... -P run.cmake
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# first_code(DOCUMENT FILE): writes the first C++ block of a document.
function(first_code document file)
  file(READ ${document} text)
  string(FIND "${text}" "```cpp\n" begin)
  math(EXPR begin "${begin} + 7")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "```" length)
  string(SUBSTRING "${text}" 0 ${length} text)
  file(WRITE ${file} "${text}")
endfunction()

set(source ${CMAKE_CURRENT_LIST_DIR}/../..)
file(REMOVE_RECURSE ${WORK_DIR})
first_code(${source}/README.md ${WORK_DIR}/code_of_readme.cpp)
first_code(${source}/docs/integration.md ${WORK_DIR}/code_of_integration.cpp)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug
  -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix
  -DCODE_OF_DOCUMENTS=${WORK_DIR})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/core_user)
file(GLOB_RECURSE pc ${WORK_DIR}/prefix/lidar_obstacles.pc)
cmake_path(GET pc PARENT_PATH pc_dir)
set(ENV{PKG_CONFIG_PATH} ${pc_dir})
execute_process(COMMAND pkg-config --static --cflags --libs lidar_obstacles OUTPUT_VARIABLE flags
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(${CXX} -std=c++17 ${CMAKE_CURRENT_LIST_DIR}/core_user.cpp ${flags} -o ${WORK_DIR}/with_pkg_config)
run(${WORK_DIR}/build/evaluation_user)
run(${WORK_DIR}/build/mrpt_user)
run(${WORK_DIR}/build/live_user)
if(EXISTS ${WORK_DIR}/prefix/bin/obstacle-replay)
  run(${WORK_DIR}/prefix/bin/obstacle-replay --version)
  run(${WORK_DIR}/prefix/bin/obstacle-live --version)
endif()

foreach(example minimal own_grid odometry two_lidars rawlog_test)
  run(${CMAKE_COMMAND} -S ${source}/examples/${example} -B ${WORK_DIR}/examples/${example} -G ${GENERATOR}
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/examples/${example})
endforeach()
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK_DIR}/examples/rawlog_test --output-on-failure --no-tests=error)
set(FOLDER ${WORK_DIR}/examples)
find_program(SIMULATE obstacle-simulate PATHS ${WORK_DIR}/prefix/bin NO_DEFAULT_PATH)
include(${CMAKE_CURRENT_LIST_DIR}/examples.cmake)
