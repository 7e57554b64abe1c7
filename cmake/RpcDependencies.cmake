# Everything outside this project, and what to do when it is missing. Also installed, for rpcConfig.cmake.
include_guard()
include(${CMAKE_CURRENT_LIST_DIR}/RpcTrilinos.cmake)

# rpc_require(<what> <Debian package> <variable> ...): stops unless all the variables hold a true value
function(rpc_require what package)
  foreach(variable IN LISTS ARGN)
    if(NOT ${variable})
      message(FATAL_ERROR "${what} was not found. On Debian: bash cmake/install_packages.sh (or apt-get install ${package}).")
    endif()
  endforeach()
endfunction()

find_package(nlohmann_json 3.9 QUIET)
rpc_require("nlohmann_json 3.9 or newer" nlohmann-json3-dev nlohmann_json_FOUND)

find_package(PkgConfig QUIET)
rpc_require("pkg-config" pkgconf PKG_CONFIG_FOUND)
pkg_check_modules(muparser QUIET IMPORTED_TARGET GLOBAL muparser)
rpc_require("muParser" libmuparser-dev muparser_FOUND)

find_path(EXODUS_INCLUDE_DIR exodusII.h)
find_library(EXODUS_LIBRARY NAMES exoIIv2c exodus)
rpc_require("The Exodus library" libexodusii-dev EXODUS_INCLUDE_DIR EXODUS_LIBRARY)
mark_as_advanced(EXODUS_INCLUDE_DIR EXODUS_LIBRARY)
if(NOT TARGET rpc_exodus)
  add_library(rpc_exodus INTERFACE IMPORTED GLOBAL)
  add_library(rpc::exodus ALIAS rpc_exodus)
  rpc_system_include(rpc_exodus ${EXODUS_INCLUDE_DIR})
  target_link_libraries(rpc_exodus INTERFACE ${EXODUS_LIBRARY})
endif()
