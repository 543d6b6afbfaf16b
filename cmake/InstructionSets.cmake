# The instruction sets that sample kernels are compiled for, each in a namespace of its name (core/math/platform.h).

# ALHAZEN_KERNEL_SETS is their list. Only the kernels and what knows the modules' interface depend on it
# (render/sample_kernel.h, cmake/InterfaceHash.cmake).

# Asks the processor as the program does.
function(alhazen_find_native_set)
  if(ALHAZEN_NATIVE_SET)
    return()
  endif()
  set(source ${PROJECT_BINARY_DIR}/native_set.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
#include <cstdio>
int main() {
  __builtin_cpu_init();
  std::puts(__builtin_cpu_supports("x86-64-v4") ? "avx512" : __builtin_cpu_supports("x86-64-v3") ? "avx2" : "baseline");
}
]])
  try_run(exit_code is_compiled ${PROJECT_BINARY_DIR}/native_set ${source} RUN_OUTPUT_VARIABLE native)
  if(NOT is_compiled OR NOT exit_code EQUAL 0)
    message(FATAL_ERROR "ALHAZEN_INSTRUCTION_SETS=native: the program that asks the processor does not run")
  endif()
  string(STRIP "${native}" native)
  set(ALHAZEN_NATIVE_SET ${native} CACHE INTERNAL "The best instruction set of this machine")
  message(STATUS "The best instruction set of this machine is ${native}")
endfunction()

set(ALHAZEN_KERNEL_SETS ${ALHAZEN_INSTRUCTION_SETS})
if(ALHAZEN_BASELINE_ONLY OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(ALHAZEN_KERNEL_SETS baseline)
endif()
if("native" IN_LIST ALHAZEN_KERNEL_SETS)
  alhazen_find_native_set()
  list(TRANSFORM ALHAZEN_KERNEL_SETS REPLACE "^native$" "${ALHAZEN_NATIVE_SET}")
endif()
if("all" IN_LIST ALHAZEN_KERNEL_SETS)
  set(ALHAZEN_KERNEL_SETS baseline avx2 avx512)
endif()
list(REMOVE_DUPLICATES ALHAZEN_KERNEL_SETS)
foreach(set IN LISTS ALHAZEN_KERNEL_SETS)
  if(NOT set MATCHES "^(baseline|avx2|avx512)$")
    message(FATAL_ERROR "ALHAZEN_INSTRUCTION_SETS: '${set}' is none of all, native, baseline, avx2 and avx512")
  endif()
endforeach()
if(NOT ALHAZEN_KERNEL_SETS)
  message(FATAL_ERROR "ALHAZEN_INSTRUCTION_SETS is empty: it may be all, native, or some of baseline, avx2 and avx512")
endif()
set(ALHAZEN_FLAGS_avx2 -march=x86-64-v3)
set(ALHAZEN_FLAGS_avx512 -march=x86-64-v4 -mprefer-vector-width=512)

# GCC vectorises a loop only after it has turned its branches into selections. Where many branches join, a value has one
# candidate per branch; by default GCC gives up above four. Loops that shade many paths at once have more.
set(ALHAZEN_LOOP_OPTIONS)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(ALHAZEN_LOOP_OPTIONS "SHELL:--param max-tree-if-conversion-phi-args=16")
  # A load by a wide register waits until the narrower stores that have just written its source have reached the cache.
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag("-mmove-max=128 -mstore-max=128" ALHAZEN_HAS_MOVE_MAX)
  if(ALHAZEN_HAS_MOVE_MAX)
    list(APPEND ALHAZEN_LOOP_OPTIONS -mmove-max=128 -mstore-max=128)
  endif()
endif()

function(alhazen_compile_for target set)
  target_compile_definitions(${target} PRIVATE ALHAZEN_ISA=${set})
  target_compile_options(${target} PRIVATE ${ALHAZEN_FLAGS_${set}} ${ALHAZEN_LOOP_OPTIONS})
  target_link_libraries(${target} PRIVATE alhazen_options)
endfunction()

# The files given, once per instruction set, added to `target`; `ARGN` are what they need to be linked to besides.
function(alhazen_add_kernels target name sources)
  foreach(set IN LISTS ALHAZEN_KERNEL_SETS)
    add_library(${name}_${set} OBJECT ${sources})
    target_include_directories(${name}_${set} PRIVATE ${PROJECT_SOURCE_DIR}/src)
    alhazen_compile_for(${name}_${set} ${set})
    target_link_libraries(${name}_${set} PRIVATE ${ARGN})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${name}_${set}>)
    set_property(TARGET ${target} APPEND PROPERTY ALHAZEN_KERNELS ${name}_${set})
  endforeach()
endfunction()
