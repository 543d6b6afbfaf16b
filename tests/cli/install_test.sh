#!/usr/bin/env bash
# Installs Alhazen to a folder of its own, builds the examples against what was installed, and runs them.
# Arguments: the build folder, the C++ compiler.
set -euo pipefail
build=$1 compiler=$2
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"

install_to "$build" "$work/prefix"
"$work/prefix/bin/alhazen" --version

build_example() {
  cp -r "$source/examples/$1" "$2"
  cmake -S "$2" -B "$2/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_PREFIX_PATH="$work/prefix"
  cmake --build "$2/build"
}

build_example render_to_memory "$work/example"

scene=$work/prefix/share/alhazen/scenes/cornell.pbrt
"$work/example/build/render_to_memory" "$scene" | tee "$work/whole.txt"
grep -q '^100 x 100 pixels, complete;' "$work/whole.txt" || fail "the example did not render the whole image"
"$work/example/build/render_to_memory" "$scene" 0 | tee "$work/cancelled.txt"
grep -q '^cancelled before the first sample' "$work/cancelled.txt" || fail "the example did not cancel"
status=0
"$work/example/build/render_to_memory" "$work/missing.pbrt" 2>"$work/error.txt" || status=$?
cat "$work/error.txt"
[[ $status == 2 ]] || fail "a missing scene ended with $status, not 2"

build_example ambient_occlusion "$work/occlusion"
# A camera in front of the open side of the box.
"$work/occlusion/build/ambient_occlusion" "$scene" "$work/occlusion.pgm" 278 273 -800 278 273 0 100
[[ $(head -c 15 "$work/occlusion.pgm" | tr '\n' ' ') == "P5 480 360 255 " ]] || fail "the image of occlusion is none"
[[ $(stat -c %s "$work/occlusion.pgm") == $((15 + 480 * 360)) ]] || fail "the image of occlusion is not whole"
# Black where rays miss, white where nothing is close, and grey in corners.
shades=$(tail -c +16 "$work/occlusion.pgm" | od -An -v -tu1 -w1 | sort -n | uniq | wc -l)
((shades > 30)) || fail "the image of occlusion has only $shades shades"

build_example scene_from_arrays "$work/arrays"
"$work/arrays/build/scene_from_arrays" | tee "$work/arrays.txt"
grep -q '^160 x 90 pixels; green is' "$work/arrays.txt" || fail "the scene from arrays was not rendered"

build_example turntable "$work/turntable"
(cd "$work/turntable" && build/turntable "$scene" 2 4) | tee "$work/turntable.txt"
grep -q '^frame_001.png: not built again' "$work/turntable.txt" || fail "the second frame of the turntable was built again"
[[ $(head -c 4 "$work/turntable/frame_001.png" | tail -c 3) == PNG ]] || fail "the turntable has no frame"

build_example progressive "$work/progressive"
(cd "$work/progressive" && build/progressive "$scene") | tee "$work/progressive.txt"
grep -q '^so_far.png: complete' "$work/progressive.txt" || fail "the progressive image is not complete"
