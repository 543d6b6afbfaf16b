#!/usr/bin/env bash
# A program that loads two parts, of which one uses the installed library and the other one that has the next minor version: each
# gets what it was linked to, in both orders. Of the other version there is only version(), made of the same source files.
# Arguments: the build folder, the C++ compiler.
set -euo pipefail
build=$1 compiler=$2
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"

next=$(($(version_number MINOR) + 1))
this_version=$(version_number MAJOR).$(version_number MINOR).$(version_number PATCH)
next_version=$(version_number MAJOR).$next.$(version_number PATCH)

for component in library development; do
  install_to "$build" "$work/this" --component $component
done
library=$(dirname "$(find "$work/this" -name libalhazen.so)")
mkdir -p "$work/next/lib"
cp -r "$source/include" "$work/next/include"
sed -i "s/^#define ALHAZEN_VERSION_MINOR .*/#define ALHAZEN_VERSION_MINOR $next/" "$work/next/include/alhazen/version.h"
echo "ALHAZEN_$(version_number MAJOR).$next { global: _ZN7alhazen*; local: *; };" >"$work/next/symbols.map"
"$compiler" -std=c++20 -fPIC -shared -I"$work/next/include" "$source/src/api/version.cpp" \
  -Wl,-soname,"libalhazen.so.$(version_number MAJOR).$next" -Wl,--version-script="$work/next/symbols.map" -o "$work/next/lib/libalhazen.so"
ln -s libalhazen.so "$work/next/lib/libalhazen.so.$(version_number MAJOR).$next"

cat >"$work/this.cpp" <<'TEXT'
#include <alhazen/scene.h>
#include <alhazen/alhazen.h>
extern "C" const char* version_of_this() {
  try {
    alhazen::Scene::load("/missing.pbrt");
  } catch (const alhazen::InputError&) {
    return alhazen::version();
  }
  return "no error";
}
TEXT
cat >"$work/next.cpp" <<'TEXT'
#include <alhazen/alhazen.h>
extern "C" const char* version_of_next() { return alhazen::version(); }
TEXT
cat >"$work/main.cpp" <<'TEXT'
#include <cstdio>
extern "C" const char* version_of_this();
extern "C" const char* version_of_next();
int main() { std::printf("%s %s\n", version_of_this(), version_of_next()); }
TEXT
part() {
  "$compiler" -std=c++20 -fPIC -shared -I"$work/$1/include" "$work/$1.cpp" -L"$2" -lalhazen -Wl,-rpath,"$2" -o "$work/libpart_$1.so"
}
part this "$library"
part next "$work/next/lib"
for order in "this next" "next this"; do
  read -r first second <<<"$order"
  "$compiler" "$work/main.cpp" -L"$work" "-lpart_$first" "-lpart_$second" -Wl,-rpath,"$work" -o "$work/program"
  versions=$("$work/program")
  [[ $versions == "$this_version $next_version" ]] || fail "with $first first, the versions are '$versions', not '$this_version $next_version'"
done
echo "versions $versions in one program"
