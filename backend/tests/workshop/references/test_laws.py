"""Whatever is given another name: the model means the same, and with its old name it is the same to the byte."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from sequence_planner.model.paths import EditError
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.workshop.references import KINDS, Part, parse_part, renamed
from sequence_planner.workshop.references.texts import Content
from sequence_planner.workshop.references.walking import gather

from .stations import (
    CELL,
    REPOSITORY,
    changed,
    described,
    messages_of,
    of_folder,
    of_page,
    write,
)

STATIONS = {
    "bolt_tightening": of_folder(REPOSITORY / "models" / "bolt_tightening"),
    "model page": of_page("model.md"),
    "pipelines page": of_page("pipelines.md"),
    "cell": CELL,
}
LARGE = of_folder(REPOSITORY / "models" / "truck_engine_station")
FRESH = "z9"


def parts_of(files: Mapping[str, str], messages: MessageRegistry) -> list[Part]:
    """All parts, those that nobody declares among them."""
    declared, _ = gather(Content(files), messages)
    return list(dict.fromkeys([*declared.parts, *(parse_part(f"variable:{name}") for name in declared.variables)]))


def new_name(part: Part) -> str:
    return f"{part.name}/{FRESH}" if part.name.startswith("/") else f"{part.name}{FRESH}"


def there_and_back(files: Mapping[str, str], part: Part, folder: Path, messages: MessageRegistry, before: str) -> bool:
    """Whether a part can be renamed; then the law must hold."""
    try:
        changes = renamed(files, part, new_name(part), messages)
    except EditError as error:
        assert "cannot be given another name in the model alone" in str(error), f"{part.id}: {error}"
        return False
    write(changes, folder)
    assert described(folder, FRESH) == before, part.id
    assert FRESH in "".join(map(str, changes.items()))
    there = changed(files, changes)
    back = renamed(there, part._replace(name=new_name(part)), part.name, messages)
    assert changed(there, back) == files, part.id
    write(back, folder)
    return True


@pytest.mark.parametrize("station", STATIONS)
def test_every_part_there_and_back(station: str, tmp_path: Path) -> None:
    files = STATIONS[station]
    write(files, tmp_path)
    messages, before = messages_of(tmp_path), described(tmp_path, FRESH)
    parts = parts_of(files, messages)
    done = [part for part in parts if there_and_back(files, part, tmp_path, messages, before)]
    assert len(done) > len(parts) / 3
    assert {part.kind for part in parts} - {part.kind for part in done} == set()


def of_each_kind(parts: list[Part]) -> Iterator[Part]:
    for kind in KINDS:
        yield from [part for part in parts if part.kind == kind][-1:]


def test_some_parts_of_a_large_station_there_and_back(tmp_path: Path) -> None:
    write(LARGE, tmp_path)
    messages, before = messages_of(tmp_path), described(tmp_path, FRESH)
    chosen = list(of_each_kind(parts_of(LARGE, messages)))
    done = [part for part in chosen if there_and_back(LARGE, part, tmp_path, messages, before)]
    assert {"enumeration", "resource", "ability", "operation", "specification", "topic", "variable"} <= {
        part.kind for part in done
    }
