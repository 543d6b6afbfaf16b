#!/usr/bin/env bash
# Installs the packages of scripts/package.sh in a bare Debian in a folder of its own, renders there, adds the module of Embree and
# that of Python, and compiles the example with nothing but g++ and CMake besides; then removes all.
# Needs root, debootstrap, and Debian's archive.
# Arguments: the folder of the packages (default: build/package/packages), that of the Debian (default: a new one in /tmp,
# which is removed; a named one is made by debootstrap where it is not there, and stays), and its suite (default: bookworm).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
packages=${1:-build/package/packages}
suite=${3:-bookworm}
if [[ -n ${2:-} ]]; then
  root=$2
else
  root=$(mktemp -d)
  trap 'rm -rf "$root"' EXIT
fi

step() { printf '\n== %s\n' "$*"; }
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
install_packages() {
  inside apt-get install -y -q --no-install-recommends "$@" >"$root/root/apt.log" 2>&1 || { cat "$root/root/apt.log"; exit 1; }
}
purge() {
  inside dpkg-query -W -f='${Package}\n' '*alhazen*' 2>/dev/null | xargs -r chroot "$root" apt-get purge -y -q --autoremove >/dev/null
}
# The package whose name matches, as a path within.
package() { (cd "$root" && find root/packages -regex "root/packages/$1_[^_]*_[^_]*[.]deb" -printf '/%p\n'); }

if [[ ! -e $root/etc/debian_version ]]; then
  step "debootstrap $suite"
  debootstrap --variant=minbase "$suite" "$root" >"$root.log" || { tail "$root.log"; exit 1; }
  rm -f "$root.log"
fi
rm -rf "$root/root/packages" "$root/root/example"
mkdir -p "$root/root/packages"
cp "$packages"/*.deb "$root/root/packages/"
cp -r examples/render_to_memory "$root/root/example"
# What an earlier run has left may have the same version and other files.
purge
cp tests/packages/use_module.py "$root/root/"
inside apt-get update -q >/dev/null

step "apt install ./alhazen ./libalhazen0.1, without what they recommend"
install_packages "$(package alhazen)" "$(package 'libalhazen[0-9.]*')"
inside alhazen --version
inside alhazen devices
inside alhazen render /usr/share/alhazen/scenes/cornell.pbrt --spp 4 --size 64x64 -o /root/cornell.png
inside dpkg -l | awk '/^ii/ && /alhazen|embree/ { print $2, $3 }'

step "the module of Embree"
install_packages "$(package 'libalhazen[0-9.]*-embree')"
inside alhazen render /usr/share/alhazen/scenes/cornell.pbrt --backend embree --spp 4 --size 64x64 -o /root/embree.png

step "the Python module"
install_packages "$(package python3-alhazen)"
inside python3 /root/use_module.py /usr /usr/share/alhazen/scenes/cornell.pbrt
inside dpkg-query -W -f='${Package} ${Version}: ${Depends}\n' python3-alhazen

step "the example, with libalhazen-dev, g++ and cmake"
install_packages "$(package libalhazen-dev)" g++ cmake make
inside dpkg -l | awk '/^ii/ && $2 ~ /-dev(:|$)/ { print $2 }' | paste -sd' '
inside cmake -S /root/example -B /root/example/build
inside cmake --build /root/example/build
inside /root/example/build/render_to_memory /usr/share/alhazen/scenes/cornell.pbrt 1 | tail -1
inside g++ -std=c++20 /root/example/main.cpp -lalhazen -o /root/example/plain
inside ldd /root/example/plain | grep alhazen

step "removed again"
purge
find "$root/usr" -path "$root/usr/src" -prune -o -iname '*alhazen*' -print
