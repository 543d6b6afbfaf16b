#!/usr/bin/env bash
# Builds packages for Debian in build/package/packages: the program, the shared library, its headers, the module of Python, and each
# module whose library is found; without tests and benchmarks, for any processor. Says what lintian, where it is installed, finds in them.
# Arguments: options for CMake, for example -DALHAZEN_PACKAGE_MAINTAINER="NAME <ADDRESS>" or -DALHAZEN_CUDA=ON.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/package

launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake --preset release -B $build "${launcher[@]}" -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_SKIP_INSTALL_RPATH=ON \
  -DALHAZEN_TESTS=OFF -DALHAZEN_BENCH=OFF -DALHAZEN_UNITY=ON -DPython3_EXECUTABLE=/usr/bin/python3 "$@" >/dev/null
cmake --build $build
rm -rf $build/packages/*.deb
(cd $build && umask 022 && cpack -G DEB >/dev/null)
ls -l $build/packages/*.deb

if command -v lintian >/dev/null; then
  tags=()
  # Without an address these are errors, which those who publish the packages must see and others need not.
  [[ $* == *ALHAZEN_PACKAGE_MAINTAINER* ]] || tags=(--suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog)
  lintian --tag-display-limit 0 --fail-on error --profile debian "${tags[@]}" $build/packages/*.deb
fi
