# The module of the OptiX backend, where CUDA and the headers of OptiX are. Sets ALHAZEN_WITH_OPTIX; without them says so and goes on.

option(ALHAZEN_FETCH_OPTIX "Fetch NVIDIA's headers of OptiX 9.0 from GitHub" OFF)

set(ALHAZEN_WITH_OPTIX OFF)
if(ALHAZEN_PROGRAM_ONLY)
  return()
endif()
if(NOT ALHAZEN_WITH_CUDA)
  message(STATUS "OptiX is off: it needs CUDA")
  return()
endif()
if(ALHAZEN_FETCH_OPTIX)
  include(FetchContent)
  FetchContent_Declare(optix_dev GIT_REPOSITORY https://github.com/NVIDIA/optix-dev.git GIT_TAG v9.0.0 GIT_SHALLOW ON)
  FetchContent_MakeAvailable(optix_dev)
  set(OptiX_ROOT ${optix_dev_SOURCE_DIR})
endif()
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
find_package(OptiX 9.0 QUIET)
if(NOT OptiX_FOUND)
  message(STATUS "OptiX is off: no headers of OptiX 9.0 were found. Set OptiX_ROOT, or ALHAZEN_FETCH_OPTIX to ON")
  return()
endif()
set(ALHAZEN_WITH_OPTIX ON)
message(STATUS "OptiX is on: headers ${OptiX_VERSION} in ${OptiX_INCLUDE_DIR}")

# Compiles a file of device programs to OptiX-IR and PTX and puts both into a C++ file as bytes.
function(alhazen_optix_programs source result)
  set(code ${CMAKE_CURRENT_BINARY_DIR}/optix_device_code.cpp)
  set(options -std=c++20 --expt-relaxed-constexpr -arch=compute_75 -Werror=all-warnings
      -I${PROJECT_SOURCE_DIR}/src -I${PROJECT_SOURCE_DIR}/include
      -isystem ${OptiX_INCLUDE_DIR})
  set(outputs)
  foreach(kind optix-ir ptx)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/programs.${kind})
    # Line numbers for profilers; PTX, the fallback, would be three times as large with them.
    set(lines $<$<STREQUAL:${kind},optix-ir>:-lineinfo>)
    add_custom_command(OUTPUT ${output}
      COMMAND ${CMAKE_CUDA_COMPILER} -${kind} ${options} ${lines} -MD -MF ${output}.d -o ${output} ${source}
      DEPENDS ${source} DEPFILE ${output}.d COMMAND_EXPAND_LISTS VERBATIM COMMENT "Compiling device programs to ${kind}")
    list(APPEND outputs ${output})
  endforeach()
  add_custom_command(OUTPUT ${code}
    COMMAND ${CMAKE_COMMAND} "-DINPUTS=${outputs}" -DOUTPUT=${code} -P ${PROJECT_SOURCE_DIR}/cmake/EmbedDeviceCode.cmake
    DEPENDS ${outputs} ${PROJECT_SOURCE_DIR}/cmake/EmbedDeviceCode.cmake VERBATIM COMMENT "Embedding device programs")
  set(${result} ${code} PARENT_SCOPE)
endfunction()
