#!/usr/bin/env bash
# Another project that has Alhazen as a folder within (add_subdirectory, FetchContent): the library is there under the name that it
# has when it is installed, nothing of it changes the other project, and a source file of that is compiled. Only the library
# itself is not built. Arguments: the C++ compiler, and further options for CMake.
set -euo pipefail
compiler=$1
shift
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"

cp "$source/examples/render_to_memory/main.cpp" "$work/main.cpp"
cat >"$work/CMakeLists.txt" <<'TEXT'
cmake_minimum_required(VERSION 3.25)
project(consumer VERSION 7.8.9 LANGUAGES CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
macro(state result)
  set(${result})
  get_cmake_property(variables VARIABLES)
  foreach(variable IN LISTS variables)
    # What find_package leaves in the cache is of no project.
    if(variable MATCHES "^(CMAKE_(CXX|BUILD|POSITION|EXPORT|INSTALL|CUDA|SKIP)|BUILD_|PROJECT_|CPACK_)" AND
       NOT variable MATCHES "^CMAKE_(INSTALL_(DEFAULT_COMPONENT_NAME|.*DIR)|CXX_(COMPILE_FEATURES|KNOWN_FEATURES))$")
      list(APPEND ${result} "${variable}=${${variable}}")
    endif()
  endforeach()
  foreach(property COMPILE_OPTIONS COMPILE_DEFINITIONS LINK_OPTIONS INCLUDE_DIRECTORIES LINK_DIRECTORIES TESTS)
    get_directory_property(value ${property})
    list(APPEND ${result} "${property}=${value}")
  endforeach()
endmacro()
state(before)
if(FETCH)
  include(FetchContent)
  FetchContent_Declare(alhazen SOURCE_DIR ${ALHAZEN})
  FetchContent_MakeAvailable(alhazen)
else()
  add_subdirectory(${ALHAZEN} alhazen)
endif()
state(after)
if(NOT before STREQUAL after)
  foreach(value IN LISTS after)
    if(NOT value IN_LIST before)
      message(SEND_ERROR "set by Alhazen: ${value}")
    endif()
  endforeach()
  foreach(value IN LISTS before)
    if(NOT value IN_LIST after)
      message(SEND_ERROR "lost by Alhazen: ${value}")
    endif()
  endforeach()
endif()
if(NOT TARGET alhazen::alhazen)
  message(SEND_ERROR "there is no alhazen::alhazen")
endif()
get_property(targets DIRECTORY ${ALHAZEN} PROPERTY BUILDSYSTEM_TARGETS)
get_property(below DIRECTORY ${ALHAZEN}/src PROPERTY BUILDSYSTEM_TARGETS)
get_property(folders DIRECTORY ${ALHAZEN} PROPERTY SUBDIRECTORIES)
if(NOT folders STREQUAL "${ALHAZEN}/src")
  message(SEND_ERROR "Alhazen adds the folders ${folders}, not src alone")
endif()
foreach(target IN LISTS targets below)
  if(NOT target MATCHES "^alhazen(_|$)" OR target MATCHES "_cli$|_installed$|_manuals$")
    message(SEND_ERROR "Alhazen adds the target ${target}")
  endif()
endforeach()
add_executable(consumer main.cpp)
target_link_libraries(consumer PRIVATE alhazen::alhazen)
TEXT

for fetch in OFF ON; do
  cmake -S "$work" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DALHAZEN="$source" -DFETCH=$fetch "$@" \
    >"$work/cmake.log" 2>&1 || { cat "$work/cmake.log"; fail "CMake fails"; }
  ! grep -q 'CMake Warning' "$work/cmake.log" || { cat "$work/cmake.log"; fail "CMake warns"; }
  ! grep -q '^CMAKE_BUILD_TYPE:STRING=.' "$work/build/CMakeCache.txt" || fail "the type of build is set for all"
  command=$(grep -F -- '-c '"$work/main.cpp" "$work/build/compile_commands.json")
  ! grep -qE -- '-W(error|conversion|shadow)|-ffp-contract|-fno-math-errno|-fopenmp|-march|-DALHAZEN' <<<"$command" ||
    fail "options of Alhazen are those of its users: $command"
  grep -qF -- "$source/include" <<<"$command" || fail "the public headers are not found: $command"
  grep -F -- "-c $source/src/api/version.cpp" "$work/build/compile_commands.json" | grep -q -- ' -O3 ' ||
    fail "the library is not optimised where the type of build is left open"
  cmake --build "$work/build" --target CMakeFiles/consumer.dir/main.cpp.o >"$work/build.log" ||
    { cat "$work/build.log"; fail "the consumer does not compile"; }
  rm -rf "$work/build"
done
