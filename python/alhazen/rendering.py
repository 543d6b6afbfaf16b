"""Renders scenes: alhazen.render and alhazen.progressive."""

import os
import time
from typing import Any, Callable, Iterator, Optional, Union

from ._alhazen import Progress, RenderedImage, Renderer, Scene, Settings, _load_by_settings, _render, _settings

SceneOrFile = Union[Scene, str, "os.PathLike[str]"]
ProgressArgument = Union[Callable[[Progress], Optional[bool]], bool, None]


def render(scene: SceneOrFile, settings: Optional[Settings] = None, *, progress: ProgressArgument = None,
           **keywords: Any) -> RenderedImage:
    """Renders a scene, or the scene of a file.

        image = alhazen.render("scene.pbrt", spp=64, width=640, height=480)

    scene: an alhazen.Scene, or the name of a file (.pbrt, .gltf, .glb, .xml of Mitsuba, .obj, .ply, .stl).
    settings: an alhazen.Settings. Each of its fields is also a keyword argument: spp, width, height, max_depth, seed,
    denoiser, layers, quality, noise, threads, ... `help(alhazen.Settings)` lists them.
    progress: a function that is called with an alhazen.Progress about ten times a second, from another thread; it stops
    the render by returning False, and the image so far is returned. True: a progress bar.

    Returns an alhazen.RenderedImage. Other threads of Python run meanwhile. Ctrl-C ends the render and raises
    KeyboardInterrupt. What `progress` raises is raised here.

    Raises InputError for bad input and settings, Error for other failures, TypeError for an unknown keyword argument.
    Warnings are alhazen.AlhazenWarning.
    """
    return _render(scene, _settings("render", settings, keywords), progress)


def progressive(scene: SceneOrFile, settings: Optional[Settings] = None, *, progress: ProgressArgument = None,
                samples_per_pass: int = 0, interval: float = 0.5, **keywords: Any) -> Iterator[RenderedImage]:
    """Renders a scene, and yields the image again and again while it gets better.

        for image in alhazen.progressive(scene, spp=1024):
            show(image)
            if is_good_enough(image):
                break

    scene, settings, progress, keywords: as of alhazen.render.
    samples_per_pass: how many samples a pixel gets between two images, rounded up to a multiple of 4, at most 64 (on
    GPUs 1024). 0: as many as take about `interval` seconds.

    Yields alhazen.RenderedImage: snapshots that are not denoised, and at the end the finished image, which has the same
    bits as that of alhazen.render. `break` ends the render; its checkpoint, if there is one, is saved. A scene may be
    changed meanwhile: that is not seen.
    """
    chosen = _settings("progressive", settings, keywords)
    return _snapshots(scene, chosen, progress, samples_per_pass, interval)


def _snapshots(scene, settings, progress, samples_per_pass, interval):
    if not isinstance(scene, Scene):
        scene, settings = _load_by_settings(scene, settings)
    renderer = Renderer(settings)
    renderer.start(scene, progress)
    samples = samples_per_pass or 4
    is_finished = False
    try:
        while True:
            begin = time.perf_counter()
            if not renderer.render_pass(samples):
                break
            seconds = time.perf_counter() - begin
            yield renderer.image()
            if not samples_per_pass:
                samples = _next_samples(samples, seconds, interval)
        is_finished = True
        yield renderer.finish()
    finally:
        renderer.stop()
        if not is_finished and settings.checkpoint:
            renderer.finish()


def _next_samples(samples, seconds, interval):
    """Half as many or twice as many as in a pass that took much more or less time than it should."""
    if 2 * seconds < interval:
        return min(2 * samples, 1024)
    return max(4, samples // 2) if seconds > 2 * interval else samples
