# The Embree backend, where Embree is: version 4, or 3 as Debian 12 has it. Sets ALHAZEN_WITH_EMBREE.

option(ALHAZEN_EMBREE "The Embree backend, where Embree is found" ON)

set(ALHAZEN_WITH_EMBREE OFF)
if(ALHAZEN_EMBREE)
  find_package(embree 4 QUIET)
  if(NOT embree_FOUND)
    find_package(embree 3.13 QUIET)
  endif()
  set(ALHAZEN_WITH_EMBREE ${embree_FOUND})
endif()
if(ALHAZEN_WITH_EMBREE)
  message(STATUS "Embree is on: ${EMBREE_VERSION}")
else()
  message(STATUS "Embree is off: install libembree-dev for the backend 'embree'")
endif()
