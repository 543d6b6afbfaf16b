#!/usr/bin/env bash
# Formats the C++ of the repository with clang-format. --check: changes nothing, reports each difference and fails; exits
# with 77 if clang-format 14, that of Debian 12, is not installed (other versions break lines differently).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

wanted=14
tool=""
for candidate in "clang-format-$wanted" clang-format; do
  if command -v "$candidate" >/dev/null && "$candidate" --version | grep -q "version $wanted\."; then
    tool=$candidate
    break
  fi
done
if [[ -z $tool ]]; then
  echo "format: clang-format $wanted is not installed; nothing is checked or changed" >&2
  exit 77
fi

mapfile -d '' -t files < <(find bench examples include python src tests -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.cu' -o -name '*.cuh' \) -print0 2>/dev/null | sort -z)
if [[ ${1:-} == --check ]]; then
  "$tool" --dry-run -Werror "${files[@]}" || {
    echo "format: run scripts/format.sh" >&2
    exit 1
  }
else
  "$tool" -i "${files[@]}"
fi
