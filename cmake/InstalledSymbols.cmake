# cmake -DNM=nm -DLIBRARY=FILE -DUSERS="FILE;FILE" -DPUBLIC=SCOPE -DPRIVATE=SCOPE -DVERSION=0.1.0 -DOUTPUT=FILE
#   -P InstalledSymbols.cmake: the linker's version script of the installed library. LIBRARY exports everything; USERS are the
# programs and modules that are linked to its internals, with undefined symbols (U, w) and with copies of variables of inline
# functions and of type information (u, V), which must be one with the library's.

cmake_minimum_required(VERSION 3.25)

# Returns the names of dynamic symbols that match `pattern`, a regular expression from "NAME TYPE".
function(dynamic_symbols file pattern result)
  execute_process(COMMAND ${NM} -D -P ${file} OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "(^|\n)${pattern}" lines "${lines}")
  list(TRANSFORM lines REPLACE "^\n?([^ @]+).*$" "\\1")
  set(${result} ${lines} PARENT_SCOPE)
endfunction()

# Inline functions of the interface are defined wherever they are used, and type information is compared by name.
dynamic_symbols(${LIBRARY} "_ZN?K?${PUBLIC}[^ ]* [TDBR]" functions)
dynamic_symbols(${LIBRARY} "_ZT[ISTV]N${PUBLIC}[^ ]* [A-Z]" types)
set(public ${functions} ${types})
set(private)
foreach(file IN LISTS USERS)
  dynamic_symbols(${file} "_Z(N|NK|ZN|ZNK|T[ISTVHW]N|T[hv][^ ]*_NK?|GVN|GVZN|GVZNK)${PRIVATE}[^ ]* [UwVu]" used)
  list(APPEND private ${used})
endforeach()
if(NOT public OR (USERS AND NOT private))
  message(FATAL_ERROR "nm finds no symbols of Alhazen in ${LIBRARY} and ${USERS}")
endif()
list(SORT public)
list(SORT private)
list(REMOVE_DUPLICATES private)

string(REGEX MATCH "^[0-9]+\\.[0-9]+" soversion ${VERSION})
list(JOIN public ";\n  " public)
list(JOIN private ";\n  " private)
if(private)
  set(private "global:
  ${private};")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
"ALHAZEN_@soversion@ { global:
  @public@;
};
ALHAZEN_PRIVATE_@VERSION@ { @private@
local: *; };
")
