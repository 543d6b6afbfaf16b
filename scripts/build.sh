#!/usr/bin/env bash
# Builds the release preset in build/release, with ccache where it is installed. Arguments: the targets (default: all).
# An existing configuration is kept, so that only what changed is built again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ ! -f build/release/build.ninja ]]; then
  launcher=()
  if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  cmake --preset release "${launcher[@]}"
fi
cmake --build --preset release ${1:+--target "$@"}
