# What the Python module is built with: an interpreter that has headers and NumPy, and pybind11. Sets
# ALHAZEN_WITH_PYTHON. -DPython3_EXECUTABLE=FILE says which interpreter; otherwise it is the first of the path, or that of
# the system.

option(ALHAZEN_PYTHON "The Python module, where an interpreter with headers and NumPy and pybind11 are found"
       ${PROJECT_IS_TOP_LEVEL})

set(ALHAZEN_WITH_PYTHON OFF)
if(NOT ALHAZEN_PYTHON OR ALHAZEN_PROGRAM_ONLY)
  return()
endif()
set(parts Interpreter Development.Module NumPy)
if(NOT DEFINED Python3_EXECUTABLE)
  find_package(Python3 3.9 QUIET COMPONENTS ${parts})
  if(NOT Python3_FOUND)
    # What the search found is forgotten, or the next would not look elsewhere.
    get_cmake_property(variables CACHE_VARIABLES)
    list(FILTER variables INCLUDE REGEX "^_?_?Python3_")
    foreach(variable IN LISTS variables)
      unset(${variable} CACHE)
    endforeach()
    set(Python3_EXECUTABLE /usr/bin/python3)
  endif()
endif()
if(NOT Python3_FOUND)
  find_package(Python3 3.9 QUIET COMPONENTS ${parts})
endif()
set(PYBIND11_NOPYTHON ON)
find_package(pybind11 2.10 CONFIG QUIET)
if(Python3_FOUND AND pybind11_FOUND)
  set(ALHAZEN_WITH_PYTHON ON)
  message(STATUS "Python is on: ${Python3_EXECUTABLE} (${Python3_VERSION}), pybind11 ${pybind11_VERSION}")
else()
  message(STATUS "Python is off: install python3-dev, python3-numpy and pybind11-dev for the module 'alhazen', or give "
                 "-DPython3_EXECUTABLE")
endif()
