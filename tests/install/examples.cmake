# SPDX-License-Identifier: BSD-3-Clause
# Runs the example projects that lie built in FOLDER, and looks at what they print. The recording with two lidars comes
# from SIMULATE, obstacle-simulate; where it was not built, that example only has to refuse a recording with one.
# cmake -D FOLDER=... -D SIMULATE=... -D WORK_DIR=... -P examples.cmake
set(datasets ${CMAKE_CURRENT_LIST_DIR}/../../datasets)

# example(NAME FILE... FINDS REGEX...): it ends well, and prints lines that match each.
function(example name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FINDS")
  execute_process(COMMAND ${FOLDER}/${name}/${name} ${arg_UNPARSED_ARGUMENTS} OUTPUT_VARIABLE out COMMAND_ECHO STDOUT
    COMMAND_ERROR_IS_FATAL ANY)
  foreach(regex ${arg_FINDS})
    if(NOT out MATCHES "${regex}")
      message(FATAL_ERROR "${name}: nothing matches '${regex}' in\n${out}")
    endif()
  endforeach()
endfunction()

# refuses(NAME FILE... SAYING REGEX): it ends with an error of its own.
function(refuses name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SAYING" "")
  execute_process(COMMAND ${FOLDER}/${name}/${name} ${arg_UNPARSED_ARGUMENTS} OUTPUT_QUIET ERROR_VARIABLE error
    RESULT_VARIABLE code)
  if(NOT code EQUAL 1 OR NOT error MATCHES "^${name}: .*${arg_SAYING}")
    message(FATAL_ERROR "${name} ${arg_UNPARSED_ARGUMENTS}: code ${code}, wanted 1; '${arg_SAYING}' is not in: ${error}")
  endif()
endfunction()

foreach(name minimal own_grid odometry two_lidars)
  refuses(${name} no_such.rawlog SAYING "no_such\\.rawlog")
  refuses(${name} SAYING "usage: ${name} FILE")
endforeach()

# The truck that is unloaded stands at (10.1, -3.6), as in examples/rawlog_test.
set(truck "vehicle at (9|10)\\.[0-9], -[34]\\.[0-9] m")
example(minimal ${datasets}/street_sample.rawlog FINDS "${truck}, [5-9]\\.[0-9] x 2\\.[0-9] x [23]\\.[0-9] m\n")
example(own_grid ${datasets}/street_sample.rawlog FINDS "${truck}\n")

set(moves "vehicle [0-9]+ at -?[0-9.]+, -?[0-9.]+ m: [5-9]\\.[0-9] m/s\n")
set(stands "vehicle [0-9]+ at -?[0-9.]+, -?[0-9.]+ m: 0\\.[0-9] m/s\n")
example(odometry ${datasets}/street_tracks.rawlog FINDS ${moves} ${stands})
# Poses of one's own: by these the vehicle stands, so that what stands moves.
set(poses "")
foreach(second RANGE 6 9)
  foreach(tenth RANGE 9)
    string(APPEND poses "160945920${second}.${tenth} 0 0 0\n")
  endforeach()
endforeach()
file(WRITE ${WORK_DIR}/poses.txt "${poses}")
example(odometry ${datasets}/street_tracks.rawlog ${WORK_DIR}/poses.txt FINDS ${moves})
refuses(odometry ${datasets}/street_tracks.rawlog ${CMAKE_CURRENT_LIST_FILE} SAYING "lines of time x y yaw")
refuses(odometry ${datasets}/street_tracks.rawlog no_such.txt SAYING "no_such\\.txt")

refuses(two_lidars ${datasets}/street_sample.rawlog SAYING "no two lidars have scans of the same time")
if(SIMULATE)
  execute_process(COMMAND ${SIMULATE} ${datasets}/scenarios/delivery-two.yaml --to 0.5 --output ${WORK_DIR}/two
    COMMAND_ERROR_IS_FATAL ANY)
  example(two_lidars ${WORK_DIR}/two.rawlog
    FINDS "vehicle at [^\n]*lidar 0\n" "vehicle at [^\n]*lidar 1\n" "pedestrian at [^\n]*\n")
endif()
