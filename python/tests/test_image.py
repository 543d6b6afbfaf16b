"""Images: arrays without copies, layers, files."""

import gc
import pickle
import weakref

import numpy as np
import pytest

import alhazen
from common import CORNELL, run_program

SMALL = dict(spp=4, width=24, height=16, threads=2)
LAYERS = ["albedo", "normal", "depth", "uv", "cryptomatte"]


@pytest.fixture(scope="module")
def image():
    return alhazen.render(CORNELL, layers=LAYERS, **SMALL)


def test_arrays(image):
    assert (image.width, image.height, image.shape) == (24, 16, (16, 24, 3))
    assert image.channels[:3] == ("R", "G", "B") and "albedo.R" in image.channels and "depth.Z" in image.channels
    assert {"albedo", "normal", "depth", "uv"} <= set(image.layers) and "" not in image.layers
    pixels = np.asarray(image)
    assert pixels.shape == (16, 24, 3) and pixels.dtype == np.float32
    for index, name in enumerate("RGB"):
        np.testing.assert_array_equal(pixels[..., index], image[name])
    assert image.layer("albedo").shape == image.layer("normal").shape == (16, 24, 3)
    for index, name in enumerate("XYZ"):
        np.testing.assert_array_equal(image.layer("normal")[..., index], image["normal." + name])
    assert image.layer("depth").shape == image["R"].shape == (16, 24)
    np.testing.assert_array_equal(image["depth"], image["depth.Z"])
    assert image.layer("uv").shape == (16, 24, 2)
    normal = image.layer("normal")
    assert np.linalg.norm(normal, axis=2).max() == pytest.approx(1, abs=1e-3)
    assert 0 <= image.layer("albedo").min() and image.layer("albedo").max() <= 1


def test_the_orientation_and_the_channels_are_those_of_the_program(image, tmp_path):
    exr = tmp_path / "program.exr"
    run_program("render", CORNELL, "--spp", 4, "--size", "24x16", "--exr-type", "float", "-q", "-o", exr,
                "--aov", ",".join(LAYERS))
    other = alhazen.read_image(exr)
    assert set(other.channels) == set(image.channels)
    for channel in image.channels:
        np.testing.assert_array_equal(other[channel], image[channel], err_msg=channel)
    for layer in image.layers:
        np.testing.assert_array_equal(other.layer(layer), image.layer(layer), err_msg=layer)


def test_arrays_are_views_where_planes_allow_it(image):
    assert np.shares_memory(image["R"], image["R"])
    assert np.shares_memory(image.layer("depth"), image["depth.Z"])
    assert np.shares_memory(np.asarray(image), np.asarray(image))
    assert np.shares_memory(image.layer("albedo"), image.layer("albedo"))
    copy = np.array(image)
    assert not np.shares_memory(copy, np.asarray(image)) and copy.flags.writeable
    for array in (np.asarray(image), image["G"], image.layer("normal"), image.layer("depth")):
        assert not array.flags.writeable and array.flags.c_contiguous
        with pytest.raises(ValueError):
            array[0] = 1


def test_conversions(image):
    assert np.asarray(image, dtype=np.float64).dtype == np.float64
    assert np.array(image, dtype="float16").dtype == np.float16
    np.testing.assert_array_equal(image.__array__(np.float32), image)
    assert not np.shares_memory(image.__array__(copy=True), np.asarray(image))
    assert np.shares_memory(image.__array__(copy=False), np.asarray(image))
    with pytest.raises(ValueError, match="needs a copy"):
        image.__array__(np.float64, copy=False)
    assert (np.asarray(image) * 2 + image).shape == (16, 24, 3)


def test_arrays_outlive_the_image():
    made = alhazen.render(CORNELL, layers=["albedo", "depth"], **SMALL)
    expected = {name: np.array(made[name]) for name in ("R", "albedo", "depth")}
    expected["pixels"] = np.array(made)
    arrays = {name: made[name] for name in ("R", "albedo", "depth")}
    arrays["pixels"] = np.asarray(made)
    del made
    gc.collect()
    waste = [alhazen.render(CORNELL, **SMALL) for _ in range(5)]
    for name, array in arrays.items():
        np.testing.assert_array_equal(array, expected[name])
    assert waste


def test_images_are_freed():
    made = alhazen.render(CORNELL, layers=["albedo"], **SMALL)
    made.layer("albedo"), np.asarray(made)
    array = made["R"]
    reference = weakref.ref(array.base) if hasattr(array.base, "__weakref__") else None
    del made, array
    gc.collect()
    assert reference is None or reference() is None


def test_names(image):
    assert "R" in image and "albedo" in image and "albedo.G" in image and "smell" not in image
    with pytest.raises(KeyError, match="no layer 'smell': the layers are .*albedo"):
        image["smell"]
    with pytest.raises(KeyError, match="name them in 'layers'"):
        alhazen.render(CORNELL, **SMALL).layer("albedo")
    with pytest.raises(TypeError):
        iter(image)


def test_alpha():
    transparent = alhazen.render(CORNELL, transparent_background=True, **SMALL)
    assert transparent.shape == (16, 24, 4) and transparent.channels == ("R", "G", "B", "A")
    np.testing.assert_array_equal(np.asarray(transparent)[..., 3], transparent["A"])
    assert transparent._repr_png_()[25] == 6  # the color type of RGB with alpha


def test_properties(image):
    assert image.complete and image.noise is None and image.denoiser is None and image.quality is None
    assert image.warnings == () and image.samples == 4 and image.seconds > 0
    assert image.metadata["samples"] == "4" and "cornell" in image.metadata["scene"]
    assert repr(image).startswith("<alhazen.RenderedImage 24 x 16, R G B, layers albedo, normal, ")
    noisy = alhazen.render(CORNELL, noise=0.2, spp=256, width=24, height=16)
    assert 0 < noisy.noise.noise < 1 and 0 < noisy.noise.below <= 1 and 0 < noisy.noise.mean_samples <= 256
    denoised = alhazen.render(CORNELL, denoiser="builtin", **SMALL)
    assert denoised.denoiser == "builtin" and "denoised by builtin" in repr(denoised)


def test_saved_files_are_those_of_the_program(image, tmp_path):
    run_program("render", CORNELL, "--spp", 4, "--size", "24x16", "-q", "-o", tmp_path / "program.png", "--exposure",
                "1.5", "--tone-map", "agx", "--aov", ",".join(LAYERS), "-o", tmp_path / "program.pfm")
    image.save(tmp_path / "here.png", exposure=1.5, tone_map="agx")
    image.save(str(tmp_path / "here.pfm"))
    for extension in ("png", "pfm"):
        np.testing.assert_array_equal(alhazen.read_image(tmp_path / f"here.{extension}"),
                                      alhazen.read_image(tmp_path / f"program.{extension}"))


def test_every_format(image, tmp_path):
    for extension in ("exr", "png", "jpg", "hdr", "pfm"):
        file = tmp_path / f"image.{extension}"
        image.save(file)
        read = alhazen.read_image(file)
        assert (read.width, read.height) == (24, 16)
        pixels = np.clip(image, 0, 1) if extension in ("png", "jpg") else np.asarray(image)
        assert np.abs(np.asarray(read) - pixels).mean() < 0.02, extension
    image.save(tmp_path / "float.exr", exr_type="float")
    read = alhazen.read_image(tmp_path / "float.exr")
    for channel in image.channels:
        np.testing.assert_array_equal(read[channel], image[channel], err_msg=channel)
    image.save(tmp_path / "deep.png", png_depth=16, white_balance=4000)
    assert alhazen.read_image(tmp_path / "deep.png").shape == (16, 24, 3)


def test_failed_saves_change_nothing(image, tmp_path):
    file = tmp_path / "there.png"
    file.write_bytes(b"old")
    with pytest.raises(FileExistsError):
        image.save(file, overwrite=False)
    for arguments, error in ((dict(tone_map="sepia"), "'tone_map'"), (dict(exposure="bright"), "'exposure'"),
                             (dict(exposure=float("inf")), "exposure"), (dict(png_depth=9), "png_depth"),
                             (dict(white_balance=3), "white_temperature"), (dict(exr_type="double"), "'exr_type'")):
        with pytest.raises(alhazen.InputError, match=error):
            image.save(file, **arguments)
    assert file.read_bytes() == b"old"
    with pytest.raises(alhazen.InputError, match="image.gif"):
        image.save(tmp_path / "image.gif")
    with pytest.raises(alhazen.Error, match="cannot write"):
        image.save(tmp_path / "no" / "folder.png")
    with pytest.raises(alhazen.InputError, match="'file'"):
        image.save(3)
    image.save(file, overwrite=True)
    assert alhazen.read_image(file).width == 24


def test_notebooks_show_what_the_program_writes(image, tmp_path):
    (tmp_path / "shown.png").write_bytes(image._repr_png_())
    image.save(tmp_path / "saved.png")
    assert (tmp_path / "shown.png").read_bytes() == (tmp_path / "saved.png").read_bytes()


def test_an_image_without_samples():
    empty = alhazen.render(CORNELL, progress=lambda state: False, time_limit=1e-9, **SMALL)
    if empty.width == 0:
        assert np.asarray(empty).shape == (0, 0, 3) and empty._repr_png_() is None and not empty.complete
        with pytest.raises(alhazen.InputError, match="no pixels"):
            empty.save("/nowhere.png")


def test_images_of_arrays(tmp_path):
    ramp = np.linspace(0, 1, 5 * 7 * 3, dtype=np.float32).reshape(5, 7, 3)
    made = alhazen.RenderedImage(ramp)
    np.testing.assert_array_equal(made, ramp)
    np.testing.assert_array_equal(alhazen.RenderedImage(ramp.astype(np.float64)[::-1, ::-1]), ramp[::-1, ::-1])
    assert alhazen.RenderedImage(np.zeros((2, 3, 4))).channels == ("R", "G", "B", "A")
    grey = alhazen.RenderedImage(ramp[..., 0])
    assert grey.channels == ("Y",) and np.asarray(grey).shape == (5, 7)
    made.save(tmp_path / "ramp.pfm")
    np.testing.assert_array_equal(alhazen.read_image(tmp_path / "ramp.pfm"), ramp)
    for bad in (np.zeros((2, 3, 2)), np.zeros(3), np.zeros((2, 2, 3), dtype=np.uint8), np.zeros((2, 2), complex), 7):
        with pytest.raises(alhazen.InputError, match="'pixels'"):
            alhazen.RenderedImage(bad)


def test_images_are_pickled(image):
    other = pickle.loads(pickle.dumps(image))
    assert other.channels == image.channels and repr(other) == repr(image)
    assert (other.metadata, other.samples, other.seconds) == (image.metadata, image.samples, image.seconds)
    for channel in image.channels:
        np.testing.assert_array_equal(other[channel], image[channel])


def test_files_that_are_no_images(tmp_path):
    with pytest.raises(alhazen.InputError, match="nothing.exr"):
        alhazen.read_image(tmp_path / "nothing.exr")
    (tmp_path / "text.png").write_text("no image")
    with pytest.raises(alhazen.InputError, match="text.png"):
        alhazen.read_image(tmp_path / "text.png")


def test_png_in_memory_is_the_file(tmp_path):
    image = alhazen.RenderedImage(np.linspace(0, 1.5, 6 * 8 * 3, dtype=np.float32).reshape(6, 8, 3))
    for options in ({}, dict(exposure=-1, tone_map="filmic"), dict(png_depth=16)):
        image.save(tmp_path / "image.png", **options)
        assert image.png(**options) == (tmp_path / "image.png").read_bytes()
    with pytest.raises(alhazen.InputError, match="png_depth"):
        image.png(png_depth=7)


@pytest.mark.parametrize("extension", ["png", "pfm", "hdr", "exr"])
def test_arrays_of_one_channel_are_saved_as_grey(tmp_path, extension):
    grey = np.linspace(0, 1, 6 * 8, dtype=np.float32).reshape(6, 8)
    image = alhazen.RenderedImage(grey)
    image.save(tmp_path / f"grey.{extension}")
    read = np.asarray(alhazen.read_image(tmp_path / f"grey.{extension}"))
    assert read.shape == ((6, 8) if extension == "exr" else (6, 8, 3))
    np.testing.assert_allclose(read if extension == "exr" else read[..., 1], grey, atol=0.01)
    assert image._repr_png_() == image.png() and len(image.png()) > 50
