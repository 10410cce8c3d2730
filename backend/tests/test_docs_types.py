"""What the page about types of resources shows is tried."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

import pytest

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.model.documents import PackageSourceDocument
from sequence_planner.model.fields import DocumentPart
from sequence_planner.model.source import ModelError
from sequence_planner.model.types.documents import InstanceHead, ParameterDocument, TypeHead
from sequence_planner.model.types.packages import PackageDocument
from sequence_planner.station import prepare_station
from support.places import DOCS
from support.station import finished

TEXT = (DOCS / "types.md").read_text(encoding="utf-8")
FILES = dict(re.findall(r"^```(?:yaml|text) (\S+/?\S*)\n((?:.*\n)*?)```$", TEXT, re.MULTILINE))
ERRORS = re.findall(r"^\| `` (\w+): (.*?) `` \| `` (\d+):(\d+): (.*) `` \|$", TEXT, re.MULTILINE)


@pytest.fixture
def station(tmp_path: Path) -> Path:
    """The station of the page, written to a folder."""
    for name, content in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")
    return tmp_path


@pytest.fixture
def automaton(station: Path) -> Automaton:
    return prepare_station(station).automaton


def test_nothing_is_to_be_said_against_its_station(station: Path) -> None:
    found = finished("check", str(station))
    assert (found.returncode, found.stderr) == (0, "")


def test_its_instances_are_what_the_page_says(automaton: Automaton) -> None:
    assert automaton.resources == {"infeed": "Belt infeed", "outfeed": "Belt outfeed"}
    assert {name for name in automaton.abilities if ".run" in name} == {"infeed.run", "outfeed.run"}
    assert (automaton.abilities["infeed.run"].timeouts.finish, automaton.abilities["outfeed.run"].timeouts.finish) == (
        20,
        None,
    )
    assert {effect.name: effect.longest for effect in automaton.effects} == {
        "infeed.run.arrives": 3,
        "outfeed.run.arrives": 1.5,
    }
    assert set(automaton.alarms) == {"outfeed.full"}


def test_there_are_errors() -> None:
    assert len(ERRORS) >= 12


@pytest.mark.parametrize(("file", "written", "line", "column", "message"), ERRORS)
def test_errors_are_said_as_shown(station: Path, file: str, written: str, line: str, column: str, message: str) -> None:
    name = f"types/{file}.yaml" if file == "belt" else f"resources/{file}.yaml"
    lines = (station / name).read_text(encoding="utf-8").split("\n")
    key = f"{written.split(':', maxsplit=1)[0]}:"
    alike = [at for at, each in enumerate(lines) if each.strip().startswith(key)]
    place = min(alike, key=lambda at: abs(at + 1 - int(line)), default=int(line) - 1)
    lines[place] = " " * (len(lines[place]) - len(lines[place].lstrip())) + written
    (station / name).write_text("\n".join(lines), encoding="utf-8")
    with contextlib.chdir(station), pytest.raises(ModelError) as caught:
        prepare_station(Path())
    assert f"{name}:{line}:{column}: {message}" in str(caught.value).split("\n")


@pytest.mark.parametrize("part", [InstanceHead, TypeHead, ParameterDocument, PackageDocument, PackageSourceDocument])
def test_every_key_is_described(part: type[DocumentPart]) -> None:
    for name in part.model_fields:
        assert f"`{name}`" in TEXT, f"{name} of {part.__name__} is not described"
