"""What the documentation shows is tried: its station loads, its expressions mean something, its errors are said."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.parser import parse, parse_assignment
from sequence_planner.expressions.resolution import Scope, resolve_assignment, resolve_predicate
from sequence_planner.expressions.syntax import ExpressionError
from sequence_planner.model.documents import (
    AbilityDocument,
    DocumentPart,
    EffectDocument,
    StageDocument,
    StationDocument,
    TopicDocument,
)
from sequence_planner.model.source import ModelError
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.enumeration import synthesise

REPOSITORY = Path(__file__).parents[2]
TEXT = (REPOSITORY / "docs" / "model.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+) ?(.*)\n((?:.*\n)*?)```$", TEXT, re.MULTILINE)
ERRORS = re.findall(r"^\| `` (.*?) `` \| `` (\d+:\d+: .*) `` \|$", TEXT, re.MULTILINE)
FILES = {label: content for kind, label, content in BLOCKS if kind in ("yaml", "text") and " " not in label}


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


def test_there_is_something_to_try() -> None:
    assert {"station.yaml", "resources/clamp.yaml", "operations.yaml", "specifications.yaml"} < FILES.keys()
    assert {kind for kind, _, _ in BLOCKS} == {"sh", "yaml", "text", "expression", "action"}
    assert len(ERRORS) >= 8


def test_the_station_of_the_page_works(automaton: Automaton) -> None:
    assert set(automaton.operations) == {"clamp_part", "inspect_side(left)", "inspect_side(right)", "release_part"}
    assert set(synthesise(automaton).guards) == {"clamp.close", "operator.load"}


def test_expressions(automaton: Automaton) -> None:
    scope = Scope(automaton.types, ("clamp.",))
    for text in lines_of("expression"):
        resolve_predicate(parse(text), scope)
    for text in lines_of("action"):
        resolve_assignment(parse_assignment(text), scope)
    with pytest.raises(ExpressionError, match=r"expected an integer in 0\.\.3"):
        resolve_assignment(parse_assignment("count := count + 1 if count < 3"), scope)


def test_what_is_quoted_stands_there() -> None:
    quoted = [(label.removeprefix("from "), content) for _, label, content in BLOCKS if label.startswith("from ")]
    assert quoted
    for file, content in quoted:
        assert content in (REPOSITORY / file).read_text(encoding="utf-8")


@pytest.mark.parametrize(("line", "finding"), ERRORS)
def test_errors_are_said_as_shown(station: Path, line: str, finding: str) -> None:
    file = station / "resources" / "clamp.yaml"
    lines = file.read_text(encoding="utf-8").split("\n")
    number = int(finding.partition(":")[0]) - 1
    indentation = len(lines[number]) - len(lines[number].lstrip())
    lines[number] = " " * indentation + line
    file.write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(ModelError) as caught:
        prepare_station(station)
    assert f"{file}:{finding}" in str(caught.value).split("\n")


@pytest.mark.parametrize(
    "part",
    [StationDocument, TopicDocument, StageDocument, AbilityDocument, EffectDocument],
    ids=lambda part: part.__name__,
)
def test_every_key_is_described(part: type[DocumentPart]) -> None:
    for name, field in part.model_fields.items():
        assert re.search(rf"`{field.alias or name}[`.]", TEXT), f"{name} of {part.__name__} is not described"


def lines_of(kind: str) -> list[str]:
    return [line for found, _, content in BLOCKS if found == kind for line in content.splitlines()]
