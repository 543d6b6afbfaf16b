# One interface target carries the warnings and the code generation flags that every target of the project uses.

add_library(alhazen_options INTERFACE)
target_compile_options(alhazen_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Werror -Wdouble-promotion -fno-math-errno -fno-trapping-math -ffp-contract=off)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms on string concatenation (GCC bug 105651).
  target_compile_options(alhazen_options INTERFACE -Wno-restrict)
endif()
if(NOT ALHAZEN_ARCH STREQUAL "")
  target_compile_options(alhazen_options INTERFACE -march=${ALHAZEN_ARCH})
endif()
if(ALHAZEN_STRICT)
  target_compile_options(alhazen_options INTERFACE -ffp-contract=off)
endif()
if(ALHAZEN_SANITIZE OR ALHAZEN_FUZZ)
  target_compile_options(alhazen_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(alhazen_options INTERFACE -fsanitize=address,undefined)
endif()
if(ALHAZEN_FUZZ)
  target_compile_options(alhazen_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
