#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests, the checks of format and includes among them.
# Arguments are passed on to ctest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh
scripts/build.sh
ctest --preset release --parallel "$(nproc)" "$@"
