#!/usr/bin/env bash
# The scenes that a script writes are as their script writes them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../scenes"

for scene in spheres weekend; do
  diff -q "$scene.pbrt" <(python3 "generate_$scene.py") >/dev/null || {
    echo "scenes/$scene.pbrt is not what scenes/generate_$scene.py writes: run it, or undo the change" >&2
    exit 1
  }
done
