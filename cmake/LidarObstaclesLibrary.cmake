# SPDX-License-Identifier: BSD-3-Clause
# What all libraries of the project have in common.

# lidar_obstacles_library(COMPONENT): position independent; where BUILD_SHARED_LIBS is on, with a soname and a version
# script that hides all but the project's namespace. The version of the soname rises with every release that breaks
# the binary interface.
function(lidar_obstacles_library component)
  set(target lidar_obstacles_${component})
  set(exports ${PROJECT_SOURCE_DIR}/cmake/exported_symbols.map)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component} POSITION_INDEPENDENT_CODE ON
    VERSION ${PROJECT_VERSION} SOVERSION 0
    DEFINE_SYMBOL "")  # a macro of its own would keep it from using the precompiled header of another library
  if(BUILD_SHARED_LIBS)
    target_link_options(${target} PRIVATE LINKER:--version-script=${exports} LINKER:--no-undefined)
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${exports})
  endif()
endfunction()

# lidar_obstacles_install(COMPONENT): the library, and an export of its own for find_package().
function(lidar_obstacles_install component)
  install(TARGETS lidar_obstacles_${component} EXPORT lidar_obstacles_${component}
    LIBRARY COMPONENT runtime NAMELINK_COMPONENT dev
    ARCHIVE COMPONENT dev)
  install(EXPORT lidar_obstacles_${component} NAMESPACE lidar_obstacles:: COMPONENT dev
    FILE lidar_obstacles_${component}.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lidar_obstacles)
endfunction()
