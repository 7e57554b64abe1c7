# SPDX-License-Identifier: BSD-3-Clause
# What find_package(rpc) needs of an install tree; each package and the program install themselves.
include(CMakePackageConfigHelpers)
set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/rpc)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/rpcConfig.cmake.in ${PROJECT_BINARY_DIR}/rpcConfig.cmake
                              INSTALL_DESTINATION ${destination} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/rpcConfigVersion.cmake COMPATIBILITY SameMinorVersion) # 0.x: no promise
install(EXPORT rpcTargets NAMESPACE rpc:: DESTINATION ${destination})
install(FILES ${PROJECT_BINARY_DIR}/rpcConfig.cmake ${PROJECT_BINARY_DIR}/rpcConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/RpcDependencies.cmake ${CMAKE_CURRENT_LIST_DIR}/RpcTrilinos.cmake
              ${CMAKE_CURRENT_LIST_DIR}/RpcTrilinosCheck.cmake
        DESTINATION ${destination})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/input/ DESTINATION ${CMAKE_INSTALL_DATADIR}/rpc/input
        FILES_MATCHING PATTERN *.xml PATTERN *.yaml PATTERN *.geo PATTERN *.npy PATTERN *.step)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/NOTICE ${PROJECT_SOURCE_DIR}/CITATION.cff
              ${PROJECT_SOURCE_DIR}/doc/licences.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
