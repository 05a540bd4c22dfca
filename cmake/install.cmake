# SPDX-License-Identifier: Apache-2.0
# cmake --install: the library, its headers and a package for find_package(bqhost). The library has no dependency,
# so the exported targets are the whole package configuration.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(bqhost_package ${CMAKE_INSTALL_LIBDIR}/cmake/bqhost)
install(TARGETS bqhost EXPORT bqhost ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/bqhost DESTINATION include)
install(EXPORT bqhost NAMESPACE bqhost:: FILE bqhost-config.cmake DESTINATION ${bqhost_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/bqhost-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bqhost-config-version.cmake DESTINATION ${bqhost_package})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
