# What the Python module is built with: an interpreter that has headers and NumPy, and pybind11. Sets
# ALHAZEN_WITH_PYTHON. -DPython3_EXECUTABLE=FILE says which interpreter; otherwise it is the first of the path, or that of
# the system.

option(ALHAZEN_PYTHON "The Python module, where an interpreter with headers and NumPy and pybind11 are found"
       ${PROJECT_IS_TOP_LEVEL})

set(ALHAZEN_WITH_PYTHON OFF)
# An interpreter that is compiled without AddressSanitizer does not load a module with it.
if(NOT ALHAZEN_PYTHON OR ALHAZEN_PROGRAM_ONLY OR ALHAZEN_SANITIZE)
  return()
endif()
if(NOT DEFINED Python3_EXECUTABLE)
  # Asked before find_package, whose targets are those of the first interpreter it sees, whether that serves or not.
  find_program(ALHAZEN_PYTHON_OF_PATH python3)
  mark_as_advanced(ALHAZEN_PYTHON_OF_PATH)
  foreach(interpreter IN ITEMS ${ALHAZEN_PYTHON_OF_PATH} /usr/bin/python3)
    execute_process(COMMAND ${interpreter} -c "import numpy, os, sysconfig
open(os.path.join(sysconfig.get_path('include'), 'Python.h')).close()"
                    RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
    if(status EQUAL 0)
      set(Python3_EXECUTABLE ${interpreter})
      break()
    endif()
  endforeach()
endif()
find_package(Python3 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
set(PYBIND11_NOPYTHON ON)
find_package(pybind11 2.10 CONFIG QUIET)
if(Python3_FOUND AND pybind11_FOUND)
  set(ALHAZEN_WITH_PYTHON ON)
  message(STATUS "Python is on: ${Python3_EXECUTABLE} (${Python3_VERSION}), pybind11 ${pybind11_VERSION}")
else()
  message(STATUS "Python is off: install python3-dev, python3-numpy and pybind11-dev for the module 'alhazen', or give "
                 "-DPython3_EXECUTABLE")
endif()
