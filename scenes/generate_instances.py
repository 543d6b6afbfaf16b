#!/usr/bin/env python3
"""Writes a pbrt scene of many instances of one mesh on a plain, each turned and stretched, always the same.

    python3 scenes/generate_mesh.py --triangles 100000 knot.ply
    python3 scenes/generate_instances.py --count 10000 knot.ply instances.pbrt
"""

import argparse
import math
import random

HEAD = """# By scenes/generate_instances.py.
LookAt {x} {y} {z}  0 0 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 1280 "integer yresolution" 720
Sampler "zsobol" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 5
WorldBegin
LightSource "infinite" "rgb L" [ 0.5 0.6 0.8 ]
LightSource "distant" "point3 from" [ 2 -1 3 ] "point3 to" [ 0 0 0 ] "rgb L" [ 2 1.8 1.5 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "trianglemesh" "point3 P" [ -{far} -{far} -0.7  {far} -{far} -0.7  {far} {far} -0.7  -{far} {far} -0.7 ]
  "integer indices" [ 0 1 2 0 2 3 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.3 ]
ObjectBegin "knot" Shape "plymesh" "string filename" "{mesh}" ObjectEnd
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", help="PLY file, as seen from where the scene will lie")
    parser.add_argument("scene")
    parser.add_argument("--count", type=int, default=10_000)
    options = parser.parse_args()
    numbers = random.Random(1)
    side = math.ceil(math.sqrt(options.count))
    with open(options.scene, "w", encoding="utf-8") as out:
        out.write(HEAD.format(x=0.6 * side, y=-0.9 * side, z=0.35 * side, far=10 * side, mesh=options.mesh))
        for i in range(options.count):
            x = i % side - side / 2 + 0.3 * numbers.random()
            y = i // side - side / 2 + 0.3 * numbers.random()
            out.write(f"AttributeBegin Translate {x:.4f} {y:.4f} 0 Rotate {360 * numbers.random():.2f} 0 0 1 "
                      f"Scale {0.15 + 0.1 * numbers.random():.3f} 0.2 0.2 ObjectInstance \"knot\" AttributeEnd\n")


if __name__ == "__main__":
    main()
