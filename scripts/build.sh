#!/usr/bin/env bash
# Builds the release preset in build/release, with ccache where it is installed. Arguments: the targets (default: all).
# --program before them: where nothing is configured yet, the program alone is, without modules, tests and benchmarks, and with
# sample kernels for the best instruction set of this machine alone; a build without it adds the rest later, and keeps what is
# compiled. Else an existing configuration is kept.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program_only=OFF
instruction_sets=all
if [[ ${1:-} == --program ]]; then
  program_only=ON
  instruction_sets=native
  shift
fi
options=()
if [[ ! -f build/release/build.ninja ]]; then
  options=("-DALHAZEN_PROGRAM_ONLY=$program_only" "-DALHAZEN_INSTRUCTION_SETS=$instruction_sets"
    -DALHAZEN_UNITY=ON)
  if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
elif [[ $program_only == OFF ]] && grep -q '^ALHAZEN_PROGRAM_ONLY:BOOL=ON' build/release/CMakeCache.txt; then
  options=(-DALHAZEN_PROGRAM_ONLY=OFF -DALHAZEN_INSTRUCTION_SETS=all)
fi
if ((${#options[@]})); then cmake --preset release "${options[@]}"; fi
cmake --build --preset release ${1:+--target "$@"}
