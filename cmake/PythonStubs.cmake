# The type stubs of the Python module, which is asked for them when it is linked: they cannot be out of date.

if(ALHAZEN_SANITIZE)
  # An interpreter does not load a module of AddressSanitizer without more.
  return()
endif()
set(folder ${PROJECT_BINARY_DIR}/python)
set(ALHAZEN_PYTHON_STUBS ${folder}/alhazen/_alhazen.pyi ${folder}/alhazen/__init__.pyi)
file(GLOB scripts CONFIGURE_DEPENDS python/alhazen/*.py)
add_custom_command(OUTPUT ${ALHAZEN_PYTHON_STUBS}
  COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/scripts/write-stubs.py ${folder}
  DEPENDS alhazen_python ${scripts} ${PROJECT_SOURCE_DIR}/scripts/write-stubs.py
  VERBATIM COMMENT "Writing the type stubs of the Python module")
add_custom_target(alhazen_python_stubs ALL DEPENDS ${ALHAZEN_PYTHON_STUBS})
