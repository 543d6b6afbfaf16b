#!/usr/bin/env python3
"""Writes a twisted trefoil knot as a binary PLY file with normals: closed, any number of triangles, always the same.

    python3 scenes/generate_mesh.py scenes/knot.ply.gz                         # the mesh of scenes/mesh.pbrt
    python3 scenes/generate_mesh.py --triangles 1500000 knot-1500000.ply       # one to measure with
"""

import argparse
import array
import gzip
import math
import struct

TUBE = 0.5  # mean radius of the tube
RIDGES, RIDGE_HEIGHT = 4, 0.085
TURNS = 9  # turns of the ridges along the tube
SEGMENTS_ROUND_PER_SQUARE_ROOT = 0.33  # share of quads round the tube: about square ones


def unit(v):
    length = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    return v[0] / length, v[1] / length, v[2] / length


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def centre_line(t):
    """Point, normal and binormal of the trefoil (2 + cos 3t) (cos 2t, sin 2t), sin 3t; t in [0, 2 pi)."""
    c2, s2, c3, s3 = math.cos(2 * t), math.sin(2 * t), math.cos(3 * t), math.sin(3 * t)
    radius, first, second = 2 + c3, -3 * s3, -9 * c3
    point = (radius * c2, radius * s2, s3)
    velocity = (first * c2 - 2 * radius * s2, first * s2 + 2 * radius * c2, 3 * c3)
    acceleration = (second * c2 - 4 * first * s2 - 4 * radius * c2, second * s2 + 4 * first * c2 - 4 * radius * s2,
                    -9 * s3)
    binormal = unit(cross(velocity, acceleration))
    return point, cross(binormal, unit(velocity)), binormal


def knot_points(rows, columns):
    """rows * columns points, three numbers each; rows run along the tube, columns round it."""
    points = array.array("d")
    angles = [2 * math.pi * j / columns for j in range(columns)]
    directions = [(math.cos(a), math.sin(a)) for a in angles]
    for i in range(rows):
        t = 2 * math.pi * i / rows
        p, n, b = centre_line(t)
        for a, (c, s) in zip(angles, directions):
            r = TUBE + RIDGE_HEIGHT * math.cos(RIDGES * a + TURNS * t)
            x, y = r * c, r * s
            points.extend((p[0] + x * n[0] + y * b[0], p[1] + x * n[1] + y * b[1], p[2] + x * n[2] + y * b[2]))
    return points


def write_vertices(out, points, rows, columns):
    record = struct.Struct("<6f")
    for i in range(rows):
        before, here, after = (3 * columns * (k % rows) for k in (i - 1, i, i + 1))
        packed = bytearray()
        for j in range(columns):
            a, b, c, d = (after + 3 * j, before + 3 * j, here + 3 * ((j + 1) % columns), here + 3 * ((j - 1) % columns))
            along = (points[a] - points[b], points[a + 1] - points[b + 1], points[a + 2] - points[b + 2])
            around = (points[c] - points[d], points[c + 1] - points[d + 1], points[c + 2] - points[d + 2])
            at = here + 3 * j
            packed += record.pack(points[at], points[at + 1], points[at + 2], *unit(cross(around, along)))
        out.write(packed)


def write_faces(out, rows, columns):
    record = struct.Struct("<B3iB3i")
    for i in range(rows):
        here, after = columns * i, columns * ((i + 1) % rows)
        packed = bytearray()
        for j in range(columns):
            k = (j + 1) % columns
            packed += record.pack(3, here + j, here + k, after + j, 3, here + k, after + k, after + j)
        out.write(packed)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--triangles", type=int, default=12000, help="about how many (default: 12000)")
    parser.add_argument("output", help=".ply or .ply.gz")
    options = parser.parse_args()

    quads = max(options.triangles // 2, 24)
    columns = max(round(SEGMENTS_ROUND_PER_SQUARE_ROOT * math.sqrt(quads)), 4)
    rows = max(round(quads / columns), 6)
    points = knot_points(rows, columns)
    header = (f"ply\nformat binary_little_endian 1.0\ncomment twisted trefoil knot\nelement vertex {rows * columns}\n"
              + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
              + f"element face {2 * rows * columns}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(options.output, "wb") as file:
        out = gzip.GzipFile("", "wb", 9, file, 0) if options.output.endswith(".gz") else file
        out.write(header.encode())
        write_vertices(out, points, rows, columns)
        write_faces(out, rows, columns)
        if out is not file:
            out.close()
    print(f"{options.output}: {rows * columns} vertices, {2 * rows * columns} triangles")


if __name__ == "__main__":
    main()
