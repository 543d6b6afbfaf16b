# One interface target carries the warnings and the code generation flags that every target of the project uses.

add_library(alhazen_options INTERFACE)

function(alhazen_cxx_options)
  foreach(option IN LISTS ARGN)
    target_compile_options(alhazen_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:${option}>)
  endforeach()
endfunction()

# No contraction of a*b+c into fused operations: the same code then gives the same bits wherever it is inlined, and the
# places where fused operations matter ask for them (core/math/scalar.h).
alhazen_cxx_options(
  -Wall -Wextra -Wshadow -Wconversion $<$<BOOL:${ALHAZEN_WERROR}>:-Werror> -Wdouble-promotion)
set(ALHAZEN_CODE_OPTIONS -fno-math-errno -fno-trapping-math -ffp-contract=off)
alhazen_cxx_options(${ALHAZEN_CODE_OPTIONS})
list(JOIN ALHAZEN_CODE_OPTIONS " " ALHAZEN_CXX_OPTIONS)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms on string concatenation (GCC bug 105651).
  alhazen_cxx_options(-Wno-restrict)
endif()
if(NOT ALHAZEN_ARCH STREQUAL "")
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-march=${ALHAZEN_ARCH}>)
endif()
if(ALHAZEN_SANITIZE STREQUAL "thread")
  # -Wno-tsan: a fence in a library's header, which this sanitizer does not know.
  alhazen_cxx_options(-fsanitize=thread -fno-omit-frame-pointer -Wno-tsan)
  target_link_options(alhazen_options INTERFACE -fsanitize=thread)
elseif(ALHAZEN_SANITIZE OR ALHAZEN_FUZZ)
  # Beyond what `undefined` holds: numbers out of an integer's range, NaN among them, and the standard library's checks
  # of indices. The libraries behind the interfaces of C have been built without.
  alhazen_cxx_options(-fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all
                      -fno-omit-frame-pointer -D_GLIBCXX_ASSERTIONS)
  target_link_options(alhazen_options INTERFACE -fsanitize=address,undefined)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # The sanitizers bring false alarms with them (GCC's manual, under -fsanitize), here on objects without members.
    alhazen_cxx_options(-Wno-maybe-uninitialized)
  endif()
endif()
if(ALHAZEN_COUNTERS)
  target_compile_definitions(alhazen_options INTERFACE ALHAZEN_COUNTERS)
endif()
if(ALHAZEN_FUZZ)
  alhazen_cxx_options(-fsanitize=fuzzer-no-link)
endif()
