"""The stations of `models/`, each text of theirs that has a meaning, and drafts with another text in its place."""

from __future__ import annotations

import atexit
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from typing import Any, NamedTuple

from pydantic import BaseModel

from sequence_planner.editor.language.field import TextField
from sequence_planner.editor.language.scope import Lexicon
from sequence_planner.language.types import Place
from sequence_planner.model.loader import Station, load_station
from sequence_planner.model.source import SourceText
from sequence_planner.model.yaml.reader import EntryPath, read_yaml

from ..references.stations import write
from ..shorthand import SHORTHAND

MODELS = Path(__file__).parents[4] / "models"
STATIONS = [*sorted(path.name for path in MODELS.iterdir() if (path / "station.yaml").is_file()), "shorthand"]
ELSEWHERE = "the text in question"  # where a text put into a draft says that it stands


class Text(NamedTuple):
    """A text of a station, and the field it stands in."""

    file: str
    path: EntryPath
    text: str
    field: TextField

    def __str__(self) -> str:
        return f"{self.file}:{'.'.join(map(str, self.path))}"


@dataclass(frozen=True)
class Draft:
    """A station that is edited."""

    station: Station
    lexicon: Lexicon
    texts: tuple[Text, ...]


@lru_cache
def draft(name: str) -> Draft:
    """A station of `models/`, or that with all that can be said for short."""
    folder = MODELS / name
    if name == "shorthand":
        folder = Path(mkdtemp())
        atexit.register(rmtree, folder)
        write(SHORTHAND, folder)
    station = load_station(folder)
    lexicon = Lexicon.of(station)
    return Draft(station, lexicon, tuple(_texts(folder, lexicon)))


def _texts(folder: Path, lexicon: Lexicon) -> Iterator[Text]:
    for path in sorted(folder.glob("**/*.yaml")):
        file = str(path.relative_to(folder))
        for at, text in _leaves(read_yaml(path, file).content, ()):
            field = lexicon.field(file, at)
            if field is not None:
                yield Text(file, at, text, field)


def _leaves(content: object, at: EntryPath) -> Iterator[tuple[EntryPath, str]]:
    if isinstance(content, dict):
        for key, value in content.items():
            if at[1:] == ("operations",) and len(at) == 2:  # an operation of a work master is a name
                yield (*at, str(key)), str(key)
            yield from _leaves(value, (*at, str(key)))
    elif isinstance(content, list):
        for index, value in enumerate(content):
            yield from _leaves(value, (*at, index))
    elif isinstance(content, str):
        yield at, str(content)


def with_text(station: Station, file: str, path: EntryPath, text: str) -> tuple[Station, SourceText]:
    """The station with another text at an entry, and that text."""
    put = SourceText(text, Place(ELSEWHERE, 1, 1), text)
    section = file.removesuffix(".yaml")
    if file.startswith("resources/"):
        name = section.removeprefix("resources/")
        changed = _with(station.resources[name], path, put)
        return replace(station, resources={**station.resources, name: changed}), put
    return replace(station, **{section: _with(getattr(station, section), path, put)}), put


def _with(part: Any, path: EntryPath, put: SourceText) -> Any:  # noqa: ANN401 - parts of any document
    step, *rest = path
    if isinstance(part, BaseModel):
        names = {field.alias or name: name for name, field in type(part).model_fields.items()}
        name = names[str(step)]
        return part.model_copy(update={name: _inner(getattr(part, name), tuple(rest), put)})
    if isinstance(part, Mapping):
        if not rest and (part[step] is None or isinstance(part[step], BaseModel)):  # the entry's name is the text
            return {put if key == step else key: value for key, value in part.items()}
        return {key: _inner(value, tuple(rest), put) if key == step else value for key, value in part.items()}
    return [_inner(value, tuple(rest), put) if index == step else value for index, value in enumerate(part)]


def _inner(part: Any, rest: EntryPath, put: SourceText) -> Any:  # noqa: ANN401
    return _with(part, rest, put) if rest else put


def words(text: str) -> list[str]:
    """The words and signs of a text."""
    return re.findall(r"\w+|:=|[=!<>]=|\S", text)
