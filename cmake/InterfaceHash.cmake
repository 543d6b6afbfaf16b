# cmake -DHEADERS=FILE -DBUILT_BY=TEXT -DOUTPUT=FILE -P InterfaceHash.cmake: a header with the hash of what
# program and modules must have in common: the headers that HEADERS lists, one per line, and how they are compiled.

cmake_minimum_required(VERSION 3.25)
file(STRINGS ${HEADERS} headers)
set(text "${BUILT_BY}")
foreach(header IN LISTS headers)
  file(SHA256 ${header} hash)
  string(APPEND text "\n${hash}")
endforeach()
string(SHA256 hash "${text}")
string(SUBSTRING ${hash} 0 16 hash)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
     "#pragma once\n\n#define ALHAZEN_INTERFACE_HASH \"@hash@\"\n" @ONLY)
