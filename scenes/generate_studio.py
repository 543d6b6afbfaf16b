#!/usr/bin/env python3
"""Writes scenes/studio.glb, a binary glTF file: a gold knot, a glass ball, a lacquered block, a vase and small balls on a
chequered floor, lit by a ring of light and a soft box. Always the same file.

    python3 scenes/generate_studio.py > scenes/studio.glb

It has two cameras (front, above), an animation (the knot turns once in four seconds) and two variants of the block
(red, blue).
"""

import json
import math
import struct
import sys
import zlib

ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
UNSIGNED_BYTE, UNSIGNED_SHORT, FLOAT = 5121, 5123, 5126
NEAREST, REPEAT = 9728, 10497


def add(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def subtract(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


# Surfaces: functions of u and v in [0, 1]. Seen from outside, v runs counterclockwise from u.


def superellipsoid(u, v, exponent=1.0):
    """A ball of radius 1 for exponent 1, a block with round edges for smaller ones."""
    def power(x):
        return math.copysign(abs(x) ** exponent, x) if abs(x) > 1e-9 else 0.0

    latitude, longitude = math.pi * (v - 0.5), 2 * math.pi * u
    return (power(math.cos(latitude)) * power(math.sin(longitude)), power(math.sin(latitude)),
            power(math.cos(latitude)) * power(math.cos(longitude)))


def torus(u, v, tube):
    """An upright ring of radius 1 round the z axis."""
    a, b = 2 * math.pi * u, 2 * math.pi * v
    return (1 + tube * math.cos(b)) * math.cos(a), (1 + tube * math.cos(b)) * math.sin(a), tube * math.sin(b)


def knot(u, v, tube=0.36):
    """A trefoil knot about the y axis, inside radius 3.4."""
    t = 2 * math.pi * u
    radius = 2 + math.cos(3 * t)
    centre = (radius * math.cos(2 * t), math.sin(3 * t), radius * math.sin(2 * t))
    change = -3 * math.sin(3 * t)
    along = unit((change * math.cos(2 * t) - 2 * radius * math.sin(2 * t), 3 * math.cos(3 * t),
                  change * math.sin(2 * t) + 2 * radius * math.cos(2 * t)))
    aside = unit(cross(along, (math.cos(2 * t), 0, math.sin(2 * t))))
    up = cross(aside, along)
    c, s = tube * math.cos(2 * math.pi * v), tube * math.sin(2 * math.pi * v)
    return add(centre, tuple(c * a + s * b for a, b in zip(up, aside)))


# Radius and height along the vase, from the middle of its foot over its rim to the middle of its inside.
VASE = [(0, 0), (0.24, 0), (0.27, 0.04), (0.42, 0.3), (0.46, 0.5), (0.38, 0.75), (0.2, 0.95), (0.17, 1.1), (0.25, 1.24),
        (0.23, 1.24), (0.13, 1.1), (0.15, 0.95), (0.3, 0.75), (0.38, 0.5), (0.3, 0.2), (0, 0.1)]


def vase(u, v):
    """A surface of revolution about the y axis, by a Catmull-Rom spline through VASE."""
    at = v * (len(VASE) - 1)
    i = min(int(at), len(VASE) - 2)
    s = at - i
    points = [VASE[max(0, min(len(VASE) - 1, i + k))] for k in (-1, 0, 1, 2)]
    weights = (-s * (1 - s) ** 2 / 2, (2 - 5 * s * s + 3 * s ** 3) / 2, (s + 4 * s * s - 3 * s ** 3) / 2,
               -s * s * (1 - s) / 2)
    radius, height = (sum(w * p[axis] for w, p in zip(weights, points)) for axis in (0, 1))
    radius = max(radius, 0) if 0 < v < 1 else 0
    return radius * math.sin(2 * math.pi * u), height, radius * math.cos(2 * math.pi * u)


def tessellate(surface, columns, rows):
    """Positions, normals and triangles of a surface. Equal points are one vertex, so closed surfaces have no seam."""
    vertices, index_of, corners = [], {}, []
    for j in range(rows + 1):
        for i in range(columns + 1):
            point = tuple(round(x, 5) + 0.0 for x in surface(i / columns, j / rows))
            if point not in index_of:
                index_of[point] = len(vertices)
                vertices.append(point)
            corners.append(index_of[point])
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a, b = corners[j * (columns + 1) + i], corners[j * (columns + 1) + i + 1]
            c, d = corners[(j + 1) * (columns + 1) + i], corners[(j + 1) * (columns + 1) + i + 1]
            triangles += [t for t in ((a, b, d), (a, d, c)) if len(set(t)) == 3]
    normals = [(0.0, 0.0, 0.0)] * len(vertices)
    for a, b, c in triangles:
        normal = cross(subtract(vertices[b], vertices[a]), subtract(vertices[c], vertices[a]))
        for k in (a, b, c):
            normals[k] = add(normals[k], normal)
    return vertices, [tuple(round(x, 5) for x in unit(n)) for n in normals], triangles


def grey_png(rows):
    """A PNG of 8-bit greys, not compressed, so that it is the same with every version of zlib."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    pixels = b"".join(b"\0" + bytes(row) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(pixels, 0)) +
            chunk(b"IEND", b""))


class Document:
    """A glTF document that grows, and the bytes of its one buffer."""

    def __init__(self):
        self.data = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": "scenes/generate_studio.py of Alhazen"}}

    def append(self, key, value):
        self.json.setdefault(key, []).append(value)
        return len(self.json[key]) - 1

    def view(self, data, target=None):
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.data += data + bytes(-len(data) % 4)
        return self.append("bufferViews", view | ({"target": target} if target else {}))

    def accessor(self, rows, form, component, shape, target=None, bounds=False):
        packed = b"".join(struct.pack("<" + form, *row) for row in rows)
        limits = {name: [function(column) for column in zip(*rows)] for name, function in (("min", min), ("max", max))}
        return self.append("accessors", {"bufferView": self.view(packed, target), "componentType": component,
                                         "count": len(rows), "type": shape} | (limits if bounds else {}))

    def geometry(self, vertices, normals, triangles, uvs=None):
        attributes = {"POSITION": self.accessor(vertices, "3f", FLOAT, "VEC3", ARRAY_BUFFER, bounds=True),
                      "NORMAL": self.accessor(normals, "3f", FLOAT, "VEC3", ARRAY_BUFFER)}
        if uvs:
            attributes["TEXCOORD_0"] = self.accessor(uvs, "2f", FLOAT, "VEC2", ARRAY_BUFFER)
        indices = self.accessor([(k,) for t in triangles for k in t], "H", UNSIGNED_SHORT, "SCALAR",
                                ELEMENT_ARRAY_BUFFER)
        return {"attributes": attributes, "indices": indices}

    def mesh(self, name, geometry, material, **more):
        return self.append("meshes", {"name": name, "primitives": [geometry | {"material": material} | more]})

    def place(self, name, mesh, translation=(0, 0, 0), scale=1.0, rotation=(0, 0, 0, 1)):
        return self.append("nodes", {"name": name, "mesh": mesh, "translation": translation, "scale": [scale] * 3,
                                     "rotation": rotation})

    def material(self, name, colour, metallic=0.0, roughness=0.5, extensions=None, **more):
        base = {"baseColorFactor": [*colour, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
        entry = {"name": name, "pbrMetallicRoughness": base} | more
        return self.append("materials", entry | ({"extensions": extensions} if extensions else {}))

    def light(self, name, colour, strength):
        return self.material(name, (0, 0, 0), emissiveFactor=colour, extensions={
            "KHR_materials_emissive_strength": {"emissiveStrength": strength}})

    def bytes(self):
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.data)) +
                struct.pack("<I4s", len(text), b"JSON") + text +
                struct.pack("<I4s", len(self.data), b"BIN\0") + self.data)


def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return [round(math.sin(half) * x, 6) for x in axis] + [round(math.cos(half), 6)]


def rectangle(width, depth, tiles=0):
    """A rectangle in y = 0 that faces up; its uvs run from 0 to `tiles`."""
    x, z = width / 2, depth / 2
    vertices = [(-x, 0, z), (x, 0, z), (x, 0, -z), (-x, 0, -z)]
    uvs = [(0, tiles), (tiles, tiles), (tiles, 0), (0, 0)] if tiles else None
    return vertices, [(0, 1, 0)] * 4, [(0, 1, 2), (0, 2, 3)], uvs


def add_floor(document):
    png = document.view(grey_png([[255, 170], [170, 255]]))
    document.append("images", {"bufferView": png, "mimeType": "image/png"})
    document.append("samplers", {"magFilter": NEAREST, "wrapS": REPEAT, "wrapT": REPEAT})
    texture = document.append("textures", {"source": 0, "sampler": 0})
    material = document.material("floor", (0.5, 0.48, 0.46), roughness=0.35)
    document.json["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
    document.place("floor", document.mesh("floor", document.geometry(*rectangle(60, 60, tiles=60)), material))


def add_lights(document):
    ring = document.geometry(*tessellate(lambda u, v: torus(u, v, 0.03), 72, 8))
    document.place("ring", document.mesh("ring", ring, document.light("ring light", (1, 0.33, 0.08), 3)),
                   (0, 1.36, -1.5), 1.3)
    box = document.geometry(*rectangle(4, 2.6))
    left = document.light("left light", (0.8, 0.9, 1), 11)
    document.place("left box", document.mesh("left box", box, left), (-4.4, 4, 3), 1, turn(unit((-0.7, 0, -1)), 136))
    top = document.light("top light", (1, 0.93, 0.85), 5)
    document.place("top box", document.mesh("top box", box, top), (1.5, 5, -0.5), 1, turn((1, 0, 0), 180))


def add_block(document):
    coat = {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.03}}
    red = document.material("red lacquer", (0.62, 0.03, 0.02), 0.6, 0.45, coat)
    blue = document.material("blue lacquer", (0.03, 0.12, 0.6), 0.6, 0.45, coat)
    document.json["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]}}
    mappings = [{"material": red, "variants": [0]}, {"material": blue, "variants": [1]}]
    block = document.geometry(*tessellate(lambda u, v: superellipsoid(u, v, 0.35), 40, 20))
    mesh = document.mesh("block", block, red, extensions={"KHR_materials_variants": {"mappings": mappings}})
    document.place("block", mesh, (1.35, 0.42, 0.25), 0.42, turn((0, 1, 0), 32))


def add_balls(document):
    glass = document.material("glass", (1, 1, 1), roughness=0, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.55, 0.85, 0.7]}})
    film = document.material("film", (0.02, 0.02, 0.03), roughness=0.12, extensions={
        "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.8,
                                      "iridescenceThicknessMaximum": 420}})
    copper = document.material("copper", (0.96, 0.5, 0.36), 1, 0.3)
    velvet = document.material("velvet", (0.03, 0.05, 0.2), roughness=0.9, extensions={
        "KHR_materials_sheen": {"sheenColorFactor": [0.35, 0.45, 0.9], "sheenRoughnessFactor": 0.4}})
    chalk = document.material("chalk", (0.8, 0.78, 0.72), roughness=1)
    ball = document.geometry(*tessellate(superellipsoid, 40, 20))
    for name, material, (x, z), radius in (
            ("glass ball", glass, (-1.2, 0.75), 0.5), ("film ball", film, (2.5, -0.35), 0.4),
            ("copper ball", copper, (0.55, 1.15), 0.19), ("velvet ball", velvet, (-0.35, 1.4), 0.16),
            ("chalk ball", chalk, (1.0, 1.75), 0.13)):
        document.place(name, document.mesh(name, ball, material), (x, radius, z), radius)


def add_knot(document):
    gold = document.material("gold", (1, 0.77, 0.34), 1, 0.2)
    mesh = document.mesh("knot", document.geometry(*tessellate(knot, 128, 13)), gold)
    return document.place("knot", mesh, (0, 0.92, -0.35), 0.27, turn((1, 0, 0), 78))


def add_vase(document):
    glaze = document.material("glaze", (0.02, 0.22, 0.24), roughness=0.5, extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.08}})
    document.place("vase", document.mesh("vase", document.geometry(*tessellate(vase, 36, 30)), glaze), (-2.05, 0, -0.45))


def add_cameras(document):
    for name, angle, position, pitch in (("front", 27, (0, 1.45, 7.4), -5.5), ("above", 34, (0, 6.2, 4.6), -54)):
        camera = document.append("cameras", {"name": name, "type": "perspective", "perspective": {
            "yfov": round(math.radians(angle), 6), "aspectRatio": round(16 / 9, 6), "znear": 0.1}})
        document.append("nodes", {"name": name, "camera": camera, "translation": position,
                                  "rotation": turn((1, 0, 0), pitch)})


def add_animation(document, node):
    """Turns a node once about the vertical axis."""
    steps = 4
    start = document.json["nodes"][node]["rotation"]
    rotations = [multiply(turn((0, 1, 0), 360 * k / steps), start) for k in range(steps + 1)]
    times = document.accessor([(float(k),) for k in range(steps + 1)], "f", FLOAT, "SCALAR", bounds=True)
    values = document.accessor(rotations, "4f", FLOAT, "VEC4")
    document.append("animations", {
        "name": "turn", "samplers": [{"input": times, "output": values}],
        "channels": [{"sampler": 0, "target": {"node": node, "path": "rotation"}}]})


def multiply(p, q):
    """The quaternion (x, y, z, w) that rotates by q, then by p."""
    xyz = add(add(tuple(p[3] * a for a in q[:3]), tuple(q[3] * a for a in p[:3])), cross(p[:3], q[:3]))
    return tuple(round(x, 6) for x in (*xyz, p[3] * q[3] - sum(a * b for a, b in zip(p[:3], q[:3]))))


def main():
    document = Document()
    add_floor(document)
    add_lights(document)
    add_block(document)
    add_balls(document)
    add_vase(document)
    node = add_knot(document)
    add_cameras(document)
    add_animation(document, node)
    document.json["scene"] = 0
    document.json["scenes"] = [{"nodes": list(range(len(document.json["nodes"])))}]
    document.json["extensionsUsed"] = ["KHR_materials_variants"] + sorted(
        {name for material in document.json["materials"] for name in material.get("extensions", {})})
    sys.stdout.buffer.write(document.bytes())


if __name__ == "__main__":
    main()
