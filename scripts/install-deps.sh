#!/usr/bin/env bash
# Installs what Alhazen is built and tested with, from Debian or Ubuntu; with the argument --program, what the program alone is
# built with; with --python, what `pip install .` needs. What is there already is left alone, so a second run does nothing and
# needs no network.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libopenexr-dev libpng-dev libjpeg-dev zlib1g-dev libstb-dev
  nlohmann-json3-dev libcli11-dev libfmt-dev libboost-dev
  libdraco-dev libmeshoptimizer-dev libwebp-dev libexpat1-dev
)
python=(python3 python3-dev pybind11-dev python3-numpy)
case ${1:-} in
  --program) ;;
  --python) packages+=("${python[@]}" python3-pip python3-venv) ;;
  *)
    packages+=(libembree-dev libgtest-dev libbenchmark-dev clang-format python3-matplotlib)
    # The Python module, and what its tests run: pytest, notebooks, mypy over the stubs, pip in a virtual environment.
    packages+=("${python[@]}" python3-pytest jupyter-nbconvert python3-ipykernel mypy python3-pip python3-venv)
    ;;
esac

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "install-deps: this is not Debian or Ubuntu. Install these yourself, under the names they have here: a C++20" \
    "compiler with OpenMP (GCC 12 or later), CMake 3.25, Ninja, OpenEXR 3, libpng, libjpeg, zlib, stb, nlohmann-json," \
    "CLI11, fmt, Boost's headers, Embree, Draco, meshoptimizer, libwebp and Expat where they are wanted; for the Python module Python 3.11, pybind11 2.10 and NumPy; for the tests" \
    "GoogleTest, Google Benchmark, clang-format, and Python's matplotlib, pytest, nbconvert, ipykernel, mypy and pip." >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "install-deps: these packages are missing: ${missing[*]}. Run this script as root, or install sudo." >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
