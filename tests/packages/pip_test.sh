#!/usr/bin/env bash
# `pip install .` into a virtual environment, without a network: from a build folder that is there (ALHAZEN_PREBUILT), so that nothing
# is compiled. What it would compile without is configured only. Exits with 77, skipped, where pip or venv is missing.
# Arguments: the build folder, the interpreter.
set -euo pipefail
build=$1 python=$2
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"
unset PYTHONPATH CMAKE_ARGS
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INDEX=1 PIP_CONFIG_FILE=/dev/null

"$python" -c 'import ensurepip, venv' 2>/dev/null || { echo "$python has no venv (Debian: python3-venv)"; exit 77; }
"$python" -m venv --system-site-packages "$work/venv"
pip=$work/venv/bin/pip
cd "$work"

# Faults are one sentence, and leave nothing behind.
expect_failure() {
  ! ALHAZEN_PREBUILT=$1 "$pip" install "$source" >"$work/pip.log" 2>&1 || fail "ALHAZEN_PREBUILT=$1: pip does not fail"
  grep -q "alhazen: $2" "$work/pip.log" || { cat "$work/pip.log"; fail "ALHAZEN_PREBUILT=$1: pip does not say '$2'"; }
  ! "$pip" show alhazen >/dev/null 2>&1 || fail "ALHAZEN_PREBUILT=$1: alhazen is installed all the same"
}
expect_failure "$work/absent" "ALHAZEN_PREBUILT: .* is no build folder of CMake"
mkdir "$work/empty"
printf 'cmake_minimum_required(VERSION 3.25)\nproject(p NONE)\n' >"$work/empty/CMakeLists.txt"
cmake -S "$work/empty" -B "$work/empty/build" >/dev/null
expect_failure "$work/empty/build" ".* has no module for .*-DALHAZEN_PYTHON=ON"

ALHAZEN_PREBUILT=$build "$pip" install "$source" >"$work/pip.log" 2>&1 || { cat "$work/pip.log"; fail "pip install"; }
! "$pip" check | grep -i "^alhazen" || fail "pip check"
version=$("$work/venv/bin/python" "$source/tests/packages/use_module.py" "$work/venv" "$source/scenes/cornell.pbrt")
[[ $("$pip" show alhazen | sed -n 's/^Version: //p') == "$version" ]] || fail "pip and the module differ in the version"
built=("$build"/lib/alhazen/libalhazen_*.so)
for module in "${built[@]##*/}"; do
  [[ $module == *'*'* || -n $(find "$work/venv" -path "*/alhazen/lib/alhazen/$module") ]] || fail "the wheel lacks $module"
done
"$pip" uninstall -y alhazen >/dev/null
left=$(find "$work/venv" -ipath '*alhazen*')
[[ -z $left ]] || fail "pip uninstall leaves $left"

# Without ALHAZEN_PREBUILT.
CMAKE_ARGS="-DALHAZEN_CUDA=OFF" "$work/venv/bin/python" - "$source" "$work/build" >"$work/cmake.log" 2>&1 <<'TEXT' || { cat "$work/cmake.log"; fail "the build of a wheel is not configured"; }
import sys
from pathlib import Path
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1] + "/packaging/python")
import alhazen_backend
alhazen_backend.configure(Path(sys.argv[2]))
TEXT
! grep -q 'CMake Warning' "$work/cmake.log" || { cat "$work/cmake.log"; fail "CMake warns"; }
grep -q "$work/venv/bin/python" "$work/build/CMakeCache.txt" || fail "the interpreter is not the one that runs pip"
cmake --build "$work/build" --target help | sed 's/:.*//; s/^[. ]*//' | awk '{ print $1 }' >"$work/targets.txt"
for target in alhazen_python alhazen_installed; do
  grep -qx $target "$work/targets.txt" || fail "the build of a wheel lacks the target $target"
done
! grep -E '_tests$|_cli$|^alhazen_bench|^alhazen_manuals' "$work/targets.txt" || fail "the build of a wheel has more than it needs"
