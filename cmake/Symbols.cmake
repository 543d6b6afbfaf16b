# What the shared library exports, by version scripts of the linker: the public interface under the version ALHAZEN_0.1, and
# internals under ALHAZEN_PRIVATE_0.1.0, which only the program and the modules of the same version are linked to. All else is
# hidden: instantiations of other libraries' templates would otherwise mix with those of the programs that load it.

set(ALHAZEN_SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(ALHAZEN_ALL_SYMBOLS ${PROJECT_BINARY_DIR}/generated/all_symbols.map)
set(ALHAZEN_INSTALLED_SYMBOLS ${PROJECT_BINARY_DIR}/generated/installed_symbols.map)

# In a build folder all internals are there, for the tests. Names are mangled: a pattern of them is a prefix, and the linker
# need not demangle all others. The public namespace is that of include/alhazen/version.h.
set(namespace v${PROJECT_VERSION_MAJOR}_${PROJECT_VERSION_MINOR})
string(LENGTH ${namespace} length)
set(ALHAZEN_PUBLIC_SCOPE 7alhazen${length}${namespace})
set(ALHAZEN_PRIVATE_SCOPE 7alhazen4impl)
function(alhazen_symbol_patterns scope result)
  # Functions and data, those of const members, type information, what local statics and thread-local data have.
  set(patterns _ZN${scope}* _ZNK${scope}* _ZT[ISTVHW]N${scope}* _ZT[hv]*N${scope}* _ZZN${scope}* _ZZNK${scope}*
      _ZGV*N${scope}* _ZGVZNK${scope}*)
  list(JOIN patterns "; " patterns)
  set(${result} "${patterns};" PARENT_SCOPE)
endfunction()
alhazen_symbol_patterns(${ALHAZEN_PUBLIC_SCOPE} public)
alhazen_symbol_patterns(${ALHAZEN_PRIVATE_SCOPE} private)
file(CONFIGURE OUTPUT ${ALHAZEN_ALL_SYMBOLS} @ONLY CONTENT
"ALHAZEN_@ALHAZEN_SOVERSION@ { global: @public@ };
ALHAZEN_PRIVATE_@PROJECT_VERSION@ { global: @private@ local: *; };
")

function(alhazen_shared_library target script)
  set_target_properties(${target} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${ALHAZEN_SOVERSION} LINK_DEPENDS ${script})
  target_link_options(${target} PRIVATE ${ALHAZEN_SHARED_LINK_OPTIONS} -Wl,--version-script=${script})
endfunction()

# The library as it is installed, from the same objects: of the internals, it exports what the program and the modules use.
function(alhazen_installed_library)
  get_property(modules GLOBAL PROPERTY ALHAZEN_MODULES)
  set(targets ${modules})
  if(TARGET alhazen_cli)
    list(APPEND targets alhazen_cli)
  endif()
  set(users)
  foreach(target IN LISTS targets)
    list(APPEND users $<TARGET_FILE:${target}>)
  endforeach()
  add_custom_command(OUTPUT ${ALHAZEN_INSTALLED_SYMBOLS}
    COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} -DLIBRARY=$<TARGET_FILE:alhazen> "-DUSERS=${users}"
            -DPUBLIC=${ALHAZEN_PUBLIC_SCOPE} -DPRIVATE=${ALHAZEN_PRIVATE_SCOPE} -DVERSION=${PROJECT_VERSION}
            -DOUTPUT=${ALHAZEN_INSTALLED_SYMBOLS} -P ${PROJECT_SOURCE_DIR}/cmake/InstalledSymbols.cmake
    DEPENDS alhazen ${targets} ${PROJECT_SOURCE_DIR}/cmake/InstalledSymbols.cmake
    VERBATIM COMMENT "Listing the symbols of the installed library")
  add_custom_target(alhazen_installed_symbols DEPENDS ${ALHAZEN_INSTALLED_SYMBOLS})

  add_library(alhazen_installed SHARED)
  alhazen_same_objects(alhazen_installed)
  add_dependencies(alhazen_installed alhazen_installed_symbols)
  set_target_properties(alhazen_installed PROPERTIES
    OUTPUT_NAME alhazen EXPORT_NAME alhazen LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/installed)
  alhazen_shared_library(alhazen_installed ${ALHAZEN_INSTALLED_SYMBOLS})
  # It knows what it needs itself: those who link to it need not find these, nor have their headers.
  get_target_property(libraries alhazen LINK_LIBRARIES)
  list(TRANSFORM libraries REPLACE "^(.+)$" "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(alhazen_installed PRIVATE ${libraries})
endfunction()

# Makes `target` of the objects of the library, but for those that match the pattern ARGN.
function(alhazen_same_objects target)
  set(objects $<TARGET_OBJECTS:alhazen>)
  if(ARGN)
    set(objects $<FILTER:${objects},EXCLUDE,${ARGN}>)
  endif()
  get_target_property(kernels alhazen ALHAZEN_KERNELS)
  foreach(kernel IN LISTS kernels)
    list(APPEND objects $<TARGET_OBJECTS:${kernel}>)
  endforeach()
  target_sources(${target} PRIVATE ${objects})
  target_include_directories(${target}
    INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} INTERFACE cxx_std_20)
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX)
endfunction()
