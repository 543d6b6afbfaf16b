"""What bad input raises, and that nothing ends the process."""

import copy
import pickle
import threading

import numpy as np
import pytest

import alhazen


def test_classes():
    assert issubclass(alhazen.Error, RuntimeError)
    assert issubclass(alhazen.InputError, alhazen.Error) and issubclass(alhazen.InputError, ValueError)
    assert issubclass(alhazen.MissingFileError, alhazen.InputError)
    assert issubclass(alhazen.MissingFileError, FileNotFoundError)
    for kind in (alhazen.UnsupportedError, alhazen.OutOfMemoryError, alhazen.DeviceError, alhazen.Cancelled):
        assert issubclass(kind, alhazen.Error)
    assert issubclass(alhazen.OutOfMemoryError, MemoryError)
    assert alhazen.InputError.__module__ == "alhazen" and alhazen.InputError("text").file is None


def test_missing_files(tmp_path):
    with pytest.raises(FileNotFoundError) as caught:
        alhazen.load(tmp_path / "none.glb")
    error = caught.value
    assert isinstance(error, alhazen.InputError) and error.file == str(tmp_path / "none.glb")
    assert str(error).startswith(error.file) and "Errno" not in str(error)
    with pytest.raises(FileNotFoundError):
        alhazen.Scene().add(alhazen.Image(str(tmp_path / "none.png")))
    with pytest.raises(FileNotFoundError):
        alhazen.Scene().environment = str(tmp_path / "none.exr")


def test_place_in_a_file(tmp_path):
    file = tmp_path / "wrong.pbrt"
    file.write_text('WorldBegin\nShape "sphere"\n  "float radius" [ "wide" ]\n')
    with pytest.raises(alhazen.InputError) as caught:
        alhazen.load(str(file))
    error = caught.value
    assert not isinstance(error, FileNotFoundError)
    assert (error.file, error.line) == (str(file), 3) and error.column > 1
    assert str(error).startswith(f"{file}:3:{error.column}: ")


def test_names_that_are_no_text(tmp_path):
    folder = str(tmp_path).encode() + b"/\xff\xfe.ply"
    with pytest.raises(alhazen.InputError):
        alhazen.load(folder)
    for bad in ("", "a\0b", 3, None, object()):
        with pytest.raises(alhazen.InputError, match="'file' must"):
            alhazen.load(bad)


@pytest.mark.parametrize("make, message", [
    (lambda: alhazen.Principled(ior=-1), "'ior' must be"),
    (lambda: alhazen.Principled(roughness="rough"), "'roughness' must be a number, a color or a texture"),
    (lambda: alhazen.Principled(roughness=True), "'roughness' must be a number, not True"),
    (lambda: alhazen.Principled(roughness=np.ones(3)), "'roughness' must be a number, not an array"),
    (lambda: alhazen.Principled(base_color=(1, 2)), "'base_color' must be a color"),
    (lambda: alhazen.Principled(base_color=(1, 2, "3")), "'base_color' must be a number, not '3'"),
    (lambda: alhazen.Principled(base_color=float("nan")), "'base_color'"),
    (lambda: alhazen.Principled(thin=1), "'thin' must be True or False, not 1"),
    (lambda: alhazen.Principled(name=b"x"), "'name' must be a str"),
    (lambda: alhazen.Principled(base_color="wood.png"), "alhazen.ImageTexture(image)"),
    (lambda: alhazen.Principled(normal_map=3), "'normal_map' must be a texture or None, not 3"),
    (lambda: alhazen.Diffuse(reflectance=1 + 2j), "'reflectance' must be a number"),
    (lambda: alhazen.Conductor.of("tin"), "'metal' must be one of 'silver', 'aluminium'"),
    (lambda: alhazen.ImageTexture("x.png", wrap="mirrored"), "'wrap' must be one of 'repeat'"),
    (lambda: alhazen.ChannelTexture(0.5, 3), "'channel'"),
    (lambda: alhazen.FbmTexture(octaves=1.5), "'octaves' must be an int, not 1.5"),
    (lambda: alhazen.FbmTexture(octaves=10**30), "'octaves' must be from"),
    (lambda: alhazen.Mix((alhazen.Diffuse(),)), "'materials' must be two materials"),
    (lambda: alhazen.Sphere(0), "'radius' must be finite and over 0"),
    (lambda: alhazen.Cylinder(1, 2, 1), "'z_min' must be under 'z_max'"),
    (lambda: alhazen.SpotLight(cone_angle=200), "'cone_angle'"),
    (lambda: alhazen.DistantLight(direction=(0, 0, 0)), "'direction' must have a length over 0"),
    (lambda: alhazen.PointLight(intensity=-1), "'intensity'"),
    (lambda: alhazen.Camera(fov=180), "'fov' must be over 0 and under 180"),
    (lambda: alhazen.Camera(aperture=-1), "'aperture' must be"),
    (lambda: alhazen.Camera(focus=0), "'focus' must be"),
    (lambda: alhazen.Camera(kind="fisheye"), "'kind' must be one of 'perspective'"),
    (lambda: alhazen.Camera(screen_window=(1, 1, 0, 1)), "'screen_window' has no area"),
    (lambda: alhazen.Film(width=0), "'width' must be from 1"),
    (lambda: alhazen.Transform(np.zeros((4, 4))), "'matrix' must have the last row"),
    (lambda: alhazen.Transform(np.diag([0, 1, 1, 1])), "'matrix' makes a matrix that cannot be inverted"),
    (lambda: alhazen.Transform(np.eye(3)), "'matrix' must be a Transform or a matrix of the shape (4, 4)"),
    (lambda: alhazen.Transform.scale((1, 0, 1)), "'factors'"),
    (lambda: alhazen.Transform.rotate(10, (0, 0, 0)), "'axis'"),
    (lambda: alhazen.Transform.look_at((0, 0, 0), (0, 1, 0)), "'up'"),
])
def test_values_are_checked_at_once(make, message):
    with pytest.raises(alhazen.InputError) as caught:
        make()
    assert message in str(caught.value)


def test_unknown_names():
    with pytest.raises(TypeError, match="Principled has no 'bas_color'; it has base_color"):
        alhazen.Principled(bas_color=1)
    with pytest.raises(AttributeError, match="'Principled' has no attribute 'bas_color'"):
        alhazen.Principled().bas_color
    with pytest.raises(AttributeError, match="'Principled' has no attribute 'bas_color'"):
        alhazen.Principled().bas_color = 1
    with pytest.raises(TypeError, match="at most 1 arguments by position"):
        alhazen.Diffuse(0.5, 0.5)
    with pytest.raises(TypeError, match="'radius' twice"):
        alhazen.Sphere(1, radius=2)
    with pytest.raises(TypeError, match="has no argument 'materiel'"):
        alhazen.Scene().add(alhazen.Sphere(), materiel=None)
    scene = alhazen.Scene()
    with pytest.raises(AttributeError):
        scene.camra = 1
    with pytest.raises(AttributeError, match="has no attribute 'fow'"):
        scene.camera.fow = 1


def test_a_value_that_is_refused_stays_as_it_was():
    material = alhazen.Principled(ior=1.4)
    with pytest.raises(alhazen.InputError):
        material.ior = -1
    assert material.ior == 1.4
    scene = alhazen.Scene()
    part = scene.add(material)
    with pytest.raises(alhazen.InputError):
        part.ior = -1
    with pytest.raises(alhazen.InputError):
        part.base_color = "red"
    assert part.ior == 1.4 and len(scene.materials) == 1


def test_copies_within_values_are_frozen():
    roughness = alhazen.Roughness(0.1, 0.2)
    metal = alhazen.Conductor(roughness=roughness)
    with pytest.raises(AttributeError, match="replace"):
        metal.roughness.u = 0.3
    roughness.u = 0.9
    assert metal.roughness.u == 0.1
    metal.roughness = metal.roughness.replace(u=0.3)
    assert (metal.roughness.u, metal.roughness.v) == (0.3, 0.2)


def test_textures_cannot_contain_themselves():
    a, b = alhazen.MixTexture(), alhazen.MixTexture()
    a.at_0 = b
    b.at_0 = a
    a.at_0 = a
    alhazen.Scene().add(a)
    scene = alhazen.Scene()
    part = scene.add(alhazen.MixTexture())
    with pytest.raises(alhazen.InputError):
        part.at_0 = part
    mix = scene.add(alhazen.Mix((alhazen.Diffuse(), alhazen.Diffuse())))
    with pytest.raises(alhazen.InputError):
        mix.materials = (mix, mix)


def test_parts_of_other_scenes_are_refused():
    one, other = alhazen.Scene(), alhazen.Scene()
    other.add(alhazen.Diffuse())
    material = one.add(alhazen.Diffuse())
    with pytest.raises(alhazen.InputError, match="another scene"):
        other.add(alhazen.Sphere(), material=material)
    assert len(other.shapes) == 0
    mesh = one.add_mesh(alhazen.Mesh(np.eye(3), [[0, 1, 2]]))
    with pytest.raises(alhazen.InputError, match="another scene"):
        other.add(mesh)


def test_removed_parts():
    scene = alhazen.Scene()
    shape, light = scene.add(alhazen.Sphere()), scene.add(alhazen.PointLight())
    group = scene.add_group()
    group.add(alhazen.Sphere())
    instance = scene.add(group)
    for part in (shape, light, instance):
        part.remove()
        assert "removed" in repr(part)
        with pytest.raises(alhazen.InputError, match="removed"):
            part.remove()
        with pytest.raises(alhazen.InputError, match="removed"):
            part.name
        assert len({part, part}) == 1 and part == part
    with pytest.raises(alhazen.InputError, match="removed"):
        shape.material = alhazen.Diffuse()
    assert len(scene.materials) == 0
    with pytest.raises(alhazen.InputError, match="removed"):
        light.intensity = 3


@pytest.mark.parametrize("thing", [
    lambda scene: scene, lambda scene: scene.shapes[0], lambda scene: scene.materials, lambda scene: scene.camera,
    lambda scene: scene.materials[0], lambda scene: alhazen.Principled(), lambda scene: alhazen.Transform(),
    lambda scene: alhazen.Mesh(np.eye(3), [[0, 1, 2]]),
])
def test_nothing_is_pickled(thing):
    scene = alhazen.Scene()
    scene.add(alhazen.Sphere(), material=alhazen.Diffuse())
    with pytest.raises(TypeError, match="pickle"):
        pickle.dumps(thing(scene))


def test_parts_cannot_be_deep_copied():
    scene = alhazen.Scene()
    with pytest.raises(TypeError):
        copy.deepcopy(scene.add(alhazen.Sphere()))


def test_what_objects_raise_themselves_comes_through():
    class Hostile:
        def __float__(self):
            raise KeyError("mine")

        def __repr__(self):
            raise KeyError("mine, too")

    with pytest.raises(alhazen.InputError, match="'ior' must be .* Hostile"):
        alhazen.Dielectric(ior=Hostile())

    class Interrupting:
        def __array__(self, *_):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        alhazen.Mesh(Interrupting(), [[0, 1, 2]])


def test_classes_cannot_be_left_half_made():
    class Mine(alhazen.Scene):
        def __init__(self):
            pass

    with pytest.raises(TypeError):
        Mine()
    for name in ("SceneShape", "SceneMaterial", "SceneCamera", "Live", "Value", "Material", "Box"):
        with pytest.raises(TypeError):
            getattr(alhazen, name)()


def test_loading_lets_other_threads_run(tmp_path):
    vertices = np.random.default_rng(0).random((60000, 3))
    file = tmp_path / "many.obj"
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {i} {i + 1} {i + 2}" for i in range(1, 59000)]
    file.write_text("\n".join(lines))
    scenes = []
    thread = threading.Thread(target=lambda: scenes.append(alhazen.load(file)))
    thread.start()
    turns = 0
    while thread.is_alive():
        turns += 1
    thread.join()
    assert turns > 100 and len(scenes[0].meshes) == 1


def test_a_backend_that_is_not_there_is_unsupported():
    missing = [b for b in alhazen.devices().backends if not b.available]
    if not missing:
        pytest.skip("this machine has all backends")
    scene = alhazen.Scene()
    scene.add(alhazen.Sphere(1))
    with pytest.raises(alhazen.UnsupportedError):
        alhazen.render(scene, spp=1, width=4, height=4, backend=missing[0].name)


JUNK = [None, True, -1, 0, 3, 10**400, 0.5, float("nan"), float("inf"), -1e308, 1 + 2j, "", "box", "\udcff", "a\0b",
        b"\xff", (), [], {}, set(), (1, 2, 3), (1, 2), [[1]], (None,) * 3, range(3), np.float32(2), np.int64(-5),
        np.array(3.0), np.zeros(3), np.zeros((4, 4)), np.eye(4), np.full((4, 4), np.nan), np.array("x"),
        np.array([None] * 3),
        object(), int, lambda: 0, np.ma.masked, slice(3), memoryview(b"abc"), alhazen.Transform(), alhazen.Diffuse(),
        alhazen.FbmTexture(), alhazen.PointLight(), alhazen.Sphere(), alhazen.Mapping(), alhazen.Roughness(0.1, 0.2),
        alhazen.Emission(), alhazen.Scene(), alhazen.Image(np.ones((2, 2)))]


def all_values():
    for name in alhazen.__all__:
        kind = getattr(alhazen, name)
        if isinstance(kind, type) and issubclass(kind, alhazen.Value) and kind.__init__ is not alhazen.Value.__init__:
            try:
                yield kind()
            except TypeError:
                pass  # a base


def test_attributes_take_or_refuse_anything():
    taken = refused = 0
    for value in list(all_values()):
        for name in [name for name, member in vars(type(value)).items() if isinstance(member, property)]:
            for junk in JUNK:
                before = getattr(value, name)
                try:
                    setattr(value, name, junk)
                except alhazen.InputError as error:
                    assert str(error), (value, name, junk)
                    after = getattr(value, name)
                    assert type(after) is type(before) and repr(after) == repr(before)
                    refused += 1
                else:
                    taken += 1
                    repr(value), copy.copy(value) == value
    assert taken > 500 and refused > 3000


def test_scenes_take_or_refuse_anything():
    expected = (alhazen.InputError, TypeError)
    for junk in JUNK:
        scene = alhazen.Scene()
        shape, group = scene.add(alhazen.Sphere(), material=alhazen.Diffuse()), scene.add_group("g")
        group.add(alhazen.Sphere())
        instance, light = scene.add(group), scene.add(alhazen.PointLight())
        mesh = scene.add_mesh(alhazen.Mesh(np.eye(3), [[0, 1, 2]]))
        calls = [lambda: scene.add(junk), lambda: scene.add_mesh(junk), lambda: scene.add_group(junk),
                 lambda: group.add(junk), lambda: scene.add(group, transform=junk), lambda: alhazen.Transform(junk),
                 lambda: scene.add(alhazen.EnvironmentLight(), image=junk), lambda: scene.camera.look_at(junk, junk),
                 lambda: scene.camera.orbit(junk, junk, junk), lambda: mesh.set_vertices(junk, junk),
                 lambda: mesh.replace(junk), lambda: scene.shapes.find(junk), lambda: alhazen.Image(junk),
                 lambda: alhazen.Transform.rotate(junk, junk), lambda: alhazen.Transform() @ junk]
        for part, names in ((shape, "geometry material transform end_transform emission reverse_orientation name"),
                            (instance, "group transform end_transform reverse_orientation name"),
                            (light, "position intensity value name image"), (mesh, "vertices"),
                            (scene, "camera film pixel_filter defaults up environment"),
                            (scene.camera, "fov transform kind screen_window value"),
                            (scene.film, "width pixel_bounds")):
            calls += [lambda part=part, name=name: setattr(part, name, junk) for name in names.split()]
        for call in calls:
            try:
                call()
            except expected as error:
                assert str(error)
        repr(scene), [repr(part) for parts in (scene.shapes, scene.materials, scene.lights) for part in parts]
        scene.bounds, scene.camera.value


@pytest.mark.parametrize("protocol", [0, 1])
def test_old_protocols_of_pickle_are_refused(protocol):
    for thing in (alhazen.Transform(), alhazen.Scene(), alhazen.Settings()):
        with pytest.raises(TypeError):
            pickle.dumps(thing, protocol)
    with pytest.raises(TypeError, match="no instances of its own"):
        alhazen.Scene.__mro__[1]()


def test_a_file_is_missing_only_where_that_is_what_is_wrong(tmp_path):
    image = alhazen.render(alhazen.Scene(), spp=1, size=(8, 8))
    with pytest.raises(alhazen.InputError) as caught:
        image.save(tmp_path / "x.gif")
    assert not isinstance(caught.value, FileNotFoundError)
    with pytest.raises(alhazen.InputError) as caught:
        alhazen.compare(image, image, layer="none of it")
    assert not isinstance(caught.value, FileNotFoundError)
    with pytest.raises(FileNotFoundError):
        alhazen.load(tmp_path / "absent.glb")
