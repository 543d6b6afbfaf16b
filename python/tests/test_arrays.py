"""Arrays that meshes and images are made of: what is taken, what is refused, and what comes back."""

import gc

import numpy as np
import pytest

import alhazen

SQUARE = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], np.float32)
FACES = np.array([[0, 2, 1], [0, 3, 2]], np.uint32)


def test_contiguous_arrays_are_held_without_a_copy():
    for dtype in (np.float32, np.float64):
        vertices = SQUARE.astype(dtype)
        mesh = alhazen.Mesh(vertices, FACES)
        assert np.shares_memory(mesh.vertices, vertices)
        assert np.shares_memory(mesh.faces, FACES)
    pixels = np.zeros((4, 5, 3), np.uint8)
    assert np.shares_memory(alhazen.Image(pixels).pixels, pixels)


def test_scenes_copy_what_they_are_given():
    vertices = SQUARE.copy()
    mesh = alhazen.Scene().add_mesh(alhazen.Mesh(vertices, FACES))
    vertices[:] = 7
    assert np.array_equal(mesh.vertices, SQUARE)


@pytest.mark.parametrize("convert", [
    lambda a: a.tolist(),
    lambda a: a.astype(a.dtype.newbyteorder()),
    lambda a: np.asfortranarray(a),
    lambda a: np.repeat(a, 2, axis=0)[::2],
    lambda a: a[::-1][::-1],
    lambda a: a[::-1].copy()[::-1],
    lambda a: np.lib.stride_tricks.as_strided(np.pad(a, ((0, 0), (0, 2))), a.shape, (a.itemsize * 5, a.itemsize)),
    lambda a: np.frombuffer(b"?" + a.tobytes(), a.dtype, offset=1).reshape(a.shape),
    lambda a: np.asmatrix(a),
])
def test_other_layouts_are_converted(convert):
    scene = alhazen.Scene()
    mesh = scene.add_mesh(alhazen.Mesh(convert(SQUARE), convert(FACES)))
    assert np.array_equal(mesh.vertices, SQUARE)
    assert np.array_equal(mesh.faces, FACES)


@pytest.mark.parametrize("dtype", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", ">i4", ">u8"])
def test_faces_of_every_integer(dtype):
    mesh = alhazen.Scene().add_mesh(alhazen.Mesh(SQUARE, FACES.astype(dtype)))
    assert mesh.faces.dtype == np.uint32 and np.array_equal(mesh.faces, FACES)


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", "g", ">f4", "i2", "u8"])
def test_vertices_of_every_real_number(dtype):
    vertices = np.abs(SQUARE).astype(dtype)
    assert np.array_equal(alhazen.Scene().add_mesh(alhazen.Mesh(vertices, FACES)).vertices, np.abs(SQUARE))


def test_read_only_arrays_are_taken():
    vertices, faces, pixels = SQUARE.copy(), FACES.copy(), np.ones((2, 2), np.float32)
    for array in (vertices, faces, pixels):
        array.setflags(write=False)
    alhazen.Mesh(vertices, faces)
    alhazen.Image(pixels)


BAD_MESHES = [
    (dict(faces=FACES[0:1].ravel()[:4]), "'faces' must have shape (m, 3), not (3,)"),
    (dict(faces=np.zeros((2, 4), int)), "'faces' must have shape (m, 3), not (2, 4)"),
    (dict(faces=np.zeros(())), "'faces' must have shape (m, 3), not ()"),
    (dict(faces=np.zeros((0, 3), int)), "'faces' must not be empty"),
    (dict(faces=FACES.astype(float)), "'faces' must hold integers, not float64"),
    (dict(faces=FACES.astype(bool)), "'faces' must hold integers, not bool"),
    (dict(faces=np.array([[0, 1, -1]])), "'faces' holds -1: indices count from 0"),
    (dict(faces=[[0, 1, 4]]), "'faces' holds 4, but there are only 4 vertices"),
    (dict(faces=np.array([[0, 1, 2**32]])), "'faces' holds 4294967296, but there are only 4 vertices"),
    (dict(faces=np.array([[0, 1, 2**64 - 1]], np.uint64)), "'faces' holds 18446744073709551615, but"),
    (dict(faces=[[0, 1, 2**70]]), "'faces' must hold integers, not object"),
    (dict(faces="triangles"), "'faces' must have shape (m, 3), not ()"),
    (dict(faces=None), "'faces' must have shape"),
    (dict(vertices=SQUARE.T), "'vertices' must have shape (n, 3), not (3, 4)"),
    (dict(vertices=SQUARE.astype(complex)), "'vertices' must hold real numbers, not complex128"),
    (dict(vertices=SQUARE.astype(object)), "'vertices' must hold real numbers, not object"),
    (dict(vertices=SQUARE.astype(str)), "'vertices' must hold real numbers, not <U"),
    (dict(vertices=SQUARE.astype(bool)), "'vertices' must hold real numbers, not bool"),
    (dict(vertices=SQUARE.astype("datetime64[s]")), "'vertices' must hold real numbers"),
    (dict(vertices=np.zeros(4, [("x", float)])), "'vertices' must have shape"),
    (dict(vertices=np.where(SQUARE == 1, np.nan, SQUARE)), "'vertices' holds a value that is infinite or not a number, "
                                                          "in row 1"),
    (dict(vertices=np.full((4, 3), 1e400)), "'vertices' holds a value that is infinite"),
    (dict(vertices=np.zeros((0, 3))), "'vertices' must not be empty"),
    (dict(vertices=[[0, 1], [1, 2, 3]]), "'vertices' must"),
    (dict(vertices=np.broadcast_to(np.float32(0), (2**33, 3))), "'vertices' must have fewer than 2^32 rows"),
    (dict(normals=SQUARE[:3]), "'normals' must have a row for each of the 4 vertices, not 3"),
    (dict(uvs=SQUARE), "'uvs' must have shape (n, 2), not (4, 3)"),
    (dict(second_uvs=np.zeros((4, 1))), "'second_uvs' must have shape (n, 2), not (4, 1)"),
    (dict(colors=np.zeros((4, 2))), "'colors' must have shape (n, 3) or (n, 4), not (4, 2)"),
    (dict(tangents=np.full((4, 4), np.inf)), "'tangents' holds a value that is infinite"),
    (dict(name=3), "'name' must be a str, not 3"),
]


@pytest.mark.parametrize("change, message", BAD_MESHES)
def test_bad_arrays_are_refused_by_name(change, message):
    with pytest.raises(alhazen.InputError) as caught:
        alhazen.Mesh(**{"vertices": SQUARE, "faces": FACES, **change})
    assert message in str(caught.value)


def test_changes_after_the_check_are_seen():
    vertices, faces = SQUARE.copy(), FACES.copy()
    mesh, scene = alhazen.Mesh(vertices, faces), alhazen.Scene()
    faces[0, 0] = 99
    with pytest.raises(alhazen.InputError, match="'faces' holds 99"):
        scene.add_mesh(mesh)
    faces[0, 0] = 0
    vertices[2, 1] = np.nan
    with pytest.raises(alhazen.InputError, match="'vertices' holds"):
        scene.add_mesh(mesh)
    assert len(scene.meshes) == 0


def test_reading_back():
    rng = np.random.default_rng(1)
    normals, uvs, colors = rng.normal(size=(4, 3)), rng.random((4, 2)), rng.random((4, 4))
    tangents = np.hstack([normals, np.ones((4, 1))])
    given = alhazen.Mesh(SQUARE, FACES, normals, uvs, uvs + 1, colors, tangents, name="square")
    mesh = alhazen.Scene().add_mesh(given)
    assert mesh.name == "square"
    for name, value in dict(normals=normals, uvs=uvs, second_uvs=uvs + 1, colors=colors, tangents=tangents).items():
        back = getattr(mesh, name)
        assert back.dtype == np.float32 and not back.flags.writeable
        assert np.array_equal(back, value.astype(np.float32))
    three = alhazen.Scene().add_mesh(alhazen.Mesh(SQUARE, FACES, colors=colors[:, :3]))
    assert np.array_equal(three.colors[:, 3], np.ones(4)) and three.normals is None


def test_what_was_read_outlives_scene_and_changes():
    scene = alhazen.Scene()
    mesh = scene.add_mesh(alhazen.Mesh(SQUARE, FACES))
    before, faces = mesh.vertices, mesh.faces
    mesh.replace(alhazen.Mesh(SQUARE[:3] + 1, [[0, 1, 2]]))
    assert len(mesh.vertices) == 3
    del scene, mesh
    gc.collect()
    assert np.array_equal(before, SQUARE) and np.array_equal(faces, FACES)
    with pytest.raises(ValueError):
        before[0] = 1


def test_moving_vertices():
    mesh = alhazen.Scene().add_mesh(alhazen.Mesh(SQUARE, FACES))
    mesh.vertices = 2 * SQUARE
    assert np.array_equal(mesh.vertices, 2 * SQUARE)
    mesh.set_vertices(SQUARE, normals=np.tile([0, 1, 0], (4, 1)))
    assert np.array_equal(mesh.normals, np.tile([0, 1, 0], (4, 1)))
    with pytest.raises(alhazen.InputError, match="'vertices' must have a row for each of the 4 vertices, not 3"):
        mesh.vertices = SQUARE[:3]
    with pytest.raises(AttributeError):
        mesh.faces = FACES


def test_objects_with_vertices_and_faces():
    class Trimesh:
        vertices, faces = SQUARE.astype(float), FACES.astype(np.int64)

    scene = alhazen.Scene()
    scene.add(Trimesh(), material=alhazen.Diffuse(0.5))
    assert np.array_equal(scene.meshes[0].vertices, SQUARE)


@pytest.mark.parametrize("shape", [(3, 4), (3, 4, 1), (3, 4, 3), (3, 4, 4)])
@pytest.mark.parametrize("dtype", ["u1", "f2", "f4", "f8"])
def test_images(shape, dtype):
    pixels = np.random.default_rng(2).integers(0, 255, shape).astype(dtype)
    image = alhazen.Scene().add(alhazen.Image(pixels, name="noise"))
    expected = pixels[..., 0] if shape[2:] == (1,) else pixels[..., :3] if shape[2:] == (4,) else pixels
    assert image.name == "noise" and np.array_equal(image.pixels, expected)
    assert image.encoding == ("srgb" if dtype == "u1" else "linear")


def test_alpha_and_encoding_of_images():
    pixels = np.arange(2 * 3 * 4, dtype=np.uint8).reshape(2, 3, 4)
    scene = alhazen.Scene()
    alpha = scene.add(alhazen.Image(pixels, takes_alpha=True))
    assert np.array_equal(alpha.pixels, pixels[..., 3]) and alpha.encoding == "linear"
    data = scene.add(alhazen.Image(pixels[..., :3], encoding="linear"))
    assert data.encoding == "linear"
    data.pixels = 255 - pixels[..., :3]
    assert data.encoding == "linear" and np.array_equal(data.pixels, 255 - pixels[..., :3])


@pytest.mark.parametrize("pixels, message", [
    (np.zeros((2, 2, 2)), "'pixels' must have shape (h, w), (h, w, 3) or (h, w, 4), not (2, 2, 2)"),
    (np.zeros(4), "'pixels' must have shape"),
    (np.zeros((0, 4)), "'pixels' must not be empty"),
    (np.zeros((2, 2), int), "'pixels' must be of uint8 or of floats, not int64"),
    (np.zeros((2, 2), bool), "not bool"),
    (np.zeros((2, 2), complex), "not complex128"),
    (np.array([[1, np.nan]]), "'pixels' holds a value that is infinite"),
    (np.array([[1e300]]), "'pixels' holds a value that is infinite"),
    (np.broadcast_to(np.uint8(0), (2**20, 2**20)), "'pixels' must have at most 2^30 pixels"),
    (None, "'pixels' must"),
    (5, "'pixels' must have shape"),
])
def test_bad_images_are_refused(pixels, message):
    with pytest.raises(alhazen.InputError) as caught:
        alhazen.Image(pixels)
    assert message in str(caught.value)


def random_array(rng):
    """An array that is rarely right: any shape, dtype, layout and values."""
    dtype = rng.choice(["f2", "f4", "f8", "g", "i1", "i4", "i8", "u1", "u4", "u8", ">f4", ">i4", "?", "c8", "O", "U3",
                        "S2", "M8[s]", "f4,i4"])
    shape = tuple(rng.choice([0, 1, 2, 3, 4, 5], size=rng.choice([0, 1, 2, 2, 2, 2, 2, 3, 4])))
    if rng.random() < 0.6:
        shape = (int(rng.integers(0, 6)), int(rng.choice([2, 3, 3, 3, 4])))
    values = rng.integers(0, 6, shape)
    array = np.zeros(shape, dtype) if dtype in ("M8[s]", "f4,i4") else np.asarray(values).astype(dtype)
    if array.size and array.dtype.kind in "fc" and rng.random() < 0.2:
        array.flat[int(rng.integers(array.size))] = rng.choice([np.nan, np.inf, -np.inf, 1e30])
    if array.size and array.dtype.kind in "i" and rng.random() < 0.2:
        array.flat[int(rng.integers(array.size))] = rng.choice([-1, 100])
    layout = rng.integers(6)
    if layout == 1:
        array = np.asfortranarray(array)
    elif layout == 2 and array.ndim:
        array = array[::-1]
    elif layout == 3 and array.ndim:
        array = np.repeat(array, 2, axis=-1)[..., ::2]
    elif layout == 4:
        array = np.broadcast_to(array, (2,) + array.shape)[0]
    elif layout == 5:
        array.setflags(write=False)
    return np.asarray(array).tolist() if rng.random() < 0.1 else array


def test_a_thousand_random_arrays():
    """Each is taken, and then gives the same values back, or is refused by name. None ends the process."""
    rng = np.random.default_rng(20)
    taken = refused = 0
    for _ in range(1000):
        arguments = {"vertices": random_array(rng) if rng.random() < 0.7 else SQUARE,
                     "faces": random_array(rng) if rng.random() < 0.5 else FACES}
        for name in ("normals", "uvs", "colors", "tangents"):
            if rng.random() < 0.2:
                arguments[name] = random_array(rng)
        scene = alhazen.Scene()
        try:
            mesh = scene.add_mesh(alhazen.Mesh(**arguments))
        except alhazen.InputError as error:
            assert any(str(error).startswith(f"'{name}' ") for name in arguments), error
            assert len(scene.meshes) == 0
            refused += 1
            continue
        taken += 1
        assert np.array_equal(mesh.vertices, np.asarray(arguments["vertices"]).astype(float))
        assert np.array_equal(mesh.faces, np.asarray(arguments["faces"]).astype(int))
    assert taken > 30 and refused > 500


def test_a_thousand_random_images():
    rng = np.random.default_rng(21)
    taken = 0
    for _ in range(1000):
        array = random_array(rng)
        try:
            image = alhazen.Scene().add(alhazen.Image(array))
        except alhazen.InputError as error:
            assert str(error).startswith("'pixels' "), error
            continue
        taken += 1
        assert image.pixels.shape[:2] == np.shape(array)[:2]
    assert taken > 30
