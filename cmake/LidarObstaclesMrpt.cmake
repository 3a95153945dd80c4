# SPDX-License-Identifier: BSD-3-Clause
# Whatever the version of MRPT, its libraries are mrpt::obs, mrpt::maps and mrpt::opengl here.

# lidar_obstacles_find_mrpt(): MRPT 2 where there is one, else MRPT 3: that has a package for each library, and the
# scenes of its `opengl` are in `viz`. Sets MRPT_FOUND.
macro(lidar_obstacles_find_mrpt)
  find_package(MRPT QUIET COMPONENTS obs maps opengl)
  if(NOT MRPT_FOUND)
    set(MRPT_FOUND TRUE)
    foreach(library obs maps viz opengl)
      find_package(mrpt_${library} QUIET CONFIG)
      if(NOT mrpt_${library}_FOUND)
        set(MRPT_FOUND FALSE)
      endif()
    endforeach()
    if(MRPT_FOUND)
      foreach(library obs maps opengl)
        if(NOT TARGET mrpt::${library})
          add_library(mrpt::${library} INTERFACE IMPORTED)
          target_link_libraries(mrpt::${library} INTERFACE mrpt::mrpt_${library})
        endif()
      endforeach()
      target_link_libraries(mrpt::opengl INTERFACE mrpt::mrpt_viz)
    endif()
  endif()
endmacro()
