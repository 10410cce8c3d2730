"""Paths of a model: files in a station's folder, and entries in a document (`abilities.run_nut.start`)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.texts.message import message

if TYPE_CHECKING:
    from sequence_planner.model.yaml.reader import EntryPath

# What lies in a station's folder.

DRAWINGS = "drawings"
INSTRUCTIONS = "instructions"
TESTS = "tests"
FOLDERS = ("resources", "types", "messages", DRAWINGS, INSTRUCTIONS, TESTS, "stages", "packages")
# What files below `messages` define, by what their names end with.
DEFINITIONS = {"msg": "message", "srv": "service", "action": "action"}
# The name of a file below `drawings`.
DRAWING = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,99}\.svg")
# The name of a file below `instructions`, by what it holds. All but an SVG are no texts.
PICTURES = ("svg", "png", "jpg", "webp")
VIDEOS = ("mp4", "webm")
INSTRUCTION = re.compile(rf"[A-Za-z_][A-Za-z0-9_]{{0,99}}\.(?:{'|'.join((*PICTURES, *VIDEOS))})")
# The files of scenarios.
SCENARIOS = re.compile(rf"{TESTS}/[A-Za-z_][A-Za-z0-9_]{{0,99}}\.yaml")
# The documents of a station beside its resources.
FILES = ("station.yaml", "operations.yaml", "specifications.yaml", "work_masters.yaml", "mimic.yaml", "shifts.yaml")


_RESOURCE = re.compile(r"resources/([^/]+)\.yaml")
_TYPE = re.compile(r"(?:packages/(\w+)/)?types/(\w+)\.yaml")


def has_scenarios(file: str) -> bool:
    """Return whether a file of a model has scenarios by which it is tested."""
    return SCENARIOS.fullmatch(file) is not None


def resource_of(file: str) -> str | None:
    """The name of the resource that a file of a model describes; None for other files."""
    found = _RESOURCE.fullmatch(file)
    return None if found is None else found[1]


def type_of(file: str) -> str | None:
    """The name of the type that a file of a model describes, that of a package as `package.name`; None for others."""
    found = _TYPE.fullmatch(file)
    return None if found is None else ".".join(filter(None, found.groups()))


# How people name an entry of a document: `abilities.run_nut.start.do[0]`.


class EditError(Exception):
    """An edit that cannot be made; nothing was changed. The text says `why`."""

    def __init__(self, why: str) -> None:
        super().__init__(why)
        self.why = why


def shown_path(path: EntryPath) -> str:
    """A path as people write it: `abilities.run_nut.start.do[0]`."""
    written = ""
    for step in path:
        if isinstance(step, int):
            written += f"[{step}]"
        else:
            name = step if re.fullmatch(r"[^\s.\[\]\"']+", step) else f'"{step}"'
            written += f".{name}" if written else name
    return written


_STEP = re.compile(
    r"""\[(?P<index>\d+)\]|(?P<dot>\.?)(?:"(?P<quoted>[^"]*)"|'(?P<single>[^']*)'|(?P<name>[^\s.\[\]"']+))"""
)


def parse_path(text: str) -> EntryPath:
    """Read `abilities.run_nut.start.do[0]`; a name with dots, brackets or spaces stands in quotes."""
    path: list[str | int] = []
    at = 0
    while at < len(text):
        step = _STEP.match(text, at)
        if step is None or (step["index"] is None and bool(step["dot"]) != bool(path)):
            raise EditError(message("edit.no-path", text=text, rest=text[at:]))
        if step["index"] is not None:
            path.append(int(step["index"]))
        else:
            path.append(next(one for one in (step["quoted"], step["single"], step["name"]) if one is not None))
        at = step.end()
    if not path:
        raise EditError(message("edit.empty-path"))
    return tuple(path)


def missing(path: EntryPath, depth: int, around: object) -> str:
    """Return what is to be said where `around`, at the first `depth` steps of `path`, has not the next step."""
    step = path[depth]
    where = f"`{shown_path(path[:depth])}`" if depth else "the document"
    if isinstance(around, dict):
        if isinstance(step, int):
            return f"{where} is a mapping: write a name and not [{step}]"
        return f"{where} has no entry `{step}`{suggestion(step, list(map(str, around)))}"
    if isinstance(around, list):
        return f"{where} is a list of {len(around)}, counted from [0]: there is no `{shown_path((step,))}` in it"
    return f"{where} has no entries"
