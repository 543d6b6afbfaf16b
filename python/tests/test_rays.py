"""Ray queries: results, shapes, precision, errors."""

import threading

import numpy as np
import pytest

import alhazen
from common import CORNELL

#: A unit sphere at the origin, two triangles that make the square of z = -2, and a copy of a triangle at x = 10.
SCENE = """
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective"
WorldBegin
LightSource "distant"
Shape "sphere" "float radius" 1
Shape "trianglemesh" "point3 P" [-1 -1 -2  1 -1 -2  1 1 -2  -1 1 -2] "integer indices" [0 1 2  0 2 3]
ObjectBegin "thing"
Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  0 1 0] "integer indices" [0 1 2]
ObjectEnd
Translate 10 0 0
ObjectInstance "thing"
"""
DOWN = (0.0, 0.0, -1.0)


@pytest.fixture(scope="module")
def scene_file(tmp_path_factory):
    file = tmp_path_factory.mktemp("rays") / "scene.pbrt"
    file.write_text(SCENE)
    return file


@pytest.fixture(scope="module")
def queries(scene_file):
    return alhazen.RayQueries(scene_file)


def grid(count, dtype=np.float32):
    x = np.linspace(-1.5, 1.5, count, dtype=dtype)
    return np.stack(np.broadcast_arrays(x[None, :], x[:, None] * 0.9, dtype(5)), axis=-1)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_hits_are_those_of_geometry(scene_file, dtype):
    queries = alhazen.RayQueries(scene_file, precision="float" if dtype == np.float32 else "double")
    origins = grid(50, dtype).reshape(-1, 3)
    hits = queries.intersect(origins, np.array(DOWN, dtype))
    x, y = origins[:, 0], origins[:, 1]
    radius2 = x * x + y * y
    on_sphere, on_square = radius2 < 1, (radius2 >= 1) & (abs(x) <= 1) & (abs(y) <= 1)
    np.testing.assert_array_equal(hits.hit, on_sphere | on_square)
    expected = np.where(on_sphere, 5 - np.sqrt(np.maximum(1 - radius2, 0)), np.where(on_square, 7, np.inf))
    tolerance = 2e-4 if dtype == np.float32 else 1e-9
    np.testing.assert_allclose(hits.t, expected, rtol=tolerance)
    np.testing.assert_allclose(hits.position[on_sphere], hits.normal[on_sphere], atol=tolerance * 10)
    np.testing.assert_array_equal(hits.normal[on_square], np.broadcast_to((0, 0, 1), (on_square.sum(), 3)))
    np.testing.assert_allclose(hits.position[on_square][:, :2], origins[on_square][:, :2], atol=tolerance)
    assert set(hits.shape[on_sphere]) == {0} and set(hits.shape[on_square]) == {1}
    assert set(hits.primitive[on_square]) == {0, 1}
    missed = ~hits.hit
    for name in ("primitive", "shape", "instance"):
        assert np.all(getattr(hits, name)[missed] == alhazen.INVALID_ID), name
    for name in ("position", "normal", "shading_normal", "uv", "barycentric", "offset"):
        assert np.all(getattr(hits, name)[missed] == 0), name
    assert np.all(hits.offset[hits.hit] > 0)
    assert np.all(hits.instance == alhazen.INVALID_ID)
    occluded = queries.occluded(origins, np.array(DOWN, dtype))
    assert occluded.dtype == bool
    np.testing.assert_array_equal(occluded, hits.hit)


def test_shapes_and_dtypes(queries):
    for dtype in (np.float32, np.float64):
        hits = queries.intersect(grid(4, dtype), np.array(DOWN, dtype))
        assert hits.t.shape == hits.hit.shape == hits.primitive.shape == (4, 4)
        assert hits.position.shape == hits.normal.shape == (4, 4, 3) and hits.uv.shape == (4, 4, 2)
        assert hits.t.dtype == hits.normal.dtype == dtype and hits.primitive.dtype == hits.shape.dtype == np.uint32
        assert hits.fields == ("t", "position", "normal", "shading_normal", "offset", "uv", "barycentric", "primitive",
                               "shape", "instance")
    single = queries.intersect((10, 0, 5), DOWN)
    assert single.t.shape == () and single.position.shape == (3,) and single.t == 5 and single.instance == 0
    with pytest.raises(TypeError):
        len(single)
    assert queries.occluded((10, 0, 5), DOWN).shape == ()
    one_origin = queries.intersect((0, 0, 5), np.array([DOWN, (0, 0, 1), (0, 0, -2)]))
    np.testing.assert_allclose(one_origin.t, [4, np.inf, 2])
    assert len(one_origin) == 3 and repr(one_origin) == "<alhazen.Hits of 3 rays, 2 hit>"
    empty = queries.intersect(np.zeros((0, 3)), np.zeros((0, 3)))
    assert empty.t.shape == (0,) and empty.normal.shape == (0, 3)
    assert queries.occluded(np.zeros((0, 3)), DOWN).shape == (0,)
    np.testing.assert_allclose(queries.bounds, [(-1, -1, -2), (11, 1, 1)], atol=1e-5)
    assert queries.precision == "float" and queries.warnings == [] and "float" in repr(queries)


def test_arrays_are_read_wherever_they_are(queries):
    origins = grid(30).reshape(-1, 3)
    directions = np.broadcast_to(np.array(DOWN, np.float32), origins.shape)
    expected = queries.intersect(np.ascontiguousarray(origins), np.ascontiguousarray(directions))
    rows = np.zeros((len(origins), 8), np.float32)
    rows[:, 2:5] = origins
    for given in (rows[:, 2:5], np.asfortranarray(origins), origins[::-1][::-1], origins.tolist(),
                  origins.astype(">f4"), origins.astype(np.float64)):
        hits = queries.intersect(given, directions)
        np.testing.assert_array_equal(hits.t.astype(np.float32), expected.t)
        np.testing.assert_array_equal(hits.primitive, expected.primitive)
    every_other = queries.intersect(origins[::2], directions[::2])
    np.testing.assert_array_equal(every_other.t, expected.t[::2])
    backwards = queries.intersect(origins[::-1], directions[::-1])
    np.testing.assert_array_equal(backwards.t, expected.t[::-1])


def test_t_max_and_fields(queries):
    origins = np.zeros((3, 3), np.float32) + (0, 0, 5)
    np.testing.assert_array_equal(queries.occluded(origins, DOWN, [3, 4.5, np.inf]), [False, True, True])
    np.testing.assert_array_equal(queries.occluded(origins, DOWN, t_max=3.5), [False] * 3)
    hits = queries.intersect(origins, DOWN, 3.5, fields=["normal"])
    assert hits.fields == ("t", "normal") and not hits.hit.any()
    with pytest.raises(AttributeError, match="'uv' was not asked for"):
        hits.uv
    assert queries.intersect(origins, DOWN, fields=()).fields == ("t",)
    np.testing.assert_array_equal(queries.intersect(origins, DOWN, time=0.5, threads=1).t,
                                  queries.intersect(origins, DOWN).t)


@pytest.mark.parametrize("arguments, message", [
    (dict(origins=np.zeros((3, 2))), r"'origins' must have the shape \(n, 3\).*not \(3, 2\)"),
    (dict(directions=np.ones((4, 3))), r"'directions' must have the shape of 'origins'.*not \(4, 3\)"),
    (dict(origins=[[0, 0, np.nan]] * 3), "'origins' has a NaN at ray 0"),
    (dict(directions=[[0, 0, 1], [0, 0, 1], [0, np.inf, 1]]), "'directions' has an infinity at ray 2"),
    (dict(t_max=[1, np.nan, 1]), "'t_max' has a NaN at ray 1"),
    (dict(t_max=[1, 2]), r"'t_max' must be a number or have the shape \(3,\)"),
    (dict(time=np.nan), "'time' has a NaN"),
    (dict(origins="here"), "'origins' must be an array of numbers"),
    (dict(origins=np.zeros((3, 3), complex)), "'origins' must be an array of numbers"),
    (dict(fields=["smell"]), "'fields' must be some of t, position"),
    (dict(fields="t"), "'fields'"),
    (dict(threads=-1), "'threads'")])
def test_bad_arguments_are_named(queries, arguments, message):
    good = dict(origins=np.zeros((3, 3)), directions=np.ones((3, 3)))
    with pytest.raises(alhazen.InputError, match=message):
        queries.intersect(**{**good, **arguments})
    if "fields" not in arguments:
        with pytest.raises(alhazen.InputError, match=message):
            queries.occluded(**{**good, **arguments})


def test_nan_in_strided_arrays_is_found(queries):
    rows = np.zeros((5, 4), np.float32)
    rows[3, 1] = np.nan
    with pytest.raises(alhazen.InputError, match="'origins' has a NaN at ray 3"):
        queries.intersect(rows[:, :3], DOWN)
    assert queries.intersect(rows[:3, :3], DOWN).t.shape == (3,)


def test_rays_of_a_scene():
    scene = alhazen.load(CORNELL)
    of_file = {name: alhazen.RayQueries(CORNELL, precision=name) for name in ("float", "double")}
    of_scene = alhazen.RayQueries(scene)
    low, high = of_scene.bounds
    random = np.random.default_rng(1)
    directions = random.normal(size=(200, 3))
    origins = random.uniform(low, high, size=(200, 3))
    for dtype, precision in ((np.float32, "float"), (np.float64, "double")):
        rays = origins.astype(dtype), directions.astype(dtype)
        expected = of_file[precision].intersect(*rays)
        np.testing.assert_array_equal(scene.intersect(*rays).position, expected.position)
        np.testing.assert_array_equal(scene.occluded(*rays), expected.hit)
    wide = scene.intersect(origins, directions, precision="float")
    np.testing.assert_array_equal(wide.t, of_file["float"].intersect(origins, directions).t)
    np.testing.assert_array_equal(of_scene.intersect(origins, directions).t, wide.t)
    with pytest.raises(alhazen.InputError, match="'precision'"):
        scene.intersect(origins, directions, precision="half")
    with pytest.raises(alhazen.InputError, match="'scene'"):
        alhazen.RayQueries(7)
    with pytest.raises(TypeError, match="did you mean 'precision'"):
        alhazen.RayQueries(scene, precison="double")


def test_rays_that_leave_a_surface_do_not_hit_it(queries):
    hits = queries.intersect(grid(40).reshape(-1, 3), np.array(DOWN, np.float32))
    hit = hits.hit & (hits.shape == 0)
    starts = hits.position[hit] + hits.offset[hit][:, None] * hits.normal[hit]
    assert not queries.occluded(starts, hits.normal[hit]).any()


def test_several_threads_ask_at_once(queries):
    origins = grid(300).reshape(-1, 3)
    expected = queries.intersect(origins, np.array(DOWN, np.float32)).t
    results = [None] * 4

    def ask(index):
        for _ in range(3):
            results[index] = queries.intersect(origins, np.array(DOWN, np.float32), threads=1).t

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results:
        np.testing.assert_array_equal(result, expected)


def test_results_outlive_everything(scene_file):
    t = alhazen.RayQueries(scene_file).intersect(grid(20), np.array(DOWN, np.float32)).t
    np.testing.assert_array_equal(t, alhazen.RayQueries(scene_file).intersect(grid(20), np.array(DOWN, np.float32)).t)
