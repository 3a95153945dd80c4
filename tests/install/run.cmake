# Installs the build tree BUILD_DIR under WORK_DIR, then configures, builds and runs the consumer project there.
# cmake -D BUILD_DIR=... -D WORK_DIR=... -D GENERATOR=... -D CXX=... -P run.cmake
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug
  -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/core_user)
run(${WORK_DIR}/build/evaluation_user)
run(${WORK_DIR}/build/mrpt_user)
run(${WORK_DIR}/build/live_user)
if(EXISTS ${WORK_DIR}/prefix/bin/obstacle-replay)
  run(${WORK_DIR}/prefix/bin/obstacle-replay --version)
  run(${WORK_DIR}/prefix/bin/obstacle-live --version)
endif()
