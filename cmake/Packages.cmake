# Packages for Debian, one for each component: scripts/package.sh builds them in a folder of their own, with the prefix /usr.
# A package of further bindings is one more component, with its name and texts below.

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_PACKAGE_NAME alhazen)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(ALHAZEN_PACKAGE_MAINTAINER "Alhazen maintainers <alhazen@localhost>" CACHE STRING
    "Who builds packages: NAME <ADDRESS>")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${ALHAZEN_PACKAGE_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/installed)
string(TIMESTAMP changelog_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(debian_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(library_package libalhazen${ALHAZEN_SOVERSION})

function(alhazen_package component name section depends description)
  string(TOUPPER ${component} key)
  foreach(pair "FILE_NAME;DEB-DEFAULT" "PACKAGE_NAME;${name}" "PACKAGE_SECTION;${section}" "PACKAGE_DEPENDS;${depends}")
    list(POP_FRONT pair variable)
    set(CPACK_DEBIAN_${key}_${variable} "${pair}" PARENT_SCOPE)
  endforeach()
  set(CPACK_COMPONENT_${key}_DESCRIPTION "${description}" PARENT_SCOPE)
  set(packages ${packages} ${component} PARENT_SCOPE)
  # Every package has its licence and its changes.
  set(folder ${PROJECT_BINARY_DIR}/packages/${name})
  configure_file(${PROJECT_SOURCE_DIR}/packaging/debian/changelog.in ${folder}/changelog @ONLY)
  install(FILES ${PROJECT_SOURCE_DIR}/packaging/debian/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
          COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${folder}/changelog RENAME changelog.Debian DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
          COMPONENT ${component} EXCLUDE_FROM_ALL)
endfunction()

set(what "Alhazen is a path tracer. It renders pbrt-v4, glTF 2.0 and Mitsuba scenes
and models (OBJ, PLY, STL) to EXR, PNG, JPEG, HDR and PFM, with noise
targets, path guiding, denoising, motion blur and layers.")
# The first line of each description is the summary.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(packages)
# Program and modules share internals with the library of the same build.
set(same "${library_package} (= ${debian_version})")
alhazen_package(program alhazen graphics "${same}" "path tracer for pbrt, glTF and Mitsuba scenes
${what}
.
This package holds the program, its manual pages, completions for shells
and some scenes.")
alhazen_package(library ${library_package} libs "" "path tracer for pbrt, glTF and Mitsuba scenes (library)
${what}
.
This package holds the shared library.")
alhazen_package(development libalhazen-dev libdevel "${same}" "path tracer for pbrt, glTF and Mitsuba scenes (headers)
${what}
.
This package holds what programs that embed Alhazen are compiled with:
headers, and files for CMake and pkg-config.")
if(TARGET alhazen_python)
  # The extension is for one minor version of Python.
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(python "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}~)")
  string(APPEND python ", python3 (<< ${Python3_VERSION_MAJOR}.${next_minor}), python3-numpy")
  alhazen_package(python python3-alhazen python "${python}, ${same}" "path tracer for pbrt, glTF and Mitsuba scenes (Python 3)
${what}
.
This package holds the Python module, which makes scenes from NumPy arrays
or files and renders them to arrays.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
      ${PROJECT_SOURCE_DIR}/packaging/debian/python/postinst ${PROJECT_SOURCE_DIR}/packaging/debian/python/prerm)
endif()
set(recommended)
foreach(module IN ITEMS embree cuda optix)
  if(TARGET alhazen_${module})
    alhazen_package(${module} libalhazen${ALHAZEN_SOVERSION}-${module} libs "${same}"
                    "path tracer for pbrt, glTF and Mitsuba scenes (${module})
${what}
.
This package holds the module of the backend '${module}', which the library
loads where it is installed.")
    list(APPEND recommended libalhazen${ALHAZEN_SOVERSION}-${module})
  endif()
endforeach()
list(JOIN recommended ", " CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS ffmpeg)
set(CPACK_COMPONENTS_ALL ${packages})

# What programs that are linked to the library depend on, and how the system learns of it.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/packages/shlibs @ONLY CONTENT
     "libalhazen @ALHAZEN_SOVERSION@ @library_package@ (>= @PROJECT_VERSION@)\n")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/packages/triggers CONTENT "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA
    ${PROJECT_BINARY_DIR}/packages/shlibs ${PROJECT_BINARY_DIR}/packages/triggers)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/CompressDocuments.cmake)
include(CPack)
