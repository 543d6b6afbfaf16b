# Installs the Python module: a component of its own, in the folder below the prefix where its interpreter looks for modules.
# For Debian's that of its packages with the prefix /usr, and with /usr/local that of this machine's own.

function(alhazen_python_folder result)
  set(version python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR})
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import sysconfig; print('deb_system' in sysconfig.get_scheme_names())"
                  OUTPUT_VARIABLE is_debian OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  if(NOT is_debian STREQUAL "True")
    set(folder lib/${version}/site-packages)
  elseif(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set(folder lib/python3/dist-packages)
  else()
    set(folder lib/${version}/dist-packages)
  endif()
  set(${result} ${folder} PARENT_SCOPE)
endfunction()

alhazen_python_folder(folder)
set(ALHAZEN_PYTHON_INSTALL_DIR ${folder} CACHE STRING "Where the Python package is installed, below the prefix")
set(package ${ALHAZEN_PYTHON_INSTALL_DIR}/alhazen)

# The library is that of the same prefix, or in a wheel, that within the package.
if(IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR} OR IS_ABSOLUTE ${package})
  set(library ${CMAKE_INSTALL_FULL_LIBDIR})
else()
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_LIBDIR BASE_DIRECTORY ${package} OUTPUT_VARIABLE library)
  string(PREPEND library "$ORIGIN/")
endif()
set_target_properties(alhazen_python PROPERTIES INSTALL_RPATH "$ORIGIN/lib;${library}")
install(TARGETS alhazen_python LIBRARY DESTINATION ${package} COMPONENT python)
install(DIRECTORY python/alhazen/ DESTINATION ${package} COMPONENT python
        FILES_MATCHING PATTERN *.py PATTERN py.typed PATTERN __pycache__ EXCLUDE)
install(FILES ${ALHAZEN_PYTHON_STUBS} DESTINATION ${package} COMPONENT python)
