#!/usr/bin/env bash
# An installed prefix: no file has a path of the build, it can be moved, and CMake and pkg-config find it without the development
# packages of other libraries; manual pages and completions are there. Arguments: the build folder, the C++ compiler.
set -euo pipefail
build=$1 compiler=$2
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"

install_to "$build" "$work/first"
if grep -rlaF -e "$source" -e "$(realpath "$build")" -e "$work" "$work/first"; then
  fail "these files name folders of this machine"
fi
mkdir "$work/elsewhere"
mv "$work/first" "$work/elsewhere/moved"
prefix=$work/elsewhere/moved

find "$prefix" -type f \( -name '*.so*' -o -path '*/bin/*' \) | while read -r file; do
  readelf -d "$file" | sed -n 's/.*R\(UN\)\?PATH.*\[\(.*\)\]/\2/p' | tr : '\n' | while read -r folder; do
    [[ $folder == '$ORIGIN'* ]] || fail "$file searches '$folder' for libraries"
  done
done
"$prefix/bin/alhazen" devices | tee "$work/devices.txt"
for module in "$prefix"/lib*/alhazen/*.so "$prefix"/lib*/*/alhazen/*.so; do
  [[ ! -e $module ]] || grep -qF "$module" "$work/devices.txt" || fail "'devices' does not list $module"
done

version=$("$prefix/bin/alhazen" --version | sed -n '1s/^alhazen //p')
scene=$prefix/share/alhazen/scenes/cornell.pbrt
expect_example() {
  "$@" "$scene" 0 >"$work/example.txt" || { cat "$work/example.txt"; fail "$1 does not run"; }
  grep -qE '^(100 x 100 pixels|cancelled)' "$work/example.txt" || { cat "$work/example.txt"; fail "$1 does not render"; }
}

# The shared library asks for no other package.
absent=()
for package in OpenEXR PNG JPEG ZLIB fmt draco meshoptimizer EXPAT OpenMP nlohmann_json embree; do
  absent+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
cp -r "$source/examples/render_to_memory" "$work/example"
cmake -S "$work/example" -B "$work/by_cmake" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$prefix" \
  "${absent[@]}" >"$work/cmake.log" || { cat "$work/cmake.log"; fail "find_package"; }
cmake --build "$work/by_cmake"
expect_example "$work/by_cmake/render_to_memory"

# Which versions and components are found, the static library only where it was built.
printf 'cmake_minimum_required(VERSION 3.25)\nproject(p CXX)\nfind_package(alhazen %s)\nmessage("found ${alhazen_FOUND}")\n' \
  '${ASKED}' >"$work/CMakeLists.txt"
asked() { cmake -S "$work" -B "$work/asked" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" "-DASKED=$1" 2>&1 | sed -n 's/^found //p'; }
[[ $(asked "$version") == 1 ]] || fail "find_package does not find version $version"
[[ $(asked "${version%%.*}.99") == 0 ]] || fail "find_package takes $version for another minor version"
[[ $(asked 'COMPONENTS;nonsense') == 0 ]] || fail "find_package finds a component that does not exist"
archive=$(find "$prefix" -name libalhazen.a)
[[ $(asked 'COMPONENTS;static') == $(((${#archive} > 0))) ]] || fail "whether the static library is found is not whether it is there"

if command -v pkg-config >/dev/null; then
  PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name alhazen.pc)")
  export PKG_CONFIG_PATH
  [[ $(pkg-config --modversion alhazen) == "$version" ]] || fail "pkg-config says version $(pkg-config --modversion alhazen)"
  read -ra flags <<<"$(pkg-config --cflags --libs alhazen)"
  "$compiler" -std=c++20 "$work/example/main.cpp" "${flags[@]}" -o "$work/by_pkg_config"
  expect_example env LD_LIBRARY_PATH="$(pkg-config --variable=libdir alhazen)" "$work/by_pkg_config"
  if [[ -n $archive ]]; then
    read -ra flags <<<"$(pkg-config --static --libs alhazen | sed 's/-lalhazen //')"
    "$compiler" -std=c++20 "-I$prefix/include" "$work/example/main.cpp" "$archive" "${flags[@]}" -o "$work/static"
    expect_example "$work/static"
    # Kernels are weak symbols, which take nothing out of an archive by themselves.
    "$compiler" -std=c++20 "-I$prefix/include" "$source/examples/ambient_occlusion/main.cpp" "$archive" "${flags[@]}" -o "$work/static_rays"
    "$work/static_rays" "$scene" "$work/occlusion.pgm" 278 273 -800 278 273 0 100 || fail "ray queries by the archive"
    ! readelf -d "$work/static" | grep -q 'NEEDED.*libalhazen' || fail "the static program needs the shared library"
  fi
else
  echo "pkg-config is not installed: alhazen.pc is not tried"
fi
if [[ -n $archive ]]; then
  sed -i 's/find_package(alhazen REQUIRED)/find_package(alhazen REQUIRED COMPONENTS static)/; s/alhazen::alhazen/alhazen::alhazen_static/' \
    "$work/example/CMakeLists.txt"
  cmake -S "$work/example" -B "$work/by_cmake_static" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$prefix"
  cmake --build "$work/by_cmake_static"
  expect_example "$work/by_cmake_static/render_to_memory"
fi

# A page for each subcommand, without faults where there is a tool that finds them, and the completions.
"$prefix/bin/alhazen" --help-all | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\+\) .*/alhazen-\1/p' >"$work/pages.txt"
"$prefix/bin/alhazen" study --help-all | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\+\) .*/alhazen-study-\1/p' >>"$work/pages.txt"
[[ $(wc -l <"$work/pages.txt") -ge 9 ]] || fail "the help lists too few subcommands"
for page in alhazen $(cat "$work/pages.txt"); do
  file=$prefix/share/man/man1/$page.1
  [[ -s $file ]] || fail "there is no manual page $page"
  if command -v mandoc >/dev/null; then mandoc -T lint -W warning "$file" || fail "mandoc: $page"; fi
  if command -v groff >/dev/null; then
    groff -man -ww -z "$file" 2>"$work/groff.txt"
    [[ ! -s $work/groff.txt ]] || { cat "$work/groff.txt"; fail "groff: $page"; }
  fi
done
grep -q '^\.BI "\\-\\-spp" " N"$' "$prefix/share/man/man1/alhazen-render.1" || fail "the page of render lacks --spp"
for file in bash-completion/completions/alhazen fish/vendor_completions.d/alhazen.fish zsh/site-functions/_alhazen; do
  [[ -s $prefix/share/$file ]] || [[ $file == zsh/* && -s $prefix/share/zsh/vendor-completions/_alhazen ]] || fail "there is no $file"
done
