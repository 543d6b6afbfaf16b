# The version is that of include/alhazen/version.h. Sets ALHAZEN_HEADER_VERSION.

set(header ${CMAKE_CURRENT_LIST_DIR}/../include/alhazen/version.h)
set(ALHAZEN_HEADER_VERSION)
foreach(part MAJOR MINOR PATCH)
  file(STRINGS ${header} line REGEX "^#define ALHAZEN_VERSION_${part} [0-9]+$")
  if(NOT line MATCHES " ([0-9]+)$")
    message(FATAL_ERROR "${header} does not define ALHAZEN_VERSION_${part} as a number")
  endif()
  list(APPEND ALHAZEN_HEADER_VERSION ${CMAKE_MATCH_1})
endforeach()
list(JOIN ALHAZEN_HEADER_VERSION "." ALHAZEN_HEADER_VERSION)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
