# Modules: shared objects that the program loads when they are asked for (src/util/module.h).

option(ALHAZEN_PROGRAM_ONLY "The program alone: no modules, tests or benchmarks, and none of their libraries" OFF)
# Calls within a shared object are bound when it is linked: they cost what they cost in a program of one piece.
set(ALHAZEN_SHARED_LINK_OPTIONS -Wl,-Bsymbolic-functions)
set(ALHAZEN_MODULE_FOLDER ${PROJECT_BINARY_DIR}/lib/alhazen)

# The header <alhazen_interface.h>, whose hash says whether a module fits the program. Headers that no module sees, and those
# of a module alone, are left out.
function(alhazen_interface_header)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.h ${PROJECT_SOURCE_DIR}/include/*.h)
  list(FILTER headers EXCLUDE REGEX "/src/(cli|study|io|api|view)/|/backends/[a-z_]+/module/")
  list(SORT headers)
  set(folder ${PROJECT_BINARY_DIR}/generated)
  list(JOIN headers "\n" lines)
  file(CONFIGURE OUTPUT ${folder}/interface_headers.txt CONTENT "${lines}\n")
  set(built_by "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${ALHAZEN_KERNEL_SETS} ${ALHAZEN_SANITIZE} ${ALHAZEN_COUNTERS}")
  add_custom_command(OUTPUT ${folder}/alhazen_interface.h
    COMMAND ${CMAKE_COMMAND} -DHEADERS=${folder}/interface_headers.txt "-DBUILT_BY=${built_by}"
            -DOUTPUT=${folder}/alhazen_interface.h -P ${PROJECT_SOURCE_DIR}/cmake/InterfaceHash.cmake
    DEPENDS ${headers} ${folder}/interface_headers.txt ${PROJECT_SOURCE_DIR}/cmake/InterfaceHash.cmake
    VERBATIM COMMENT "Hashing the interface of modules")
  add_custom_target(alhazen_interface_header DEPENDS ${folder}/alhazen_interface.h)
  add_library(alhazen_interface INTERFACE)
  target_include_directories(alhazen_interface INTERFACE ${folder})
  target_compile_definitions(alhazen_interface INTERFACE ALHAZEN_VERSION="${PROJECT_VERSION}")
endfunction()

# The module `name` of the files given. It shares the program's library, and so all of its state.
function(alhazen_module name)
  add_library(alhazen_${name} MODULE ${ARGN})
  set_target_properties(alhazen_${name} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${ALHAZEN_MODULE_FOLDER} INSTALL_RPATH "$ORIGIN/..")
  target_include_directories(alhazen_${name} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(alhazen_${name} PRIVATE alhazen alhazen_options alhazen_interface)
  add_dependencies(alhazen_${name} alhazen_interface_header)
  target_link_options(alhazen_${name} PRIVATE ${ALHAZEN_SHARED_LINK_OPTIONS})
  if(ALHAZEN_INSTALL)
    # A build of the program alone has none to install.
    install(TARGETS alhazen_${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/alhazen COMPONENT ${name} OPTIONAL)
  endif()
  set_property(GLOBAL APPEND PROPERTY ALHAZEN_MODULES alhazen_${name})
endfunction()
