#!/usr/bin/env bash
# From a clean clone to a picture: installs what is missing, builds the program without its modules (GPUs, Embree) and renders
# scenes/spheres.pbrt to spheres.png and spheres.exr in the root of the repository. Argument: the samples per pixel (default: 64).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh --program
scripts/build.sh --program
build/release/bin/alhazen render scenes/spheres.pbrt --spp "${1:-64}" -o spheres.png -o spheres.exr
echo "The picture: $PWD/spheres.png (to look at) and $PWD/spheres.exr (linear radiance)"
