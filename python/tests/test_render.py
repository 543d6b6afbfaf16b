"""Rendering: settings, callbacks, threads, Ctrl-C, warnings."""

import copy
import pickle
import signal
import threading
import time
import warnings

import numpy as np
import pytest

import alhazen
from common import CORNELL, ENDLESS, pixels_of_exr, run_program, start_python

SMALL = dict(spp=16, width=40, height=30, threads=2)


def test_same_bits_as_the_program(tmp_path):
    exr = tmp_path / "program.exr"
    run_program("render", CORNELL, "--spp", 16, "--size", "40x30", "-t", 2, "--exr-type", "float", "-q", "-o", exr)
    expected = pixels_of_exr(exr)
    assert expected.mean() > 0.01
    scene = alhazen.load(CORNELL)
    of_renderer = alhazen.Renderer(**SMALL).render(scene)
    *_, last = alhazen.progressive(scene, samples_per_pass=4, **SMALL)
    *_, last_of_file = alhazen.progressive(CORNELL, **SMALL)
    for image in (alhazen.render(CORNELL, **SMALL), alhazen.render(str(CORNELL), **SMALL),
                  alhazen.render(scene, **SMALL), of_renderer, last, last_of_file):
        np.testing.assert_array_equal(np.asarray(image), expected)
        assert image.complete


def test_settings_as_an_object_and_as_keywords():
    settings = alhazen.Settings(**SMALL, seed=7)
    image = alhazen.render(CORNELL, settings)
    np.testing.assert_array_equal(image, alhazen.render(CORNELL, seed=7, **SMALL))
    assert np.any(np.asarray(image) != np.asarray(alhazen.render(CORNELL, settings, seed=8)))
    assert settings.seed == 7


def test_settings_are_a_value():
    settings = alhazen.Settings(size=(640, 480), layers=["albedo"], look_at=((0, 1, 5), (0, 0, 0)), camera=2,
                                light_groups={"key": ["a*", "b"]}, definitions={"n": 3}, fov=np.float32(30))
    assert (settings.width, settings.height, settings.size) == (640, 480, (640, 480))
    assert settings.aovs == settings.layers == ("albedo",)
    assert settings.look_at == (0, 1, 5, 0, 0, 0)
    assert settings.camera == "2"
    assert settings.light_groups == ("key=a*,b",)
    assert settings.definitions == ("n=3",)
    assert settings.fov == 30 and settings.seed is None and settings.precision == "float"
    for other in (copy.copy(settings), copy.deepcopy(settings), pickle.loads(pickle.dumps(settings)),
                  eval(repr(settings)), alhazen.Settings(**settings.as_dict())):
        assert other == settings
    other = settings.replace(spp=9, fov=None)
    assert other != settings and other.samples_per_pixel == other.spp == 9 and other.fov is None
    assert repr(alhazen.Settings(spp=4)) == "alhazen.Settings(samples_per_pixel=4)"
    other.spp = 12
    assert other.samples_per_pixel == 12


@pytest.mark.parametrize("function", [lambda **k: alhazen.render(CORNELL, **k), alhazen.Settings, alhazen.Renderer,
                                      lambda **k: alhazen.progressive(CORNELL, **k)])
def test_unknown_keywords_are_type_errors_with_a_suggestion(function):
    with pytest.raises(TypeError, match="unexpected keyword argument 'max_deth'; did you mean 'max_depth'"):
        function(max_deth=3)
    with pytest.raises(TypeError, match="unexpected keyword argument 'xyzzyqq'$"):
        function(xyzzyqq=3)


@pytest.mark.parametrize("keywords, message", [
    (dict(spp="many"), "'spp'"), (dict(spp=-1), "'spp'"), (dict(spp=1.5), "'spp'"), (dict(width=True), "'width'"),
    (dict(fov=float("nan")), "'fov'"), (dict(fov="wide"), "'fov'"), (dict(confine=3), "'confine'"),
    (dict(layers="albedo"), "'layers'"), (dict(crop_window=(0, 1)), "'crop_window'"), (dict(seed=1 << 32), "'seed'"),
    (dict(size=(3, 0)), "'size'"), (dict(backend="abacus"), "backend"), (dict(layers=["smell"]), "smell"),
    (dict(noise=7), "noise"), (dict(look_at=(1, 2)), "look.at")])
def test_bad_settings_are_input_errors_that_name_them(keywords, message):
    with pytest.raises(alhazen.InputError, match=message):
        alhazen.render(CORNELL, **{**SMALL, **keywords})


def test_bad_arguments(tmp_path):
    with pytest.raises(alhazen.InputError, match="nothing.pbrt"):
        alhazen.render(tmp_path / "nothing.pbrt")
    with pytest.raises(alhazen.InputError, match="'scene'"):
        alhazen.render(3)
    with pytest.raises(alhazen.InputError, match="'progress'"):
        alhazen.render(CORNELL, progress=3)
    with pytest.raises(TypeError, match="settings"):
        alhazen.render(CORNELL, {"spp": 3})
    with pytest.raises(alhazen.InputError, match="call start first"):
        alhazen.Renderer().render_pass()
    with pytest.raises(alhazen.InputError, match="camera"):
        alhazen.render(alhazen.load(CORNELL), camera="front")


def each_render():
    scene = alhazen.load(CORNELL)
    return {"file": lambda **k: alhazen.render(CORNELL, **k), "scene": lambda **k: alhazen.render(scene, **k),
            "renderer": lambda progress, **k: alhazen.Renderer(**k).render(scene, progress)}


@pytest.mark.parametrize("of", ["file", "scene", "renderer"])
def test_progress_is_called_and_stops(of):
    seen = []

    def progress(state):
        if state.activity == "rendering":
            seen.append(state.fraction)
        return len(seen) < 3

    image = each_render()[of](progress=progress, **ENDLESS)
    assert not image.complete and len(seen) >= 3 and image.width == 200
    assert seen == sorted(seen)
    assert np.asarray(image).mean() > 0


def test_what_callbacks_return():
    calls = []
    for result in (None, True, 0, "", np.True_):
        calls.clear()
        image = alhazen.render(CORNELL, progress=lambda state: calls.append(state) or result, **SMALL)
        assert image.complete and calls[-1].fraction == 1, result
    image = alhazen.render(CORNELL, progress=lambda state: np.bool_(state.fraction == 0), **ENDLESS)
    assert not image.complete
    assert "100.0 %" in repr(calls[-1])


class Private(Exception):
    pass


@pytest.mark.parametrize("of", ["file", "scene", "renderer"])
def test_exceptions_of_progress_reach_the_caller(of):
    raised = Private("in the callback")

    def progress(state):
        raise raised

    start = time.perf_counter()
    with pytest.raises(Private) as caught:
        each_render()[of](progress=progress, **ENDLESS)
    assert caught.value is raised
    assert any(entry.name == "progress" for entry in caught.traceback)
    assert time.perf_counter() - start < 5


def test_after_pass_sees_the_image_and_stops():
    scene = alhazen.load(CORNELL)
    renderer = alhazen.Renderer(spp=4096, width=64, height=48)
    seen = []

    def after_pass(of):
        assert of is renderer
        seen.append((np.asarray(of.image()).mean(), of.progress.samples_done, of.warnings))
        with pytest.raises(alhazen.Error, match="in use"):
            of.render_pass()
        return len(seen) < 2

    image = renderer.render(scene, after_pass=after_pass)
    assert len(seen) == 2 and not image.complete
    assert seen[1][1] > seen[0][1] > 0

    def fails(of):
        raise Private()

    with pytest.raises(Private):
        renderer.render(scene, after_pass=fails)
    renderer.settings = alhazen.Settings(**SMALL)
    np.testing.assert_array_equal(renderer.render(scene), alhazen.render(scene, **SMALL))


def test_renderer_by_steps():
    scene = alhazen.load(CORNELL)
    renderer = alhazen.Renderer(**SMALL)
    report = renderer.start(scene)
    assert report.is_new and report.seconds > 0 and "built" in repr(report)
    assert renderer.render_pass(4) is True
    assert renderer.progress.fraction == 0.25
    snapshot = renderer.image()
    assert not snapshot.complete and snapshot.width == 40
    while renderer.render_pass():
        pass
    assert renderer.finish().complete
    with pytest.raises(alhazen.InputError, match="call start first"):
        renderer.finish()
    assert not renderer.start(scene).is_new
    renderer.stop()
    assert renderer.render_pass() is False
    assert renderer.finish().shape == (0, 0, 3)
    assert renderer.settings == alhazen.Settings(**SMALL)


def test_progressive_yields_better_and_better_images_until_break():
    reference = np.asarray(alhazen.render(CORNELL, spp=256, width=40, height=30, seed=3))
    errors = [np.square(np.asarray(image) - reference).mean()
              for image in alhazen.progressive(CORNELL, spp=64, width=40, height=30, samples_per_pass=8)]
    assert len(errors) == 9 or len(errors) == 8
    assert errors[0] > 2 * errors[-1]
    start = time.perf_counter()
    for image in alhazen.progressive(CORNELL, **ENDLESS):
        assert not image.complete
        break
    assert time.perf_counter() - start < 5


def test_break_saves_the_checkpoint(tmp_path):
    state = tmp_path / "state"
    for _ in alhazen.progressive(CORNELL, samples_per_pass=4, checkpoint=state, **SMALL):
        break
    assert state.stat().st_size > 0
    image = alhazen.render(CORNELL, checkpoint=state, resume=True, **SMALL)
    np.testing.assert_array_equal(image, alhazen.render(CORNELL, **SMALL))


INTERRUPTED = """
import sys, time, alhazen
kind, file = sys.argv[1:]
def ready(state):
    if state.fraction > 0: print("ready", flush=True)
options = dict(spp=1 << 20, width=300, height=300)
try:
    if kind == "file": alhazen.render(file, progress=ready, **options)
    if kind == "scene": alhazen.render(alhazen.load(file), progress=ready, **options)
    if kind == "plain":
        print("ready", flush=True)
        alhazen.render(file, **options)
    if kind == "renderer": alhazen.Renderer(**options).render(alhazen.load(file), ready)
    if kind == "pass":
        renderer = alhazen.Renderer(backend="serial", **options)
        renderer.start(alhazen.load(file), ready)
        while renderer.render_pass(): pass
    if kind == "progressive":
        for image in alhazen.progressive(file, progress=ready, **options): pass
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
if kind == "pass": print(renderer.finish().shape, flush=True)
"""


@pytest.mark.parametrize("kind", ["file", "scene", "plain", "renderer", "pass", "progressive"])
def test_control_c_ends_a_render(kind):
    process = start_python(INTERRUPTED, kind, CORNELL)
    try:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=20)
    finally:
        process.kill()
    line = next(line for line in output.splitlines() if line.startswith("interrupted"))
    assert process.returncode == 0 and not errors, errors
    # 0.2 seconds, and the time of a busy machine to run a thread.
    assert float(line.split()[1]) - sent < 0.5
    if kind == "pass":
        assert "(300, 300, 3)" in output


def test_a_signal_handler_that_does_not_raise_ends_nothing():
    handled = []
    before = signal.signal(signal.SIGUSR1, lambda *_: handled.append(threading.current_thread()))
    try:
        timer = threading.Timer(0.2, lambda: signal.pthread_kill(threading.main_thread().ident, signal.SIGUSR1))
        timer.start()
        while not handled:
            assert alhazen.render(CORNELL, spp=64, width=100, height=100).complete
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert handled == [threading.main_thread()]


def test_several_threads_render_at_once_and_others_run():
    expected = np.asarray(alhazen.render(CORNELL, **SMALL))
    scene = alhazen.load(CORNELL)
    images, steps, is_over = {}, [0], threading.Event()

    def count():
        while not is_over.is_set():
            steps[0] += 1
            time.sleep(0.001)

    def render(index):
        images[index] = alhazen.render(scene if index % 2 else CORNELL, progress=lambda state: None, **SMALL)

    counter = threading.Thread(target=count)
    counter.start()
    threads = [threading.Thread(target=render, args=(i,)) for i in range(6)]
    for thread in threads:
        thread.start()
    before = steps[0]
    alhazen.render(CORNELL, spp=256, width=100, height=100)
    during = steps[0] - before
    for thread in threads:
        thread.join()
    is_over.set()
    counter.join()
    assert during > 10
    assert len(images) == 6
    for image in images.values():
        np.testing.assert_array_equal(image, expected)


def test_a_renderer_is_used_by_one_thread_and_stopped_by_any():
    renderer = alhazen.Renderer(**ENDLESS)
    has_begun = threading.Event()
    images = []
    scene = alhazen.load(CORNELL)
    thread = threading.Thread(target=lambda: images.append(renderer.render(scene, lambda state: has_begun.set())))
    thread.start()
    has_begun.wait()
    for call in (lambda: renderer.start(scene), renderer.render_pass, renderer.image, renderer.finish,
                 lambda: renderer.progress, lambda: renderer.render(scene)):
        with pytest.raises(alhazen.Error, match="in use"):
            call()
    renderer.stop()
    thread.join()
    assert not images[0].complete


@pytest.mark.parametrize("call", [
    "alhazen.render(file, progress=lambda state: None, spp=1 << 20, width=300, height=300)",
    "list(alhazen.progressive(file, spp=1 << 20, width=300, height=300))",
    "renderer = alhazen.Renderer(spp=1 << 20); renderer.start(scene)\n    while renderer.render_pass(4): pass",
    "renderer = alhazen.Renderer(spp=1 << 20)\n    renderer.render(scene, after_pass=lambda r: r.image() is not None)",
    "renderer = alhazen.Renderer(spp=1 << 20)\n    renderer.render(scene, progress=lambda p: time.sleep(0.01))",
    "while True: alhazen.render(scene, spp=1, size=(32, 32))",
    "while True: alhazen.load(file)",
    "while True: scene.intersect(np.random.rand(10000, 3), (0, 0, 1))",
])
def test_the_interpreter_ends_while_daemon_threads_work(call):
    code = """
import sys, threading, time, alhazen
import numpy as np
file = sys.argv[1]
scene = alhazen.load(file)
def run():
    CALL
for _ in range(2): threading.Thread(target=run, daemon=True).start()
time.sleep(0.3)
print("end")
""".replace("CALL", call)
    for _ in range(4):
        process = start_python(code, CORNELL)
        output, errors = process.communicate(timeout=60)
        assert (process.returncode, output, errors) == (0, "end\n", "")


def test_forked_processes_render_and_trace_rays():
    process = start_python("""
import multiprocessing, sys, alhazen
import numpy as np
scene = alhazen.load(sys.argv[1])
rays = np.random.default_rng(1).random((10000, 3))
def work(_):
    return np.asarray(scene.intersect(rays, (0, 0, 1), threads=2).t), np.asarray(
        alhazen.render(scene, spp=4, size=(32, 32), threads=2))
here = work(0)
with multiprocessing.get_context("fork").Pool(2) as pool:
    for there in pool.map(work, range(4)):
        for a, b in zip(here, there): np.testing.assert_array_equal(a, b)
print("end")
""", CORNELL)
    output, errors = process.communicate(timeout=120)
    assert (process.returncode, output) == (0, "end\n"), errors


def scene_with_a_warning(folder):
    """The reader warns that it has no lights."""
    file = folder / "warns.pbrt"
    file.write_text('Camera "perspective"\nWorldBegin\nTranslate 0 0 5\nShape "sphere" "float radius" 1\n')
    return file


def test_warnings_of_the_library(tmp_path):
    file = scene_with_a_warning(tmp_path)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        image = alhazen.render(file, **SMALL)
        list(alhazen.progressive(file, samples_per_pass=4, **SMALL))
    assert len(image.warnings) == 1 and "no lights" in image.warnings[0]
    assert len(caught) == 2
    for warning in caught:
        assert warning.category is alhazen.AlhazenWarning and issubclass(warning.category, UserWarning)
        assert str(warning.message) in image.warnings
        assert warning.filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error", alhazen.AlhazenWarning)
        with pytest.raises(alhazen.AlhazenWarning):
            alhazen.render(file, **SMALL)


def test_a_thousand_renders_take_no_more_memory():
    """Peak memory after 1,000 renders is that after 200, but for what an allocator needs."""
    process = start_python("""
import resource, sys, alhazen
scene = alhazen.load(sys.argv[1])
peaks = []
renderer = alhazen.Renderer(spp=1, width=8, height=8, threads=1)
for i in range(1000):
    kind = i % 4
    options = dict(spp=1, width=8, height=8, threads=1, layers=["depth"], progress=lambda state: None)
    if kind == 0: image = alhazen.render(sys.argv[1], **options)
    if kind == 1: image = alhazen.render(scene, **options)
    if kind == 2: image = renderer.render(scene)
    if kind == 3:
        for image in alhazen.progressive(scene, **options): break
    image["R"], image.layers
    if i in (199, 999): peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
print(*peaks)
""", CORNELL)
    output, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    first, last = map(int, output.split())
    assert last - first < 4096, f"{first} KiB after 200, {last} KiB after 1000"
