"""Scenes from Python: built, read, changed, copied."""

import copy
import gc
import pydoc
import subprocess
import sys
import time

import numpy as np
import pytest

import alhazen

TRIANGLE = alhazen.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], name="triangle")

MATERIALS = [alhazen.Diffuse, alhazen.Conductor, alhazen.Dielectric, alhazen.ThinDielectric, alhazen.CoatedDiffuse,
             alhazen.CoatedConductor, alhazen.DiffuseTransmission, alhazen.Principled]
TEXTURES = [alhazen.ConstantTexture, alhazen.CheckerboardTexture, alhazen.FbmTexture, alhazen.WrinkledTexture,
            alhazen.MarbleTexture, alhazen.WindyTexture, alhazen.CellularTexture, alhazen.ScaleTexture,
            alhazen.MixTexture, alhazen.ChannelTexture, alhazen.ThresholdTexture, alhazen.VertexColorTexture,
            alhazen.VertexAlphaTexture, alhazen.CoordinatesTexture, alhazen.DotsTexture, alhazen.DirectionMixTexture]
LIGHTS = [alhazen.PointLight, alhazen.SpotLight, alhazen.DistantLight, alhazen.ConstantInfiniteLight]
IMAGE_LIGHTS = [alhazen.GoniometricLight, alhazen.ProjectionLight, alhazen.EnvironmentLight]


def test_import_is_quick():
    code = ("import numpy, time; start = time.process_time(); import alhazen; "
            "print(time.process_time() - start)")
    times = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout)
             for _ in range(5)]
    assert min(times) < 0.1


def test_version_and_names():
    assert alhazen.__version__.count(".") == 2
    for name in alhazen.__all__:
        assert getattr(alhazen, name) is not None
    assert alhazen.Scene.__module__ == alhazen.load.__module__ == "alhazen"


def test_everything_has_a_docstring_with_types_of_python():
    def undocumented(owner, path):
        for name, member in vars(owner).items():
            if name.startswith("_") or name in ("VertexColourTexture",):
                continue
            if not getattr(member, "__doc__", None):
                yield f"{path}.{name}"
            elif "::" in member.__doc__ or "<alhazen" in member.__doc__:
                yield f"{path}.{name} shows C++: {member.__doc__}"
            if isinstance(member, type) and not issubclass(member, BaseException):
                yield from undocumented(member, f"{path}.{name}")

    shown = {name: getattr(alhazen, name) for name in alhazen.__all__ if not name.startswith("_")}
    owner = type("Namespace", (), {"__doc__": "", **shown})
    assert list(undocumented(owner, "alhazen")) == []


@pytest.mark.parametrize("kind", MATERIALS + TEXTURES + LIGHTS)
def test_values_come_back_as_they_were(kind):
    scene = alhazen.Scene()
    value = kind(name="it")
    part = scene.add(value)
    if kind in (alhazen.Conductor, alhazen.CoatedConductor):  # without eta and k it is copper, which has them
        value = value.replace(eta=part.eta, k=part.k)
    assert part.value == value and type(part.value) is kind
    assert part.name == "it" and kind.__name__ in repr(part)
    assert repr(kind(name="it")) == f"alhazen.{kind.__name__}(name='it')"
    assert "name" in dir(part)


@pytest.mark.parametrize("kind", IMAGE_LIGHTS)
def test_lights_with_images(kind):
    scene = alhazen.Scene()
    pixels = np.linspace(0, 1, 8 * 8 * 3, dtype=np.float32).reshape(8, 8, 3)
    light = scene.add(kind(name="it"), image=pixels)
    if kind is not alhazen.GoniometricLight:
        assert np.array_equal(light.image, pixels)
    assert light.value == kind(name="it")
    light.image = pixels[::-1]
    assert light.image.shape == (8, 8, 3)
    with pytest.raises(alhazen.InputError):
        scene.add(kind())
    with pytest.raises(alhazen.InputError, match="'image'"):
        scene.add(alhazen.PointLight(), image=pixels)


def test_every_attribute_can_be_set_and_read():
    samples = {"float": 0.25, "bool": True, "int": 1, "str": "text", "color": (0.1, 0.2, 0.3),
               "tuple[float, float]": (2.0, 3.0), "tuple[float, float, float]": (0.0, 0.6, 0.8)}
    count = 0
    for kind in MATERIALS + TEXTURES + LIGHTS + [alhazen.Mapping, alhazen.Roughness, alhazen.Disk, alhazen.Film]:
        for name, attribute in vars(kind).items():
            if not isinstance(attribute, property):
                continue
            typename = attribute.__doc__.split(":")[0].split(" |")[0]
            value = kind()
            if typename not in samples or name in ("eta", "k", "cone_angle"):  # these depend on others
                continue
            sample = not getattr(value, name) if typename == "bool" else samples[typename]
            if typename == "str" and name != "name":
                continue
            setattr(value, name, sample)
            assert getattr(value, name) == sample, (kind, name)
            assert value != kind() and name in repr(value)
            count += 1
    assert count > 100


def test_nested_textures_are_added_with_the_material():
    scene = alhazen.Scene()
    pixels = np.full((2, 2, 3), 128, np.uint8)
    checks = alhazen.CheckerboardTexture(even=alhazen.ImageTexture(pixels, name="tiles"), odd=(0, 0, 1),
                                         mapping=alhazen.Mapping(scale=(4, 4)), name="checks")
    scene.add(alhazen.Sphere(), material=alhazen.Principled(base_color=checks, roughness=0.3, name="floor"))
    assert scene.textures.names() == ["tiles", "checks"] and len(scene.images) == 1
    floor = scene.materials["floor"]
    assert floor.base_color == scene.textures["checks"]
    assert floor.base_color.mapping.scale == (4, 4) and floor.base_color.even == scene.textures["tiles"]
    assert np.array_equal(scene.textures["tiles"].image.pixels, pixels)
    floor.roughness = 0.5
    assert floor.base_color == scene.textures["checks"] and len(scene.textures) == 2
    floor.base_color = (1, 0, 0)
    assert floor.base_color == (1, 0, 0)
    scene.textures["checks"].even = 0.25
    assert scene.textures["checks"].even == (0.25, 0.25, 0.25)


def test_anisotropic_roughness_and_metals():
    scene = alhazen.Scene()
    gold = scene.add(alhazen.Conductor.of("gold", roughness=(alhazen.Roughness(0.1, 0.3)), name="gold"))
    assert gold.roughness == alhazen.Roughness(0.1, 0.3) and gold.eta[0] < 0.5 < gold.eta[2]
    gold.roughness = 0.2
    assert gold.roughness == 0.2
    gold.roughness = alhazen.ConstantTexture(0.4)
    assert gold.roughness == scene.textures[0]
    gold.eta = alhazen.ConstantTexture((0.2, 0.4, 1.3))
    assert gold.eta == scene.textures[1] and gold.k[0] > 1


def test_mixes():
    scene = alhazen.Scene()
    red = scene.add(alhazen.Diffuse((1, 0, 0)))
    mix = scene.add(alhazen.Mix((red, alhazen.Conductor(name="metal")), amount=0.25))
    assert mix.materials == (red, scene.materials["metal"]) and mix.amount == 0.25
    with pytest.raises(alhazen.InputError, match="'materials'"):
        scene.add(alhazen.Mix())


def test_both_spellings():
    material = alhazen.Principled(base_colour=(0.1, 0.2, 0.3))
    assert material.base_color == material.base_colour == (0.1, 0.2, 0.3)
    material.sheen_colour = 0.5
    part = alhazen.Scene().add(material)
    part.base_colour = 0
    assert part.base_color == part.base_colour == (0, 0, 0) and part.sheen_color == (0.5, 0.5, 0.5)
    assert alhazen.VertexColourTexture is alhazen.VertexColorTexture


def test_shapes():
    scene = alhazen.Scene()
    clay = scene.add(alhazen.Diffuse(0.6, name="clay"))
    ball = scene.add(alhazen.Sphere(0.5), material=clay, transform=alhazen.Transform.translate((1, 2, 3)), name="ball")
    assert ball.geometry == alhazen.Sphere(0.5) and ball.material == clay and ball.name == "ball"
    assert ball.emission is None and ball.group is None and ball.scene is scene
    assert np.array_equal(ball.transform, [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
    assert scene.bounds.low == (0.5, 1.5, 2.5) and np.asarray(scene.bounds).shape == (2, 3)
    ball.transform = np.diag([2, 2, 2, 1])
    assert scene.bounds.high == (1, 1, 1) and not ball.is_moving
    ball.end_transform = alhazen.Transform.translate((1, 0, 0))
    assert ball.is_moving and ball.transform[0, 0] == 2 and ball.end_transform[0, 3] == 1
    ball.material = alhazen.Principled(name="paint")
    assert ball.material.name == "paint" and len(scene.materials) == 2
    ball.material = "clay"
    assert ball.material == clay
    ball.material = None
    assert ball.material is None
    ball.emission = (1, 2, 3)
    assert ball.emission == alhazen.Emission((1, 2, 3))
    ball.emission = ball.emission.replace(two_sided=True, texture=alhazen.FbmTexture(name="fire"))
    assert ball.emission.two_sided and ball.emission.texture == scene.textures["fire"]
    ball.emission = None
    ball.geometry = alhazen.Disk(2)
    ball.name, ball.reverse_orientation = "disk", True
    assert scene.shapes["disk"] == ball and ball.geometry.radius == 2 and ball.reverse_orientation
    ball.geometry = TRIANGLE
    assert ball.geometry == scene.meshes["triangle"]
    ball.remove()
    assert len(scene.shapes) == 0


def test_one_mesh_of_many_shapes():
    scene = alhazen.Scene()
    mesh = scene.add_mesh(TRIANGLE)
    for i in range(5):
        scene.add(mesh, transform=alhazen.Transform.translate((i, 0, 0)), name=f"copy {i}")
    assert len(scene.meshes) == 1 and len(scene.shapes) == 5 and scene.bounds.high == (5, 1, 0)


def test_groups_and_instances():
    scene = alhazen.Scene()
    tree = scene.add_group("tree")
    trunk = tree.add(alhazen.Cylinder(0.2, 0, 2), material=alhazen.Diffuse(0.3), name="trunk")
    assert trunk.group == tree and tree.shapes == [trunk] and scene.bounds.is_empty
    places = [scene.add(tree, transform=alhazen.Transform.translate((3 * i, 0, 0)), name=f"tree {i}") for i in range(3)]
    assert len(scene.instances) == 3 and scene.instances["tree 2"] == places[2] and places[0].group == tree
    places[2].transform = alhazen.Transform.translate((10, 0, 0))
    assert scene.bounds.high[0] == pytest.approx(10.2)
    places[2].remove()
    assert len(scene.instances) == 2 and scene.bounds.high[0] == pytest.approx(3.2)


def test_lists_of_parts():
    scene = alhazen.Scene()
    for name in ("a", "b", "b"):
        scene.add(alhazen.Sphere(), name=name)
    shapes = scene.shapes
    assert len(shapes) == 3 and shapes[-1] == list(shapes)[2] and shapes.names() == ["a", "b", "b"]
    assert "a" in shapes and "c" not in shapes and shapes[1] in shapes and 5 not in shapes
    assert shapes.find("b") == [shapes[1], shapes[2]] and shapes.get("c") is None and shapes.get("c", 7) == 7
    assert list(reversed(shapes)) == list(shapes)[::-1] and "3 shapes" in repr(shapes)
    with pytest.raises(KeyError, match="no shape is called 'c': there are 'a', 'b', 'b'"):
        shapes["c"]
    with pytest.raises(KeyError, match="2 shapes are called 'b'"):
        shapes["b"]
    with pytest.raises(IndexError):
        shapes[3]
    with pytest.raises(TypeError):
        shapes[0.5]
    for shape in shapes:  # removing while iterating
        shape.remove()
    assert len(shapes) == 0 and not list(shapes)


def test_camera_writes_back():
    scene = alhazen.Scene()
    scene.add(alhazen.Sphere())
    scene.camera.look_at(origin=(0, 0, 5), target=(0, 0, 0))
    scene.camera.fov = 30
    scene.camera.aperture = 0.1
    assert scene.camera.fov == 30 and scene.camera.aperture == 0.1
    assert np.allclose(scene.camera.transform[:3, 3], (0, 0, 5))
    assert np.allclose(scene.camera.transform[:3, 2], (0, 0, -1))
    scene.camera.look_at((0, 0, 7), (0, 0, 0), up=(1, 0, 0))
    assert scene.camera.focus == pytest.approx(7)
    scene.camera.orbit(90, 0, distance=4)
    assert np.allclose(np.abs(scene.camera.transform[:3, 3]), (4, 0, 0), atol=1e-9)
    scene.camera.fit()
    before = scene.camera.value
    scene.camera = alhazen.Camera(kind="orthographic", screen_window=(-1, 1, -2, 2))
    assert scene.camera.kind == "orthographic" and scene.camera.screen_window == (-1, 1, -2, 2)
    with pytest.raises(alhazen.InputError):
        scene.camera.fit()
    scene.camera = before
    assert scene.camera.value == before
    other = alhazen.Scene()
    other.camera = scene.camera
    assert other.camera.value == before
    with pytest.raises(alhazen.InputError, match="'camera' must be a Camera"):
        scene.camera = 3
    with pytest.raises(TypeError):
        scene.camera.look_at((0, 0, 0))


def test_film_filter_and_defaults():
    scene = alhazen.Scene()
    scene.film.width, scene.film.height = 320, 200
    scene.film.pixel_bounds = (10, 20, 30, 40)
    assert scene.film.value == alhazen.Film(width=320, height=200, pixel_bounds=(10, 20, 30, 40))
    scene.pixel_filter = alhazen.PixelFilter("box", x_radius=0.5, y_radius=0.5)
    assert scene.pixel_filter.kind == "box"
    scene.defaults.samples_per_pixel, scene.defaults.integrator = 16, "iterative"
    assert scene.defaults.samples_per_pixel == 16 and scene.defaults.integrator == "iterative"
    scene.up = (0, 0, 1)
    assert scene.up == (0, 0, 1)


def test_environment(tmp_path):
    scene = alhazen.Scene()
    assert scene.environment is None
    scene.environment = (0.1, 0.2, 0.3)
    assert scene.environment.radiance == (0.1, 0.2, 0.3)
    for grey in (0.5, 2, np.float32(0.5), np.array([1, 2, 3.0])):
        scene.environment = grey
        assert len(scene.lights) == 1
    sky = np.random.default_rng(3).random((8, 16, 3)).astype(np.float32)
    scene.environment = sky
    assert np.array_equal(scene.environment.image, sky) and len(scene.lights) == 1
    scene.environment.scale = 2
    assert scene.environment.scale == (2, 2, 2)
    pfm = tmp_path / "sky.pfm"
    pfm.write_bytes(b"PF\n16 8\n-1.0\n" + sky[::-1].astype("<f4").tobytes())
    scene.environment = pfm
    assert np.array_equal(scene.environment.image, sky)
    with pytest.raises(alhazen.InputError, match="image"):
        scene.environment = sky[:5]
    scene.environment = None
    assert len(scene.lights) == 0


def test_copies_share_nothing():
    scene = alhazen.Scene()
    ball = scene.add(alhazen.Sphere(), material=alhazen.Diffuse(0.5, name="clay"))
    for other in (copy.copy(scene), copy.deepcopy(scene), scene.copy()):
        other.materials["clay"].reflectance = 0.1
        other.add(alhazen.Sphere())
        assert scene.materials["clay"].reflectance == (0.5, 0.5, 0.5) and len(scene.shapes) == 1
        assert other.shapes[0] != ball and len(other.shapes) == 2
        other.add(alhazen.Sphere(), material=scene.materials["clay"])  # a part that both have
        assert other.shapes[2].material == other.materials["clay"]
    value = alhazen.Principled(roughness=0.2)
    twin = copy.copy(value)
    twin.roughness = 0.7
    assert value.roughness == 0.2 and copy.deepcopy(value) == value != twin


def test_parts_keep_their_scene():
    shape = alhazen.Scene().add(alhazen.Sphere(2), material=alhazen.Diffuse(name="clay"))
    gc.collect()
    assert shape.material.name == "clay" and shape.scene.bounds.high == (2, 2, 2)
    camera = alhazen.Scene().camera
    gc.collect()
    assert camera.fov > 0


def test_parts_are_keys():
    scene = alhazen.Scene()
    clay = scene.add(alhazen.Diffuse(name="clay"))
    assert {clay: 1}[scene.materials["clay"]] == 1 and clay == scene.materials[0]
    assert clay != scene.add(alhazen.Diffuse()) and clay != scene.add(alhazen.Sphere()) and clay != "clay"


def test_changing_the_kind():
    scene = alhazen.Scene()
    part = scene.add(alhazen.Principled(name="thing"))
    part.value = alhazen.Diffuse(0.25, name="thing")
    assert part.reflectance == (0.25, 0.25, 0.25)
    with pytest.raises(AttributeError, match="this Diffuse has no attribute 'metallic'"):
        part.metallic
    with pytest.raises(alhazen.InputError, match="'value' must be a material"):
        part.value = alhazen.PointLight()
    part.name = "other"
    assert scene.materials["other"] == part and part.value.name == "other"


def test_transforms():
    move, turn = alhazen.Transform.translate((1, 2, 3)), alhazen.Transform.rotate(90, (0, 0, 1))
    assert (move @ turn).point((1, 0, 0)) == pytest.approx((1, 3, 3))
    assert (move @ turn).direction((1, 0, 0)) == pytest.approx((0, 1, 0))
    assert np.allclose(np.asarray(move @ turn), move.matrix @ turn.matrix)
    assert np.allclose((move @ move.inverse()).matrix, np.eye(4)) and move == alhazen.Transform(move.matrix)
    assert np.allclose((np.eye(4) @ move).matrix, move.matrix)
    assert alhazen.Transform.scale(2) == alhazen.Transform.scale((2, 2, 2)) != alhazen.Transform()
    with pytest.raises(ValueError):
        move.matrix[0, 0] = 5
    assert alhazen.Transform(np.eye(4)[:3]) == alhazen.Transform(np.eye(4).tolist()) == alhazen.Transform()


def test_loading(tmp_path):
    file = tmp_path / "scene.pbrt"
    file.write_text("""
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 64 "integer yresolution" 48
WorldBegin
LightSource "point" "spectrum I" "stdillum-D65" "point3 from" [ 0 3 0 ]
MakeNamedMaterial "clay" "string type" "diffuse" "rgb reflectance" [ 0.8 0.3 0.2 ]
NamedMaterial "clay"
Shape "sphere"
""")
    scene = alhazen.load(file)
    assert scene.file == str(file) and scene.warnings == [] and scene.camera.fov == 40
    assert (scene.film.width, scene.film.height) == (64, 48)
    clay = scene.materials["clay"]
    assert clay.reflectance == pytest.approx((0.8, 0.3, 0.2), abs=0.01)
    clay.reflectance = (0, 0, 1)
    assert scene.shapes[0].material.reflectance == (0, 0, 1)
    assert "1 shape, 1 material, 1 light" in repr(scene)


def test_options_of_loading(tmp_path):
    file = tmp_path / "scene.xml"
    file.write_text("""<scene version="3.0.0"><default name="size" value="1"/>
<shape type="sphere"><float name="radius" value="$size"/></shape></scene>""")
    for definitions in ({"size": 3}, ["size=3"]):
        assert alhazen.load(str(file), definitions=definitions).bounds.high == pytest.approx((3, 3, 3))
    with pytest.raises(alhazen.InputError, match="'confine' must be True or False"):
        alhazen.load(file, confine=1)
    with pytest.raises(TypeError):
        alhazen.load(file, definition={})


def test_help_is_there():
    text = pydoc.plain(pydoc.render_doc(alhazen))
    for name in ("class Scene", "class Principled", "load(", "base_color"):
        assert name in text


def test_many_parts_are_quick():
    scene = alhazen.Scene()
    start = time.perf_counter()
    for i in range(2000):
        scene.add(alhazen.Sphere(0.1), transform=np.eye(4), material=None)
    assert time.perf_counter() - start < 5 and len(scene.shapes) == 2000
