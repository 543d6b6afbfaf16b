# `cmake --install` puts the program, the library, its public headers and the package files in place; modules are installed
# where they are made (Modules.cmake).

include(CMakePackageConfigHelpers)

install(TARGETS alhazen_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS alhazen EXPORT alhazenTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/alhazen DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/alhazen/scenes)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT alhazenTargets NAMESPACE alhazen:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/alhazen)
configure_package_config_file(cmake/alhazenConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/alhazenConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/alhazen)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/alhazenConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/alhazenConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/alhazenConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/alhazen)
