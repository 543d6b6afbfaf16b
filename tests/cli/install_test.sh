#!/usr/bin/env bash
# Installs Alhazen to a folder of its own, builds the examples against what was installed, and runs them.
# Arguments: the build folder, the C++ compiler.
set -euo pipefail
build=$1 compiler=$2
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "install_test: $1" >&2
  exit 1
}

cmake --install "$build" --prefix "$work/prefix" >"$work/install.log" || { cat "$work/install.log"; fail "cmake --install"; }
"$work/prefix/bin/alhazen" --version

cp -r "$source/examples/render_to_memory" "$work/example"
cmake -S "$work/example" -B "$work/example/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_PREFIX_PATH="$work/prefix"
cmake --build "$work/example/build"

scene=$work/prefix/share/alhazen/scenes/cornell.pbrt
"$work/example/build/render_to_memory" "$scene" | tee "$work/whole.txt"
grep -q '^100 x 100 pixels, complete;' "$work/whole.txt" || fail "the example did not render the whole image"
"$work/example/build/render_to_memory" "$scene" 0 | tee "$work/cancelled.txt"
grep -q '^100 x 100 pixels, cancelled;' "$work/cancelled.txt" || fail "the example did not cancel"
status=0
"$work/example/build/render_to_memory" "$work/missing.pbrt" 2>"$work/error.txt" || status=$?
cat "$work/error.txt"
[[ $status == 2 ]] || fail "a missing scene ended with $status, not 2"

cp -r "$source/examples/scene_from_arrays" "$work/arrays"
cmake -S "$work/arrays" -B "$work/arrays/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" -DCMAKE_PREFIX_PATH="$work/prefix"
cmake --build "$work/arrays/build"
"$work/arrays/build/scene_from_arrays" | tee "$work/arrays.txt"
grep -q '^160 x 90 pixels; green is' "$work/arrays.txt" || fail "the scene from arrays was not rendered"
