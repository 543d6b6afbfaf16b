"""The blocks of Python in the documentation run, page by page, from the top to the bottom."""

import re

import pytest

import alhazen
from common import ROOT

PAGES = ("docs/python.md", "README.md")


def blocks(page):
    """The line of each block, and its text."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return [(text.count("\n", 0, match.start(1)), match[1])
            for match in re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)]


@pytest.mark.parametrize("page", PAGES)
def test_examples_run(page, tmp_path, monkeypatch):
    """From the root of the repository, as the page says; what they write stays in a folder of the test."""
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    found = blocks(page)
    assert found, f"{page} has no blocks"
    names = {"__name__": "__main__"}
    for line, block in found:
        exec(compile("\n" * line + block, str(ROOT / page), "exec"), names)


def test_names_exist():
    """Names such as `alhazen.render` in docs/python.md."""
    text = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    for name in set(re.findall(r"alhazen\.([A-Za-z_]+(?:\.[A-Za-z_]+)*)", text)):
        owner = alhazen
        for part in name.split("."):
            assert hasattr(owner, part), f"docs/python.md names alhazen.{name}"
            owner = getattr(owner, part)
