"""Pictures and videos of instructions: what of them cannot be shown, and why."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Final
from xml.parsers import expat

from sequence_planner.automaton.automaton import Automaton, Instruction
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import Place
from sequence_planner.model.files import largest
from sequence_planner.model.loader import Station
from sequence_planner.model.paths import INSTRUCTION, INSTRUCTIONS, PICTURES, VIDEOS
from sequence_planner.model.source import Finding, SourceText

_KINDS: Final = {"image": ("picture", PICTURES), "video": ("video", VIDEOS)}
# How files of a kind begin: from which byte on, and with what.
_BEGINNINGS: Final = {
    "png": (0, b"\x89PNG\r\n\x1a\n"),
    "jpg": (0, b"\xff\xd8\xff"),
    "webp": (8, b"WEBP"),
    "mp4": (4, b"ftyp"),
    "webm": (0, b"\x1aE\xdf\xa3"),
}


def unshown_of(automaton: Automaton, station: Station) -> list[Finding]:
    """What of the instructions of a station cannot be shown; a station never stands still because of that."""
    media = _Media(station.folder)
    findings = [finding for text, paths in _named(automaton, station) for finding in media.faults_of(text, paths)]
    return sorted({*findings, *media.faults_of_others()})


def _named(automaton: Automaton, station: Station) -> Iterator[tuple[tuple[str, SourceText], list[str]]]:
    """The pictures and videos that instructions name: which it is, as it is written, and the paths that this means."""
    ground: dict[str, list[Instruction]] = defaultdict(list)
    for name, ability in automaton.abilities.items():
        if ability.instruction is not None:
            ground[without_arguments(name)].append(ability.instruction)
    for resource, document in station.resources.items():
        for name, written in document.abilities.items():
            for key in _KINDS:
                text = getattr(written.instruction, key, None)
                if text is not None:
                    yield (key, text), [getattr(each, key) for each in ground[f"{resource}.{name}"]]


class _Media:
    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._there = {each.name: each for each in sorted((folder / INSTRUCTIONS).glob("[!.]*"))}
        self._told: set[str] = set()
        self._known: dict[str, str | None] = {}
        self._ids: dict[str, frozenset[str]] = {}

    def faults_of(self, named: tuple[str, SourceText], paths: list[str]) -> Iterator[Finding]:
        """What is wrong with what is written at one place, told once."""
        key, text = named
        for path in paths:
            if (fault := self._fault(key, path)) is not None:
                yield Finding(text.place, fault)
                return

    def faults_of_others(self) -> Iterator[Finding]:
        """What is wrong with files that no instruction names."""
        for name, path in self._there.items():
            place = Place(str(path), 1, 1)
            if not INSTRUCTION.fullmatch(name):
                kinds = ", ".join((*PICTURES, *VIDEOS))
                yield Finding(place, f"this is not read: it is a file <name>.<{kinds}>, with letters, digits and `_`")
            elif name not in self._told and (fault := self._fault_of_file(name)) is not None:
                yield Finding(place, fault)

    def _fault(self, key: str, path: str) -> str | None:
        what, kinds = _KINDS[key]
        file, _, part = path.partition("#")
        folder, _, name = file.partition("/")
        if folder != INSTRUCTIONS or not INSTRUCTION.fullmatch(name) or Path(name).suffix[1:] not in kinds:
            first, *others = kinds
            return f"`{path}` is no {what}: write `{INSTRUCTIONS}/<name>.{first}` (or {', '.join(others)})"
        if name not in self._there:
            near = suggestion(file, [f"{INSTRUCTIONS}/{each}" for each in self._there])
            return f"there is no file `{file}`{near}"
        self._told.add(name)
        if (fault := self._fault_of_file(name)) is not None:
            return f"`{file}`: {fault}"
        if part and part not in self._ids.get(name, ()):
            return f"`{file}` has no element `{part}`{suggestion(part, sorted(self._ids.get(name, ())))}"
        return None

    def _fault_of_file(self, name: str) -> str | None:
        if name not in self._known:
            self._known[name] = self._looked_at(name)
        return self._known[name]

    def _looked_at(self, name: str) -> str | None:
        path, kind = self._there[name], Path(name).suffix[1:]
        try:
            size = path.stat().st_size
            if size > largest(name):
                return f"this has {size} bytes, and may have at most {largest(name)}: make it smaller"
            if kind == "svg":
                self._ids[name] = _ids_of(path.read_bytes())
            else:
                at, expected = _BEGINNINGS[kind]
                with path.open("rb") as file:
                    begins = file.read(at + len(expected))[at:]
                if begins != expected:
                    return f"this is no {kind.upper()}, whatever its name says: save it as one"
        except OSError as error:
            return f"this cannot be read: {error.strerror}"
        except expat.ExpatError as error:
            return f"this is no SVG, as line {error.lineno} says: {expat.ErrorString(error.code)}"
        except _NoSvgError as error:
            return str(error)
        return None


class _NoSvgError(Exception):
    """A file that is XML, and no SVG."""


def _ids_of(content: bytes) -> frozenset[str]:
    """The names of the elements of an SVG. Raises `ExpatError` and `_NoSvgError`."""
    found: list[str] = []
    parser = expat.ParserCreate(namespace_separator=" ")

    def own_doctype(_name: str, _system: str | None, _public: str | None, has_own: bool) -> None:
        if has_own:
            raise _NoSvgError("declarations of its own are not read: take the part in `[ ]` out of the DOCTYPE")

    def opened_element(name: str, attributes: dict[str, str]) -> None:
        if not found and name != "http://www.w3.org/2000/svg svg":
            raise _NoSvgError(f"this is no SVG: it begins with `{name.rpartition(' ')[2]}`")
        found.append(attributes.get("id", ""))

    parser.StartDoctypeDeclHandler = own_doctype
    parser.StartElementHandler = opened_element
    parser.Parse(content, True)
    return frozenset(found) - {""}
