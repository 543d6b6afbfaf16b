#!/usr/bin/env python3
"""Error of a sphere of each material at the same number of samples, as a table (docs/results/quality.md).

  lobes.py --program before=BIN --program after=BIN

The sphere is under a white sky, and under a spot of 5 degrees in a black sky. `iterative` finds light by BSDF sampling
alone, so its error shows how well lobes are sampled; `path` samples the spot as a light as well. Each program is
compared with a reference of its own, since materials may scatter differently.
"""

import argparse
import base64
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

SPOT = (0.5, 0.6, 0.62)  # towards the light; the camera is at +z
SPOT_RADIUS = math.radians(2.5)

PBRT = {
    "coated diffuse 0.1, coat 0.3": '"coateddiffuse" "rgb reflectance" [ 0.1 0.1 0.1 ] "float roughness" 0.3',
    "coated conductor 0.9, 0.3": '"coatedconductor" "rgb reflectance" [ 0.9 0.9 0.9 ] "float conductor.roughness" 0.3 '
                                 '"float interface.roughness" 0',
    "conductor, 0.3": '"conductor" "rgb reflectance" [ 0.9 0.9 0.9 ] "float roughness" 0.3',
    "conductor, 1": '"conductor" "rgb reflectance" [ 0.9 0.9 0.9 ] "float roughness" 1',
    "dielectric 1.5, 0.3": '"dielectric" "float eta" 1.5 "float roughness" 0.3',
    "dielectric 2.42, 1": '"dielectric" "float eta" 2.42 "float roughness" 1',
    "thin dielectric": '"thindielectric" "float eta" 1.5',
    "Oren-Nayar 0.9": '"diffuse" "rgb reflectance" [ 0.9 0.9 0.9 ] "float roughness" 1',
}  # fmt: skip


def gltf(colour: float = 0.8, metal: float = 0, roughness: float = 0.5, **extensions: dict) -> dict:
    return {"pbrMetallicRoughness": {"baseColorFactor": [colour] * 3 + [1], "metallicFactor": metal,
                                     "roughnessFactor": roughness},
            "extensions": {f"KHR_materials_{name}": values for name, values in extensions.items()}}  # fmt: skip


GLTF = {
    "plastic 0.1, 0.4": gltf(0.1, 0, 0.4),
    "metal 0.1, 1": gltf(0.1, 1, 1),
    "metal 0.9, 0.6": gltf(0.9, 1, 0.6),
    "coated metal 0.1": gltf(0.1, 1, 0.6, clearcoat={"clearcoatFactor": 1}),
    "cloth 0.1, sheen 0.3": gltf(0.1, 0, 0.9, sheen={"sheenColorFactor": [0.8] * 3, "sheenRoughnessFactor": 0.3}),
    "cloth 0.1, sheen 0.1": gltf(0.1, 0, 0.9, sheen={"sheenColorFactor": [0.8] * 3, "sheenRoughnessFactor": 0.1}),
    "thin glass 0.8, 0.5": gltf(0.8, 0, 0.5, transmission={"transmissionFactor": 1}),
    "glass 0.1, 0.3": gltf(0.1, 0, 0.3, transmission={"transmissionFactor": 1}, volume={"thicknessFactor": 1}),
    "glass 0.9, 0.7": gltf(0.9, 0, 0.7, transmission={"transmissionFactor": 1}, volume={"thicknessFactor": 1}),
}


def write_map(path: pathlib.Path, radiance) -> None:
    """A Radiance HDR file of radiance(direction), in the convention of --environment: +y up, its centre towards -z."""
    width, height = 512, 256
    pixels = bytearray()
    for y in range(height):
        theta = math.pi * (y + 0.5) / height
        for x in range(width):
            phi = 2 * math.pi * (x + 0.5) / width
            value = radiance((-math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi)))
            mantissa, exponent = math.frexp(value)
            pixels += bytes([int(mantissa * 256)] * 3 + [exponent + 128]) if value > 0 else bytes(4)
    path.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + pixels)


def spot(direction: tuple[float, float, float]) -> float:
    length = math.sqrt(sum(x * x for x in SPOT))
    cosine = sum(a * b for a, b in zip(direction, SPOT)) / length
    return 1 / math.sin(SPOT_RADIUS) ** 2 if cosine > math.cos(SPOT_RADIUS) else 0.0


def pbrt_scene(material: str) -> str:
    return f"""LookAt 0 0 6  0 0 0  0 1 0
Camera "perspective" "float fov" 19.2
Film "rgb" "integer xresolution" 64 "integer yresolution" 64
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material {material}
Shape "sphere"
"""


def gltf_scene(material: dict) -> str:
    """A tessellated sphere."""
    rows, columns = 64, 128
    points, indices = [], []
    for i in range(rows + 1):
        for j in range(columns + 1):
            theta, phi = math.pi * i / rows, 2 * math.pi * j / columns
            points += [math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi)]
    for i in range(rows):
        for j in range(columns):
            a, b = i * (columns + 1) + j, (i + 1) * (columns + 1) + j
            indices += [a, b, b + 1] if i == 0 else [a, b, a + 1] if i == rows - 1 else [a, b, a + 1, a + 1, b, b + 1]
    data = struct.pack(f"<{len(points)}f", *points) + struct.pack(f"<{len(indices)}I", *indices)
    split = 4 * len(points)
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "extensionsUsed": list(material["extensions"]),
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 6]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": math.radians(19.2), "znear": 0.1}}],
        "materials": [material],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1, "material": 0}]}],
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": split},
                        {"buffer": 0, "byteOffset": split, "byteLength": len(data) - split}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points) // 3, "type": "VEC3",
                       "min": [-1, -1, -1], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"}]})  # fmt: skip


def run(*command: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"lobes: {' '.join(command)}\n{done.stderr.strip()}")
    return done.stdout


def render(program: str, scene: pathlib.Path, light: pathlib.Path, integrator: str, samples: int, seed: int) -> str:
    image = scene.with_name(f"{integrator}-{seed}.pfm")
    run(program, "render", str(scene), "--environment", str(light), "--integrator", integrator, "--spp", str(samples),
        "--seed", str(seed), "--max-depth", "100", "--size", "64x64", "-q", "-o", str(image))  # fmt: skip
    return str(image)


def relmse(program: str, image: str, reference: str) -> float:
    return json.loads(run(program, "compare", "--json", image, reference))["relmse"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", action="append", metavar="LABEL=BIN", help="may be given more than once")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=4, help="independent images, of which errors are the mean")
    parser.add_argument("--reference-spp", type=int, default=2048)
    parser.add_argument("--only", default="", metavar="TEXTS", help="materials with one of these in their names")
    options = parser.parse_args()
    programs = [text.split("=", 1) for text in options.program or ["alhazen=build/release/bin/alhazen"]]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        lights = {"sky": folder / "sky.hdr", "spot": folder / "spot.hdr"}
        write_map(lights["sky"], lambda _: 1.0)
        write_map(lights["spot"], spot)
        columns = [f"{light}, {integrator}, {label}" for light in lights for integrator in ("iterative", "path")
                   for label, _ in programs]  # fmt: skip
        print("| material | " + " | ".join(columns) + " |\n" + "|---" * (len(columns) + 1) + "|")
        scenes = {of: (".pbrt", pbrt_scene(text)) for of, text in PBRT.items()}
        scenes |= {of: (".gltf", gltf_scene(material)) for of, material in GLTF.items()}
        for of, (ending, text) in scenes.items():
            if not any(text in of for text in options.only.split(",")):
                continue
            scene = folder / f"scene{ending}"
            scene.write_text(text, encoding="utf-8")
            cells = []
            for light in lights.values():
                errors = {}
                for label, program in programs:
                    reference = render(program, scene, light, "path", options.reference_spp, 1000)
                    for integrator in ("iterative", "path"):
                        images = [render(program, scene, light, integrator, options.spp, seed)
                                  for seed in range(1, options.seeds + 1)]  # fmt: skip
                        errors[integrator, label] = sum(relmse(program, image, reference) for image in images)
                cells += [f"{errors[integrator, label] / options.seeds:.2g}"
                          for integrator in ("iterative", "path") for label, _ in programs]  # fmt: skip
            print(f"| {of} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
