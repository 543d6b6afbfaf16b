# The module of the CUDA backend. Sets ALHAZEN_WITH_CUDA and enables the language; without nvcc says so and goes on.

# Within another project the language is enabled only where that asks for it.
set(default OFF)
if(PROJECT_IS_TOP_LEVEL)
  set(default AUTO)
endif()
set(ALHAZEN_CUDA ${default} CACHE STRING
    "Build the CUDA backend: ON, OFF, or AUTO: where nvcc and a GPU are, or ALHAZEN_CUDA_ARCHITECTURES is set")
set_property(CACHE ALHAZEN_CUDA PROPERTY STRINGS AUTO ON OFF)
set(ALHAZEN_CUDA_ARCHITECTURES "" CACHE STRING
    "Compute capabilities to build for (90 or 75;80;86;89;90). Empty: that of this machine's GPU, or 80 and its PTX")

set(ALHAZEN_WITH_CUDA OFF)
if(ALHAZEN_PROGRAM_ONLY)
  return()
endif()
if(NOT ALHAZEN_CUDA)
  message(STATUS "CUDA is off: ALHAZEN_CUDA is OFF")
  return()
endif()
if(ALHAZEN_COUNTERS)
  message(STATUS "CUDA is off: ALHAZEN_COUNTERS counts on CPUs")
  return()
endif()
include(CheckLanguage)
if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
  # Where the toolkit puts it without adding it to PATH.
  find_program(ALHAZEN_NVCC nvcc PATHS /usr/local/cuda/bin /opt/cuda/bin)
  mark_as_advanced(ALHAZEN_NVCC)
  if(ALHAZEN_NVCC)
    set(CMAKE_CUDA_COMPILER ${ALHAZEN_NVCC})
  endif()
endif()
check_language(CUDA)
if(NOT CMAKE_CUDA_COMPILER AND NOT ALHAZEN_CUDA STREQUAL "AUTO")
  message(WARNING "CUDA is off although ALHAZEN_CUDA is ${ALHAZEN_CUDA}: no nvcc was found")
  return()
elseif(NOT CMAKE_CUDA_COMPILER)
  message(STATUS "CUDA is off: no nvcc was found. Install the CUDA toolkit 12 or later and configure again to have it")
  return()
endif()

if(NOT ALHAZEN_CUDA_ARCHITECTURES STREQUAL "")
  set(CMAKE_CUDA_ARCHITECTURES ${ALHAZEN_CUDA_ARCHITECTURES})
else()
  execute_process(COMMAND nvidia-smi --query-gpu=compute_cap --format=csv,noheader
                  OUTPUT_VARIABLE capabilities RESULT_VARIABLE no_gpu OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(no_gpu EQUAL 0 AND capabilities MATCHES "^[0-9]+\\.[0-9]")
    string(REPLACE "." "" capabilities "${capabilities}")
    string(REGEX REPLACE "[ \n]+" ";" capabilities "${capabilities}")
    list(REMOVE_DUPLICATES capabilities)
    set(CMAKE_CUDA_ARCHITECTURES ${capabilities})
  elseif(ALHAZEN_CUDA STREQUAL "AUTO")
    message(STATUS "CUDA is off: nvcc is here, but no GPU. -DALHAZEN_CUDA=ON builds the backend all the same")
    return()
  else()
    # Each architecture takes minutes. Code for 8.0 runs on all of 8.x; later GPUs compile its PTX when the program first
    # starts there, and keep the result. Those of 7.x must be asked for.
    set(CMAKE_CUDA_ARCHITECTURES 80)
  endif()
endif()
enable_language(CUDA)
if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
  # CMake 3.25 does not know how nvcc is asked for C++20.
  set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
  set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
endif()
find_package(CUDAToolkit REQUIRED)
set(ALHAZEN_WITH_CUDA ON)
message(STATUS "CUDA is on: nvcc ${CMAKE_CUDA_COMPILER_VERSION}, architectures ${CMAKE_CUDA_ARCHITECTURES}")

# Kernels compiled by nvcc for a module: a library of objects, since the options of C++ are none of nvcc's. With line numbers
# for profilers.
function(alhazen_cuda_objects target)
  add_library(${target} OBJECT ${ARGN})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
  target_compile_options(${target} PRIVATE
    -lineinfo --expt-relaxed-constexpr -Werror=all-warnings
    -Xcompiler=-Wall,-Wextra,-fno-math-errno,-ffp-contract=off)
  target_link_libraries(${target} PRIVATE CUDA::cudart_static CUDA::nvtx3)
endfunction()
