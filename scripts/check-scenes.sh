#!/usr/bin/env bash
# Checks that generated scenes are what their scripts generate.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../scenes"

for file in spheres.pbrt weekend.pbrt studio.glb sky.hdr; do
  script="generate_${file%.*}.py"
  python3 "$script" | cmp -s - "$file" || {
    echo "scenes/$file is not what scenes/$script writes: run it, or undo the change" >&2
    exit 1
  }
done
