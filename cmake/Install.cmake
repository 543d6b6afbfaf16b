# `cmake --install` puts the program, the library, its public headers and what finds it (CMake, pkg-config) in place; modules
# are installed where they are made (Modules.cmake). No file has a path of this machine, and the whole can be moved. The
# components are the packages of Packages.cmake.

include(CMakePackageConfigHelpers)

alhazen_installed_library()
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/alhazen)

if(TARGET alhazen_cli)
  install(TARGETS alhazen_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/alhazen/scenes COMPONENT program
          PATTERN __pycache__ EXCLUDE)
  include(cmake/Manuals.cmake)
endif()
if(TARGET alhazen_python)
  include(cmake/PythonInstall.cmake)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)
install(TARGETS alhazen_installed EXPORT alhazenTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY include/alhazen DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT alhazenTargets NAMESPACE alhazen:: DESTINATION ${config} COMPONENT development)
if(ALHAZEN_STATIC_LIBRARY)
  install(TARGETS alhazen_static EXPORT alhazenStaticTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT alhazenStaticTargets NAMESPACE alhazen:: DESTINATION ${config} COMPONENT development)
endif()
configure_package_config_file(cmake/alhazenConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/alhazenConfig.cmake
                              INSTALL_DESTINATION ${config} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/alhazenConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/alhazenConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/alhazenConfigVersion.cmake
        DESTINATION ${config} COMPONENT development)

# The prefix is found from where alhazen.pc is.
set(pkg_config_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
  set(pkg_config_prefix ${CMAKE_INSTALL_PREFIX})
  set(pkg_config_libdir ${CMAKE_INSTALL_LIBDIR})
else()
  cmake_path(SET up NORMALIZE ${pkg_config_folder})
  string(REGEX REPLACE "[^/]+" ".." up ${up})
  set(pkg_config_prefix "\${pcfiledir}/${up}")
  set(pkg_config_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
endif()
if(IS_ABSOLUTE ${CMAKE_INSTALL_INCLUDEDIR})
  set(pkg_config_includedir ${CMAKE_INSTALL_INCLUDEDIR})
else()
  set(pkg_config_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
endif()
set(pkg_config_private "")
if(ALHAZEN_STATIC_LIBRARY)
  set(pkg_config_private "Libs.private: ${ALHAZEN_STATIC_LINK_FLAGS}\n")
endif()
configure_file(cmake/alhazen.pc.in ${CMAKE_CURRENT_BINARY_DIR}/alhazen.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/alhazen.pc DESTINATION ${pkg_config_folder} COMPONENT development)
