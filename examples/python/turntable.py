#!/usr/bin/env python3
"""Renders a turn about a scene: turn/000.png, turn/001.png, ...

    python3 turntable.py ../../scenes/studio.glb --frames 36

The scene is read once and its BVH is built once: only the camera moves from frame to frame.
"""

import argparse
from pathlib import Path

import alhazen

STUDIO = Path(__file__).resolve().parents[2] / "scenes" / "studio.glb"


def size(text):
    width, height = text.split("x")
    return int(width), int(height)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default=STUDIO, help="a scene file (default: studio.glb)")
    parser.add_argument("--frames", type=int, default=36)
    parser.add_argument("--elevation", type=float, default=14, help="degrees above the horizon")
    parser.add_argument("--distance", type=float, help="scene units; without it the whole scene is seen")
    parser.add_argument("--samples", type=int, default=128, help="per pixel")
    parser.add_argument("--size", type=size, default=(640, 360), metavar="WxH")
    parser.add_argument("--output", type=Path, default=Path("turn"), help="folder of the frames")
    options = parser.parse_args()

    scene = alhazen.load(options.scene)
    renderer = alhazen.Renderer(spp=options.samples, size=options.size, denoiser="auto")
    options.output.mkdir(parents=True, exist_ok=True)
    for frame in range(options.frames):
        scene.camera.orbit(360 * frame / options.frames, options.elevation, options.distance)
        built = renderer.start(scene)
        while renderer.render_pass():
            pass
        file = options.output / f"{frame:03d}.png"
        renderer.finish().save(file, tone_map="filmic")
        print(f"{file}: the BVH was {'built' if built.is_new else 'kept'} in {1000 * built.seconds:.0f} ms")


if __name__ == "__main__":
    main()
