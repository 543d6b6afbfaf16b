"""Builds the wheel of the Python module for pip: the backend of PEP 517 that pyproject.toml names.

It runs CMake, for the interpreter that runs pip, and needs nothing but the standard library. The environment:

- CMAKE_ARGS: further options for CMake, as -DALHAZEN_INSTRUCTION_SETS=all; those of here come first.
- CMAKE_BUILD_PARALLEL_LEVEL: how many compilers run at once (default: one for each processor).
- ALHAZEN_PREBUILT: a build folder that has the module and the library already; nothing is compiled then.

The build stays in build/pip-*, and the next one compiles what has changed since.
"""

import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
from io import BytesIO
from pathlib import Path

from wheel_file import SOURCE, NAME, VERSION, Wheel, fail, metadata

SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")
# What a wheel has; modules of backends are there where they have been built.
COMPONENTS = ("python", "library", "embree", "cuda", "optix")
OPTIONS = {"ALHAZEN_PYTHON": "ON", "ALHAZEN_INSTALL": "ON", "ALHAZEN_PROGRAM": "OFF", "ALHAZEN_TESTS": "OFF",
           "ALHAZEN_BENCH": "OFF", "ALHAZEN_WERROR": "OFF", "ALHAZEN_UNITY": "ON", "ALHAZEN_INSTRUCTION_SETS": "native"}


def run(*command):
    # pip shows what the backend prints where the build fails, or with -v.
    print("+", shlex.join(map(str, command)), flush=True)
    # pip's PYTHONPATH would hide NumPy from the interpreter that CMake asks.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    status = subprocess.run(command, env=environment).returncode
    if status != 0:
        fail(f"'{command[0]} {command[1]}' ended with {status}, see above; docs/building.md lists what a build needs")


def configure(build):
    """Configures a build of the module alone in the folder `build`."""
    if not shutil.which("cmake"):
        fail("CMake is not on PATH; scripts/install-deps.sh --python installs what a build needs")
    options = [f"-D{name}={value}" for name, value in OPTIONS.items()]
    if shutil.which("ninja"):
        options += ["-G", "Ninja"]
    if shutil.which("ccache"):
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    written = build / "python" / "cmake_install.cmake"
    written.unlink(missing_ok=True)
    run("cmake", "-S", SOURCE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", *options,
        f"-DPython3_EXECUTABLE={sys.executable}", *shlex.split(os.environ.get("CMAKE_ARGS", "")))
    if not written.is_file():
        fail(f"CMake does not find the headers of {sys.executable}, its NumPy or pybind11; scripts/install-deps.sh --python "
             "installs them for Debian's interpreter, /usr/bin/python3")


def built():
    """Returns the build folder, after it has been built."""
    prebuilt = os.environ.get("ALHAZEN_PREBUILT")
    if prebuilt:
        build = (SOURCE / prebuilt).resolve()
        if not (build / "CMakeCache.txt").is_file():
            fail(f"ALHAZEN_PREBUILT: {build} is no build folder of CMake")
        return build
    build = SOURCE / "build" / f"pip-{sys.implementation.cache_tag}"
    configure(build)
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL") or str(len(os.sched_getaffinity(0)))
    run("cmake", "--build", build, "--parallel", jobs)
    return build


def stage(build, folder):
    """Installs what a wheel has into `folder`. Returns the package alhazen and the shared library."""
    for component in COMPONENTS:
        run("cmake", "--install", build, "--prefix", folder, "--component", component, "--strip")
    packages = list(folder.rglob(f"alhazen/_alhazen{SUFFIX}"))
    libraries = [path for path in folder.rglob("libalhazen.so.*") if path.is_symlink()]
    if len(packages) != 1:
        others = [path.name for path in folder.rglob("_alhazen.*.so")]
        fail(f"{build} has no module for {sys.executable} (_alhazen{SUFFIX})" +
             (f" but {others[0]}" if others else "") + ": configure it with -DALHAZEN_PYTHON=ON "
             f"-DPython3_EXECUTABLE={sys.executable} and build it")
    if len(libraries) != 1:
        fail(f"{build} installs {len(libraries)} shared libraries, not one")
    return packages[0].parent, libraries[0]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    # The files of one wheel are for one version of Python and one kind of machine.
    python = "cp{}{}".format(*sys.version_info[:2])
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    with tempfile.TemporaryDirectory() as folder:
        package, library = stage(built(), Path(folder))
        with Wheel(wheel_directory, f"{python}-{python}-{platform}") as wheel:
            for path in sorted(package.rglob("*")):
                if path.is_file() and "__pycache__" not in path.parts:
                    wheel.add(f"alhazen/{path.relative_to(package)}", path)
            # Where the module's RUNPATH and the library find them. A wheel has no links: the library has the name of its link.
            wheel.add(f"alhazen/lib/{library.name}", library)
            for module in sorted((library.parent / "alhazen").glob("libalhazen_*.so")):
                wheel.add(f"alhazen/lib/alhazen/{module.name}", module)
        return wheel.name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = Path(metadata_directory) / f"{NAME}-{VERSION}.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text(metadata(), encoding="utf-8")
    return folder.name


def build_sdist(sdist_directory, config_settings=None):
    """The files that git knows, as an archive; of an unpacked archive, all but the build."""
    run_git = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z"], capture_output=True, text=True)
    if run_git.returncode == 0:
        names = [name for name in run_git.stdout.split("\0") if name]
    else:
        names = [str(path.relative_to(SOURCE)) for path in SOURCE.rglob("*") if path.is_file()]
        names = [name for name in names if not name.startswith("build/") and "__pycache__" not in name and name != "PKG-INFO"]
    root = f"{NAME}-{VERSION}"
    with tarfile.open(Path(sdist_directory) / f"{root}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for name in sorted(names):
            archive.add(SOURCE / name, f"{root}/{name}", recursive=False)
        text = metadata().encode()
        info = tarfile.TarInfo(f"{root}/PKG-INFO")
        info.size = len(text)
        archive.addfile(info, BytesIO(text))
    return f"{root}.tar.gz"
