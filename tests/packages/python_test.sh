#!/usr/bin/env bash
# The Python module of an installed prefix, moved: PYTHONPATH suffices. Arguments: the build folder, the interpreter.
set -euo pipefail
build=$1 python=$2
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"
unset PYTHONPATH

for component in library python embree; do
  install_to "$build" "$work/first" --component $component
done
if grep -rlaF -e "$source" -e "$(realpath "$build")" -e "$work" "$work/first"; then
  fail "these files name folders of this machine"
fi
mv "$work/first" "$work/moved"
package=$(find "$work/moved" -path '*-packages/alhazen' -type d)
[[ -n $package ]] || fail "no package alhazen is installed"
version=$(cd "$work" && PYTHONPATH=$(dirname "$package") PYTHONDONTWRITEBYTECODE=1 "$python" "$source/tests/packages/use_module.py" \
  "$work/moved" "$source/scenes/cornell.pbrt")
numbers=$(sed -n 's/^#define ALHAZEN_VERSION_\(MAJOR\|MINOR\|PATCH\) //p' "$source/include/alhazen/version.h" | paste -sd.)
[[ $version == "$numbers" ]] || fail "the module has version $version, not $numbers"
for file in "$source"/python/alhazen/*.py "$build"/python/alhazen/*.pyi; do
  cmp "$file" "$package/${file##*/}" || fail "${file##*/} is not installed"
done
! "$python" -c 'import alhazen' 2>/dev/null || echo "note: another alhazen is installed for $python"

# The extension is linked to the public interface alone.
extension=("$package"/_alhazen.*.so)
! nm -D --undefined-only --with-symbol-versions "${extension[0]}" | grep -E '7alhazen4impl|ALHAZEN_PRIVATE' ||
  fail "the extension uses internals"
[[ $(nm -D --defined-only "${extension[0]}" | awk '{ print $3 }' | grep -vE '^(_init|_fini)$' | paste -sd' ') == PyInit__alhazen ]] ||
  { nm -D --defined-only "${extension[0]}" | c++filt | head; fail "the extension exports more than its entry"; }
