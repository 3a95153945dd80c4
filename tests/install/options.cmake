# SPDX-License-Identifier: BSD-3-Clause
# Configures the project in WORK_DIR: BUILD_SHARED_LIBS and BUILD_TESTING count. Nothing is built.
# cmake -D SOURCE_DIR=... -D WORK_DIR=... -D CXX=... -P options.cmake
function(configure name)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/${name} -G Ninja -DCMAKE_CXX_COMPILER=${CXX}
    -DLIDAR_OBSTACLES_BUILD_APPS=OFF -DLIDAR_OBSTACLES_BUILD_EXAMPLES=OFF ${ARGN}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# expect(NAME yes|no REGEX WHAT): whether a line of the build file matches.
function(expect name wanted regex what)
  file(STRINGS ${WORK_DIR}/${name}/build.ninja lines REGEX ${regex} LIMIT_COUNT 1)
  set(found no)
  if(lines)
    set(found yes)
  endif()
  if(NOT found STREQUAL wanted)
    message(SEND_ERROR "${name}: ${what}: expected ${wanted}, is ${found}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
configure(shared -DBUILD_SHARED_LIBS=ON -DBUILD_TESTING=ON)
foreach(library core mrpt_bridge live evaluation testing)
  expect(shared yes "liblidar_obstacles_${library}\\.so\\.0" "a shared ${library} with a soname")
endforeach()
expect(shared yes "version-script=.*exported_symbols.map" "hidden symbols")
expect(shared yes "build scan_tests:" "tests with BUILD_TESTING=ON")

configure(static -DBUILD_TESTING=OFF -DLIDAR_OBSTACLES_BUILD_TESTS=ON)
expect(static no "\\.so\\.0[ :]" "shared libraries by default")
expect(static yes "liblidar_obstacles_core\\.a" "a static core by default")
expect(static no "build scan_tests:" "tests with BUILD_TESTING=OFF")
