#!/usr/bin/env bash
# Installs Alhazen to a folder of its own and removes, exchanges and damages its modules: the program still runs,
# and `alhazen devices` says what is wrong with each. Argument: the build folder.
set -euo pipefail
build=$1
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"

install_to "$build" "$work/prefix"
alhazen=$work/prefix/bin/alhazen
scene=$work/prefix/share/alhazen/scenes/cornell.pbrt
library=$(find "$work/prefix" -name 'libalhazen.so*' | head -1)
modules=$(dirname "$library")/alhazen

# Prints what `alhazen devices` says of the backend embree.
devices() { "$alhazen" devices >"$work/devices.txt" && sed -n '/^embree/,/^cuda/p' "$work/devices.txt"; }

# Expects that the program renders, that `devices` prints the given words about embree, and that a render with embree
# fails with them and exit code 2.
expect_without_embree() {
  "$alhazen" render "$scene" --backend serial --spp 1 --size 8x8 -q -o "$work/without.png" || fail "$1: the program does not run"
  devices | grep -q '^embree *not available' || { cat "$work/devices.txt"; fail "$1: embree is listed as available"; }
  devices | grep -q "$2" || { cat "$work/devices.txt"; fail "$1: 'devices' does not say '$2'"; }
  local status=0
  "$alhazen" render "$scene" --backend embree --spp 1 --size 8x8 -q -o "$work/never.png" 2>"$work/error.txt" || status=$?
  [[ $status == 2 && ! -e $work/never.png ]] || fail "$1: a render by embree ended with $status, not 2"
  grep -q "$2" "$work/error.txt" || { cat "$work/error.txt"; fail "$1: the error does not say '$2'"; }
  [[ $(wc -l <"$work/error.txt") == 1 ]] || { cat "$work/error.txt"; fail "$1: the error is not one line"; }
}

if [[ ! -e $modules/libalhazen_embree.so ]]; then
  expect_without_embree "not built" "libalhazen_embree.so is not in $modules: install libembree-dev and build the target"
  mkdir -p "$modules"
  echo "no module" >"$modules/libalhazen_embree.so"
  expect_without_embree "damaged" "libalhazen_embree.so is damaged"
  exit 0
fi

module=$modules/libalhazen_embree.so
readelf -d "$alhazen" "$library" | grep -E 'NEEDED.*(embree|cuda|nvoptix)' && fail "the program needs a library of its modules"
devices | grep -q "^ *module *$module" || { cat "$work/devices.txt"; fail "'devices' does not name the module"; }
"$alhazen" render "$scene" --backend embree --spp 1 --size 8x8 -q -o "$work/embree.png" || fail "embree does not render"

mv "$module" "$work/whole.so"
expect_without_embree "taken away" "libalhazen_embree.so is not in $modules: install libembree-dev and build the target"
mkdir "$work/elsewhere"
cp "$work/whole.so" "$work/elsewhere/libalhazen_embree.so"
ALHAZEN_MODULES=$work/elsewhere "$alhazen" render "$scene" --backend embree --spp 1 --size 8x8 -q -o "$work/elsewhere.png" ||
  fail "ALHAZEN_MODULES is not looked at"

# Changes bytes of the file without changing its size.
version=$("$alhazen" --version | sed -n 1p | grep -oE '[0-9]+\.[0-9]+\.[0-9]+')
LC_ALL=C sed "s/\(Alhazen module.\{2\}embree.\{26\}\)$version/\17${version:1}/" "$work/whole.so" >"$module"
expect_without_embree "of another version" "was built from other sources than this program (version 7${version:1}, interface"
needed=$(readelf -d "$work/whole.so" | grep -oE 'libembree[0-9]+\.so\.[0-9]+')
absent=${needed/libembree/libmissing}
LC_ALL=C sed "s/$needed/${absent:0:${#needed}}/" "$work/whole.so" >"$module"
expect_without_embree "without its library" "needs the library ${absent:0:${#needed}}, which is not on this machine"
head -c $(($(stat -c %s "$work/whole.so") / 2)) "$work/whole.so" >"$module"
expect_without_embree "cut in half" "libalhazen_embree.so is damaged"
