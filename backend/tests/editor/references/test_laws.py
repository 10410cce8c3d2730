"""Whatever is given another name: the model means the same, and with its old name it is the same to the byte."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import pytest

from sequence_planner.editor.symbols.definitions import gather
from sequence_planner.editor.symbols.index import KINDS, ModelPart, following, parse_part
from sequence_planner.editor.symbols.rename import renamed, usage_of, usages
from sequence_planner.editor.symbols.texts import ModelContent
from sequence_planner.model.paths import EditError
from sequence_planner.ros.types.messages import MessageRegistry
from support.examples import SHARE

from ..shorthand import SHORTHAND
from .stations import CELL, IN_SEQUENCE, REPOSITORY, changed, described, messages_of, of_folder, of_page, write

TYPED = of_folder(REPOSITORY / "models" / "robots_with_buffer")
STATIONS = {
    "bolt_tightening": of_folder(REPOSITORY / "models" / "bolt_tightening"),
    "model page": of_page("model.md"),
    "pipelines page": of_page("pipelines.md"),
    "cell": CELL,
    "sequences": IN_SEQUENCE,
    "shorthand": SHORTHAND,
    "types": TYPED,
}
LARGE = of_folder(REPOSITORY / "models" / "truck_engine_station")
FRESH = "z9"
# Why a part cannot be given another name in the model alone.
REFUSED = {
    "value": ("by their names", "whose names are given"),
    "topic": ("its name is made of an argument of its type",),
}


def parts_of(files: Mapping[str, str], messages: MessageRegistry) -> list[ModelPart]:
    """All parts, those that nobody declares among them. Words of quantifiers are told by what they stand in."""
    declared, gathered = gather(ModelContent(files), messages)
    words = [each.part for each in gathered.occurrences if each.part.kind == "word" and each.declares]
    return list(
        dict.fromkeys([*words, *declared.parts, *(parse_part(f"variable:{name}") for name in declared.variables)])
    )


def fresh(part: ModelPart) -> ModelPart:
    """With a name that nothing else has."""
    return part._replace(name=f"{part.name}/{FRESH}" if part.name.startswith("/") else f"{part.name}{FRESH}")


class Renaming:
    """Parts of a station renamed one after the other, each in what has come of those before."""

    def __init__(self, files: dict[str, str], messages: MessageRegistry) -> None:
        self.files = files
        self.messages = messages
        self.done: list[tuple[ModelPart, dict[str, str]]] = []
        self.refused: list[ModelPart] = []

    def there(self, parts: Iterable[ModelPart]) -> None:
        called = list(parts)
        for index in range(len(called)):
            old = called[index]
            if old.name.endswith(FRESH):
                continue  # a value that is one with another, or what all instances of a type have
            if old.kind == "message":
                continue  # all nodes know it by its name
            is_one_with_others = old.kind == "value" or any(file.startswith("types/") for file in self.files)
            found = usages(self.files, old, self.messages).found if is_one_with_others else ()
            together = {old, *(each.part for each in found)}
            try:
                changes = renamed(self.files, old, fresh(old).name, self.messages)
            except EditError as error:
                assert any(reason in str(error) for reason in REFUSED.get(old.kind, ())), f"{old.id}: {error}"
                self.refused.append(old)
                continue
            self.done.append((fresh(old), self.files))
            self.files = changed(self.files, changes)
            for one in together:
                called = [following(each, one, fresh(one)) for each in called]

    def back(self) -> None:
        for part, before in reversed(self.done):
            changes = renamed(self.files, part, part.name.removesuffix(FRESH).rstrip("/"), self.messages)
            self.files = changed(self.files, changes)
            assert self.files == before, part.id


def check(files: dict[str, str], folder: Path, *also: ModelPart, every: int | None) -> Renaming:
    """The law for each part whose number `every` divides, for the last of each kind, and for some others."""
    write(files, folder / "before")
    messages = messages_of(folder / "before")
    parts = parts_of(files, messages)
    renaming = Renaming(files, messages)
    chosen = {*{part.kind: part for part in parts}.values(), *also, *(parts[::every] if every is not None else ())}
    renaming.there([part for part in parts if part in chosen])
    write(renaming.files, folder / "after")
    assert described(folder / "after", FRESH) == described(folder / "before", FRESH)
    renaming.back()
    return renaming


@pytest.mark.parametrize("station", STATIONS)
def test_every_part_there_and_back(station: str, tmp_path: Path) -> None:
    renaming = check(STATIONS[station], tmp_path, every=1 if SHARE >= 1 else 6)
    assert station != "shorthand" or renaming.refused == []


def test_every_kind_of_part_is_among_them(tmp_path: Path) -> None:
    write(IN_SEQUENCE, tmp_path)
    messages = messages_of(tmp_path)
    assert {part.kind for files in (IN_SEQUENCE, SHORTHAND, TYPED) for part in parts_of(files, messages)} == set(KINDS)


def test_parts_of_a_large_station_there_and_back(tmp_path: Path) -> None:
    # The lift's state is made of a name that is no variable.
    values = (parse_part(f"value:{name}") for name in ("bolt_state.placed", "lift_state.holds"))
    renaming = check(LARGE, tmp_path, *values, every=None)
    kinds = {part.kind for part in parts_of(LARGE, renaming.messages)} - {"message"}
    assert {part.kind for part, _ in renaming.done} == kinds


def test_reading_only_what_holds_the_name_finds_the_same(tmp_path: Path) -> None:
    write(LARGE, tmp_path)
    messages = messages_of(tmp_path)
    _, everything = gather(ModelContent(LARGE), messages)
    for part in parts_of(LARGE, messages)[::3]:
        if part.kind != "value":
            expected = {usage_of(each) for each in everything.occurrences if each.part == part}
            found = usages(LARGE, part, messages).found
            assert {(each.file, each.line, each.column) for each in found} == {
                (each.file, each.line, each.column) for each in expected
            }, part.id
