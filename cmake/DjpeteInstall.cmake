# Install and export: find_package(djpete_slam) gives djpete::<room>.
include(CMakePackageConfigHelpers)
set(DJPETE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/djpete_slam)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/djpete_slam-config.cmake.in
  ${CMAKE_BINARY_DIR}/djpete_slam-config.cmake INSTALL_DESTINATION ${DJPETE_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/djpete_slam-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(EXPORT djpete-targets NAMESPACE djpete:: DESTINATION ${DJPETE_CMAKE_DIR})
install(FILES ${CMAKE_BINARY_DIR}/djpete_slam-config.cmake
              ${CMAKE_BINARY_DIR}/djpete_slam-config-version.cmake DESTINATION ${DJPETE_CMAKE_DIR})
install(DIRECTORY datasets_cfg DESTINATION ${CMAKE_INSTALL_DATADIR}/djpete-slam)
