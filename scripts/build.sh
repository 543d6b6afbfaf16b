#!/usr/bin/env bash
# Builds the release preset in build/release, with ccache where it is installed. Arguments: the targets (default: all).
# --program before them: where nothing is configured yet, the program alone is, without modules, tests and benchmarks; a build
# without it adds those later, and compiles nothing twice. Else an existing configuration is kept.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program_only=OFF
if [[ ${1:-} == --program ]]; then
  program_only=ON
  shift
fi
options=()
if [[ ! -f build/release/build.ninja ]]; then
  options=("-DALHAZEN_PROGRAM_ONLY=$program_only")
  if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
elif [[ $program_only == OFF ]] && grep -q '^ALHAZEN_PROGRAM_ONLY:BOOL=ON' build/release/CMakeCache.txt; then
  options=(-DALHAZEN_PROGRAM_ONLY=OFF)
fi
if ((${#options[@]})); then cmake --preset release "${options[@]}"; fi
cmake --build --preset release ${1:+--target "$@"}
