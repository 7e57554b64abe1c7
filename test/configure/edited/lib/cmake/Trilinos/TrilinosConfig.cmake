# The Trilinos of the build with what the file ${edit} changes.
include(${trilinos}/TrilinosConfig.cmake)

# edit_header(<header> <regular expression> <replacement>): a copy of one of Trilinos' headers is found before it
macro(edit_header header old new)
  foreach(dir IN LISTS Trilinos_INCLUDE_DIRS)
    if(EXISTS ${dir}/${header})
      file(READ ${dir}/${header} text)
      string(REGEX REPLACE "${old}" "${new}" changed "${text}")
      if(changed STREQUAL text)
        message(FATAL_ERROR "${dir}/${header} has no \"${old}\"")
      endif()
      file(WRITE ${CMAKE_BINARY_DIR}/edited/${header} "${changed}")
      break()
    endif()
  endforeach()
endmacro()

file(REMOVE_RECURSE ${CMAKE_BINARY_DIR}/edited)
include(${edit})
list(PREPEND Trilinos_INCLUDE_DIRS ${CMAKE_BINARY_DIR}/edited)
