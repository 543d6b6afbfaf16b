#!/usr/bin/env python3
"""Checks what the pages say that a program can check. Prints file:line for each fault and fails.

usage: scripts/check-docs.py [--alhazen build/release/bin/alhazen] [PAGE.md...]

- A relative link leads to a file of the repository, and its #anchor to a heading.
- A file that is named in `code` or in a command exists; so do variables ALHAZEN_... and presets of CMake.
- A command `alhazen ...` has options that its --help lists, and reads files that the repository has or that an earlier
  command of the page writes. Names in capitals (SCENE, DIR/x.exr) stand for files of the reader.
- Options of our scripts, options that the text names, and names of the library in examples in C++ exist.
"""

import argparse
import functools
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCE_SUFFIXES = {".h", ".cpp", ".cu", ".cuh", ".py", ".sh", ".cmake"}
INPUT_SUFFIXES = {".pbrt", ".gltf", ".glb", ".ply", ".gz", ".hdr", ".exr", ".png", ".state", ".json"}
OUTPUT_OPTIONS = {"-o", "--output", "--outfile", "--diff", "--checkpoint"}
INPUT_OPTIONS = {"--environment", "--scene"}
FOREIGN_OPTIONS = {"--fmad", "--preset", "--install", "--prefix", "--upgrade", "--static", "--cflags", "--libs",
                   "--no-install-recommends"}  # of nvcc, CMake, pbrt, pkg-config and apt
SUBCOMMANDS = {"render", "view", "compare", "devices", "info", "study", "completion"}
STUDY_SUBCOMMANDS = {"report", "tune", "compare"}
OPTION = re.compile(r"--?[A-Za-z][\w-]*")


@functools.cache
def repository_files():
    """The files that a clone has, and sources and pages that are not added yet: not what examples have written."""
    def listed(*options):
        run = subprocess.run(["git", "-C", ROOT, "ls-files", *options], capture_output=True, text=True)
        return run.stdout.splitlines() if run.returncode == 0 else None

    names = listed("--cached")
    if names is None:  # not a clone: a source archive
        names = [str(path.relative_to(ROOT)) for path in ROOT.rglob("*") if "build" not in path.relative_to(ROOT).parts]
    else:
        names += [name for name in listed("--others", "--exclude-standard")
                  if Path(name).suffix in SOURCE_SUFFIXES | {".md"}]
    return frozenset(name for name in names if (ROOT / name).is_file())


@functools.cache
def repository_folders():
    return frozenset(str(parent) for name in repository_files() for parent in Path(name).parents if str(parent) != ".")


@functools.cache
def text_of(*folders):
    """All text in the files of these folders, or of the files themselves."""
    return "\n".join((ROOT / name).read_text(encoding="utf-8", errors="replace") for name in sorted(repository_files())
                     if any(name == folder or name.startswith(folder + "/") for folder in folders))


class Help:
    """The options of each subcommand, by its --help-all: names, and what follows: "", "value", or "optional" for one that is
    left out before an option or a file."""

    def __init__(self, program):
        self.program = program

    @functools.cache
    def options(self, *subcommand):
        run = subprocess.run([self.program, *subcommand, "--help-all"], capture_output=True, text=True, check=True)
        options = {}
        for line in run.stdout.splitlines():
            match = re.match(r"\s+(-[\w,-]+)(\{\w+\})?( \S.*?)?(?:\s{2,}|$)", line)
            if match:
                kind = "" if match[3] is None else "optional" if match[3].startswith(" [") else "value"
                options |= {name: kind for name in match[1].split(",")}
        return options

    def all_options(self):
        commands = [(name,) for name in sorted(SUBCOMMANDS)] + [("study", name) for name in sorted(STUDY_SUBCOMMANDS)]
        return set().union(self.options(), *(self.options(*command) for command in commands))


def expand_braces(text):
    match = re.search(r"\{([^{}]*)\}", text)
    if not match:
        return [text]
    return [name for part in match[1].split(",")
            for name in expand_braces(text[:match.start()] + part + text[match.end():])]


@functools.cache
def matches(name, folder_prefixes=("", "src/")):
    """Whether the repository has this file or folder, by its path from the root or from src; * is any text."""
    pattern = re.compile("|".join(re.escape(prefix + name.rstrip("/")).replace(r"\*", "[^/]*")
                                  for prefix in folder_prefixes))
    return any(pattern.fullmatch(path) for path in repository_files() | repository_folders())


@functools.cache
def has_file_ending(name):
    """Whether some file's path ends in this, at a whole name."""
    pattern = re.compile("(?:.*/)?" + re.escape(name).replace(r"\*", "[^/]*"))
    return any(pattern.fullmatch(path) for path in repository_files())


def is_placeholder(name):
    return re.search(r"\b[A-Z]{2,}\b", name.split(",")[0]) is not None


def anchors(page):
    """The anchors of a page's headings, as GitHub makes them."""
    found, fenced = set(), False
    for line in page.read_text(encoding="utf-8").splitlines():
        fenced ^= line.startswith("```")
        if not fenced and (match := re.match(r"#+ (.*)", line)):
            heading = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", match[1]).lower()
            found.add(re.sub(r"[^\w\- ]", "", heading).strip().replace(" ", "-"))
    return found


class Page:
    def __init__(self, path, program_help):
        self.path = path
        self.help = program_help
        self.written = {"study"}  # what commands of this page write; `study report` does so by itself
        self.faults = []
        self.line = 0

    def fault(self, message):
        self.faults.append(f"{self.path.relative_to(ROOT)}:{self.line}: {message}")

    def check(self):
        lines = self.path.read_text(encoding="utf-8").splitlines()
        command, paragraph, block = "", [], None  # block: the language of the fenced block that the line is in
        for number, line in enumerate([*lines, ""], 1):
            if line.startswith("```"):
                block = line[3:].strip() if block is None else None
            elif block is None and line.strip():
                paragraph.append(line)
            if paragraph and (block is not None or not line.strip()):
                self.check_text("\n".join(paragraph), number - len(paragraph))
                paragraph = []
            self.line = number
            if block == "cpp":
                self.check_names(line)
            if block in ("sh", "console") or block is None and line.startswith("    "):
                command += line.strip().removeprefix("$ ")
                if command.endswith("\\"):
                    command = command[:-1]
                    continue
                self.check_command(command)
                command = ""
        return self.faults

    def check_text(self, text, first_line):
        """A paragraph: its links, and its `code`, which may go on in the next line."""
        for match in re.finditer(r"\]\(([^)\s]+)\)|`([^`]+)`", text):
            self.line = first_line + text.count("\n", 0, match.start())
            target, code = match.groups()
            if target and not re.match(r"\w+:", target):
                self.check_link(target)
            elif code:
                self.check_code(" ".join(code.split()))

    def check_names(self, line):
        """Of an example in C++."""
        for name in re.findall(r"alhazen::(\w+)", line):
            if name != "alhazen" and not re.search(rf"\b{name}\b", text_of("include")):
                self.fault(f"the library has no {name}")

    def check_code(self, code):
        if re.match(r"(\S*/)?(alhazen|cmake|ctest|bash|python3) |scripts/|scenes/", code):
            self.check_command(code)
            return
        for word in code.split():
            self.check_word(word)
            if option := re.match(r"--[a-z][\w-]*", word):
                self.check_option_anywhere(option[0])

    def check_link(self, target):
        name, _, anchor = target.partition("#")
        page = (self.path.parent / name).resolve() if name else self.path
        inside = str(page.relative_to(ROOT)) if page.is_relative_to(ROOT) else None
        if inside not in repository_files() | repository_folders():
            self.fault(f"the link to {target} leads to nothing in the repository")
        elif anchor and anchor not in anchors(page):
            self.fault(f"{page.name} has no heading for #{anchor}")

    def check_option_anywhere(self, option):
        if option not in self.help.all_options() | FOREIGN_OPTIONS and f'"{option}"' not in text_of("scripts", "scenes"):
            self.fault(f"neither the program nor a script has the option {option}")

    def check_word(self, word):
        """A word of code: a path, or a variable of CMake."""
        for variable in re.findall(r"ALHAZEN_[A-Z_]+\b", word):
            if not re.search(rf"{variable}\b", text_of("CMakeLists.txt", "CMakePresets.json", "cmake", "include", "src", "bench",
                                                         "tests")):
                self.fault(f"nothing reads {variable}")
        word = word.strip("`'\"(),;:")
        if not re.fullmatch(r"[\w./*{},+-]+", word) or is_placeholder(word) or word.startswith(("/", "-", "build/", "~")):
            return
        for name in expand_braces(word):
            first = name.split("/")[0]
            if "/" in name and (first in repository_folders() or "src/" + first in repository_folders()):
                if not matches(name) and not matches(name + ".h") and name not in self.written:
                    self.fault(f"{name} does not exist")
            elif Path(name).suffix in SOURCE_SUFFIXES and not has_file_ending(name):
                self.fault(f"no file is called {name}")

    def check_command(self, text):
        for part in re.split(r"\s(?:&&|\|)\s", re.sub(r"(^|\s)#\s.*", "", text)):
            try:
                words = shlex.split(part)
            except ValueError:
                continue  # prose within an indented block
            while words and re.fullmatch(r"\w+=\S*", words[0]):
                words.pop(0)
            if not words:
                continue
            for word in words:
                self.check_word(word)
            if Path(words[0]).name == "alhazen" and len(words) > 1:
                self.check_alhazen(words[1:])
            elif "--preset" in words:
                self.check_preset(words[words.index("--preset") + 1])
            else:
                self.check_script(words)

    def check_preset(self, name):
        presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
        if not is_placeholder(name) and name not in {preset["name"] for preset in presets}:
            self.fault(f"there is no preset {name}")

    def check_script(self, words):
        scripts = [word for word in words[:2] if word.startswith(("scripts/", "scenes/", "python/"))]
        if not scripts or scripts[0] not in repository_files():
            return  # not ours, or a fault by now
        source = text_of(scripts[0])
        arguments = words[words.index(scripts[0]) + 1:]
        if "--" in arguments:  # what follows are options of `alhazen render`
            at = arguments.index("--")
            self.check_alhazen(["render", *arguments[at + 1 :]])
            arguments = arguments[:at]
        for option in (OPTION.match(word)[0] for word in arguments if OPTION.match(word)):
            if not re.search(rf"(?<![\w-]){option}\b", source):
                self.fault(f"{scripts[0]} has no option {option}")
        files = [word for word in arguments if Path(word).suffix in INPUT_SUFFIXES]
        for name in files[:-1]:
            self.check_input(name)
        self.written.update(files[-1:])

    def check_alhazen(self, words):
        if words[0].startswith("-"):
            if words[0] not in self.help.options():
                self.fault(f"`alhazen --help` has no option {words[0]}")
            return
        if re.search("[./]", words[0]):  # a file to render
            words = ["render", *words]
        depth = 2 if words[0] == "study" and len(words) > 1 else 1
        subcommand = tuple(words[:depth])
        if is_placeholder(words[0]):
            return
        if words[0] not in SUBCOMMANDS or depth == 2 and words[1] not in STUDY_SUBCOMMANDS:
            self.fault(f"there is no `alhazen {' '.join(subcommand)}`")
            return
        options = self.help.options(*subcommand)
        rest, inputs, outputs = list(words[depth:]), [], []
        while rest:
            word = rest.pop(0)
            if not word.startswith("-"):
                inputs.append(word)
                continue
            name, equals, value = word.partition("=")
            if name not in options:
                self.fault(f"`alhazen {' '.join(subcommand)} --help` has no option {name}")
            elif options[name] == "optional" and rest and (rest[0].startswith("-") or re.search("[./]", rest[0])):
                continue
            elif options[name] and not equals:
                value = rest.pop(0) if rest else ""
            if name in INPUT_OPTIONS:
                inputs.append(value)
            elif name in OUTPUT_OPTIONS:
                outputs.append(re.sub(r",\d+$", "", value))
        for name in inputs:
            self.check_input(name)
        self.written.update(outputs)

    def check_input(self, name):
        if not is_placeholder(name) and name.rstrip("/") not in self.written | repository_files() | repository_folders():
            self.fault(f"{name} is neither in the repository nor written by a command above")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--alhazen", type=Path, default=ROOT / "build/release/bin/alhazen", help="the program")
    parser.add_argument("pages", nargs="*", type=Path, metavar="PAGE.md", help="default: all of the repository")
    options = parser.parse_args()
    pages = [page.resolve() for page in options.pages] or sorted(
        ROOT / name for name in repository_files() if name.endswith(".md"))
    program_help = Help(str(options.alhazen.resolve()))
    faults = [fault for page in pages for fault in Page(page, program_help).check()]
    print("\n".join([*faults, f"{len(pages)} pages, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
