#!/usr/bin/env bash
# Runs the fuzz targets of build/fuzz one after the other, each from its earlier findings and from its corpus in
# tests/fuzz/corpus. Environment: SECONDS_EACH (default: 600). Arguments: names of targets, such as `png` or
# `render_gltf` (default: all). Inputs with new coverage are kept in build/fuzz/found, failing ones in build/fuzz/findings.
#   cmake --preset fuzz && cmake --build --preset fuzz && scripts/fuzz.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
programs=build/fuzz/tests/fuzz

targets=("$@")
if ((${#targets[@]} == 0)); then
  for program in "$programs"/fuzz_*; do
    [[ -f $program && -x $program ]] && targets+=("${program##*/fuzz_}")
  done
fi
if ((${#targets[@]} == 0)); then
  echo "fuzz: there are no targets in $programs: cmake --preset fuzz && cmake --build --preset fuzz" >&2
  exit 1
fi

failed=()
for target in "${targets[@]}"; do
  format=${target#render_}
  options=(-max_total_time="${SECONDS_EACH:-600}" -timeout=30 -rss_limit_mb=4096 -print_final_stats=1 -verbosity=0)
  if [[ -f tests/fuzz/$format.dict ]]; then options+=(-dict="tests/fuzz/$format.dict"); fi
  mkdir -p "build/fuzz/found/$target" build/fuzz/findings
  corpora=("build/fuzz/found/$target")
  also=()
  if [[ $target == render_image ]]; then also=(exr png hdr); fi
  for corpus in "$target" "$format" "${also[@]}"; do
    # The target's own name occurs twice if it does not begin with render_.
    if [[ -d tests/fuzz/corpus/$corpus && ${corpora[-1]} != "tests/fuzz/corpus/$corpus" ]]; then
      corpora+=("tests/fuzz/corpus/$corpus")
    fi
  done
  echo "== $target"
  "$programs/fuzz_$target" "${options[@]}" -artifact_prefix="build/fuzz/findings/$target-" "${corpora[@]}" ||
    failed+=("$target")
done
if ((${#failed[@]} > 0)); then
  echo "fuzz: findings of ${failed[*]} lie in build/fuzz/findings" >&2
  exit 1
fi
