"""A wheel, the archive that pip installs, and what it says of the project: pyproject.toml, include/alhazen/version.h."""

import base64
import hashlib
import re
import sys
import tomllib
import zipfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((SOURCE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
NAME = PROJECT["name"]
# The oldest time that a zip can have: the same files make the same archive.
TIME = (1980, 1, 1, 0, 0, 0)


def fail(text):
    sys.exit(f"alhazen: {text}")


def read_version():
    header = (SOURCE / "include/alhazen/version.h").read_text(encoding="utf-8")
    return ".".join(re.search(rf"^#define ALHAZEN_VERSION_{part} (\d+)$", header, re.MULTILINE)[1]
                    for part in ("MAJOR", "MINOR", "PATCH"))


VERSION = read_version()


def metadata():
    lines = ["Metadata-Version: 2.1", f"Name: {NAME}", f"Version: {VERSION}", f"Summary: {PROJECT['description']}",
             f"License: {PROJECT['license']['text']}", f"Requires-Python: {PROJECT['requires-python']}"]
    lines += [f"Requires-Dist: {dependency}" for dependency in PROJECT["dependencies"]]
    return "\n".join(lines) + "\n"


class Wheel:
    """Written as a whole: a build that fails leaves no file."""

    def __init__(self, folder, tag):
        self.tag = tag
        self.name = f"{NAME}-{VERSION}-{tag}.whl"
        self.path = Path(folder) / self.name
        self.part = self.path.with_suffix(".part")
        self.information = f"{NAME}-{VERSION}.dist-info"
        self.records = []

    def __enter__(self):
        self.archive = zipfile.ZipFile(self.part, "w", zipfile.ZIP_DEFLATED)
        return self

    def write(self, name, content, mode):
        entry = zipfile.ZipInfo(name, TIME)
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.external_attr = (0o100000 | mode) << 16
        self.archive.writestr(entry, content)
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        self.records.append(f"{name},sha256={digest},{len(content)}")

    def add(self, name, path):
        self.write(name, path.read_bytes(), 0o755 if ".so" in path.name else 0o644)

    def __exit__(self, kind, *_):
        if kind is None:
            self.add(f"{self.information}/LICENSE", SOURCE / "LICENSE")
            self.write(f"{self.information}/METADATA", metadata().encode(), 0o644)
            self.write(f"{self.information}/WHEEL",
                       f"Wheel-Version: 1.0\nGenerator: {NAME}\nRoot-Is-Purelib: false\nTag: {self.tag}\n".encode(), 0o644)
            self.records.append(f"{self.information}/RECORD,,")
            self.archive.writestr(zipfile.ZipInfo(f"{self.information}/RECORD", TIME), "\n".join(self.records) + "\n")
        self.archive.close()
        if kind is None:
            self.part.replace(self.path)
        else:
            self.part.unlink()
