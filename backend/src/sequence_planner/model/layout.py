"""How values are written in YAML documents: two spaces, indented lists, short lists in one line, long texts folded."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping, Sequence

from ruamel.yaml import YAML
from ruamel.yaml.scalarstring import DoubleQuotedScalarString, SingleQuotedScalarString

WIDTH = 120
_BETWEEN_WORDS = re.compile(r"(?<=\S) (?=\S)")
_QUOTED = {'"': DoubleQuotedScalarString, "'": SingleQuotedScalarString}


def scalar(value: object, style: str = "", in_brackets: bool = False) -> str:
    """A value that is no list or mapping, in one line. A text is quoted by `style` (`'`, `"`), or where it must be."""
    yaml = YAML()
    yaml.width = 1_000_000_000
    yaml.default_flow_style = in_brackets
    yaml.representer.add_representer(type(None), lambda one, _: one.represent_scalar("tag:yaml.org,2002:null", "null"))
    text: object = value
    if isinstance(value, str):
        if "\n" in value or any(ord(character) < 32 for character in value):
            style = '"'
        text = _QUOTED.get(style, str)(value)
    stream = io.StringIO()
    yaml.dump([text], stream)
    written = stream.getvalue().rstrip("\n")
    return written[1:-1] if in_brackets else written[2:]


def in_brackets(value: object) -> str:
    """A value in one line."""
    match value:
        case Mapping():
            pairs = (f"{scalar(key, '', True)}: {in_brackets(inner)}" for key, inner in value.items())
            return "{" + ", ".join(pairs) + "}"
        case str():
            return scalar(value, in_brackets=True)
        case Sequence():
            return "[" + ", ".join(map(in_brackets, value)) + "]"
    return scalar(value, in_brackets=True)


def lines(value: object, name: str, column: int) -> list[str]:
    """The lines of an entry at `column`; `name` is what stands before its value, such as `key:` or `-`."""
    margin = " " * column
    if isinstance(value, str) and "\n" in value and (written := literal(value, column + 2)):
        return [f"{margin}{name} {written[0]}", *written[1:]]
    if not value or not isinstance(value, Mapping | list | tuple):
        empty_or_scalar = in_brackets(value) if isinstance(value, Mapping | list | tuple) else scalar(value)
        line = f"{margin}{name} {empty_or_scalar}"
        if len(line) > WIDTH and isinstance(value, str) and (folded := fold(value, column + 2)):
            return [f"{margin}{name} >-", *folded]
        return [line]
    if isinstance(value, Mapping):
        inner = [line for key, one in value.items() for line in lines(one, f"{scalar(key)}:", column + 2)]
    else:
        line = f"{margin}{name} {in_brackets(value)}"
        if len(line) <= WIDTH and not any(isinstance(one, Mapping | list | tuple) for one in value):
            return [line]
        inner = [line for one in value for line in lines(one, "-", column + 2)]
    if name == "-":  # the first line of what is inside stands behind the dash
        return [f"{margin}- {inner[0].lstrip(' ')}", *inner[1:]]
    return [f"{margin}{name}", *inner]


def fold(text: str, column: int, old: Sequence[str] = ()) -> list[str]:
    """The lines of a folded text, or none if it cannot be folded. Lines of `old` at its beginning and end are kept."""
    if not text or text != text.strip() or "\n" in text or not text.isprintable():
        return []
    above, below = _kept(text, [line.strip() for line in old])
    start = sum(len(line) + 1 for line in above)
    middle = text[start : len(text) - sum(len(line) + 1 for line in below)]
    wrapped: list[str] = []
    for word in _BETWEEN_WORDS.split(middle) if middle else []:
        if wrapped and column + len(wrapped[-1]) + 1 + len(word) <= WIDTH:
            wrapped[-1] += f" {word}"
        else:
            wrapped.append(word)
    return [" " * column + line for line in (*above, *wrapped, *below)]


def _kept(text: str, old: Sequence[str]) -> tuple[list[str], list[str]]:
    """Which lines of a folded text can stay above and below those that change."""
    above: list[str] = []
    while len(above) < len(old) and text.startswith(" ".join([*above, old[len(above)], ""])):
        above.append(old[len(above)])
    rest = text[sum(len(line) + 1 for line in above) :]
    below: list[str] = []
    while len(above) + len(below) < len(old) and rest.endswith(" ".join(["", old[-1 - len(below)], *below])):
        below.insert(0, old[-1 - len(below)])
    if len(above) + len(below) == len(old):  # words were put between two lines: into one of them
        if below:
            below.pop(0)
        elif above:
            above.pop()
    return above, below


def literal(text: str, column: int) -> list[str]:
    """The header and the lines of a text whose line breaks are kept, or nothing if only quotes can write it."""
    body = text.removesuffix("\n").split("\n")
    if not all(line.isprintable() and line == line.rstrip() for line in body) or not body[0] or not body[-1]:
        return []
    if body[0].startswith(" "):
        return []
    margin = " " * column
    return ["|" if text.endswith("\n") else "|-", *(margin + line if line else "" for line in body)]
