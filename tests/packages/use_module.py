"""Run by the tests of packages: the module `alhazen` is that of the folder given, and renders.

usage: use_module.py FOLDER SCENE, where the module and its library must be in FOLDER
"""

import sys
from pathlib import Path

import numpy as np

import alhazen

folder, scene = Path(sys.argv[1]).resolve(), sys.argv[2]
loaded = {alhazen.__file__}
maps = Path("/proc/self/maps")
if maps.exists():  # as everywhere but in a bare root without mounts
    loaded |= {line.split(None, 5)[5].strip() for line in maps.read_text().splitlines() if "alhazen" in line}
    assert any(Path(name).name.startswith("libalhazen.so.") for name in loaded), loaded
for name in loaded:
    assert folder in Path(name).resolve().parents, f"{name} is not in {folder}"
assert (Path(alhazen.__file__).parent / "py.typed").is_file()

image = alhazen.load(scene).render(width=32, height=32, spp=4)
pixels = np.asarray(image)
assert pixels.shape[:2] == (32, 32) and np.isfinite(pixels).all() and pixels.mean() > 0, pixels
print(alhazen.__version__)
