#!/usr/bin/env bash
# Kernels that are compiled for processors with fused operations have them where the code asks for them alone, which is
# in packed additions: -ffp-contract=off keeps the others out, but not all (GCC 12 makes vfmaddsub of rows of a matrix).
# Arguments: object files.
set -euo pipefail

command -v objdump >/dev/null || { echo "objdump is not here" >&2; exit 77; }
failed=0
for object in "$@"; do
  if found=$(objdump -d --no-show-raw-insn "$object" | grep -E -m 3 'vfn?m(add|sub)[0-9]+s[sd]|vfm(addsub|subadd)'); then
    echo "$object: fused operations that nobody asked for, so that its images differ from those of other instruction sets:"
    echo "$found"
    failed=1
  fi
done
exit "$failed"
