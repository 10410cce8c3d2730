"""What the documentation shows is tried: its station loads, its expressions mean something, its errors are said."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.resolver import resolve_assignments, resolve_formula, resolve_predicate
from sequence_planner.language.syntax import ExpressionError
from sequence_planner.language.types import BOOLEAN
from sequence_planner.model.documents import (
    AbilityDocument,
    AlarmDocument,
    EffectDocument,
    OperationDocument,
    SpecificationDocument,
    StationDocument,
    TopicDocument,
    WorkMasterDocument,
    WorkStepDocument,
)
from sequence_planner.model.fields import DocumentPart
from sequence_planner.model.sequences import SequenceDocument
from sequence_planner.model.source import ModelError
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.places import DOCS, REPOSITORY
from support.station import finished

TEXT = "".join((DOCS / page).read_text(encoding="utf-8") for page in ("model.md", "expressions.md"))
BLOCKS = re.findall(r"^```(\w+) ?(.*)\n((?:.*\n)*?)```$", TEXT, re.MULTILINE)
ERRORS = re.findall(r"^\| `` (.*?) `` \| `` (\d+:\d+: .*) `` \|$", TEXT, re.MULTILINE)
SEQUENCE_ERRORS = re.findall(r"^\| `` (.*?) `` \| `` operations\.yaml:(\d+:\d+: .*) `` \|$", TEXT, re.MULTILINE)
EXPRESSION_ERRORS = re.findall(r"^\| `` (.*?) `` \| `` (\d+): (.*) `` \|$", TEXT, re.MULTILINE)
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
    documents = {"station.yaml", "operations.yaml", "specifications.yaml", "work_masters.yaml"}
    assert {*documents, "resources/clamp.yaml"} < FILES.keys()
    assert {kind for kind, _, _ in BLOCKS} == {"sh", "yaml", "text", "expression", "action", "formula"}
    assert len(ERRORS) >= 7
    assert len(SEQUENCE_ERRORS) >= 7
    assert len(EXPRESSION_ERRORS) >= 12


def test_the_station_of_the_page_works(automaton: Automaton) -> None:
    assert set(automaton.operations) == {"clamp_part", "inspect_side(left)", "inspect_side(right)", "release_part"}
    assert set(synthesise(automaton).guards) == {"clamp.close", "operator.load"}


def test_nothing_is_to_be_said_against_it(station: Path) -> None:
    found = finished("check", str(station))
    assert found.returncode == 0
    assert "warning" not in found.stdout + found.stderr


def scope_of(automaton: Automaton) -> NameScope:
    """What names mean in the clamp's document."""
    activities = {operation.activity: BOOLEAN for operation in automaton.operations.values()}
    return NameScope({**automaton.types, **activities}, ("clamp.",), vocabulary=automaton.vocabulary)


def test_expressions(automaton: Automaton) -> None:
    scope = scope_of(automaton)
    for text in lines_of("expression"):
        resolve_predicate(parse(text), scope)
    for text in lines_of("action"):
        resolve_assignments(parse_assignment(text), scope)
    for text in lines_of("formula"):
        resolve_formula(parse_formula(text), scope)


@pytest.mark.parametrize(("text", "column", "message"), EXPRESSION_ERRORS)
def test_wrong_expressions_are_refused_as_shown(automaton: Automaton, text: str, column: str, message: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        resolve_predicate(parse(text), scope_of(automaton))
    assert (caught.value.span.start + 1, caught.value.message) == (int(column), message)


def test_what_is_quoted_stands_there() -> None:
    quoted = [(label.removeprefix("from "), content) for _, label, content in BLOCKS if label.startswith("from ")]
    assert quoted
    for file, content in quoted:
        assert content in (REPOSITORY / file).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "line", "finding"),
    [
        *(("resources/clamp.yaml", *each) for each in ERRORS),
        *(("operations.yaml", *each) for each in SEQUENCE_ERRORS),
    ],
)
def test_errors_are_said_as_shown(station: Path, name: str, line: str, finding: str) -> None:
    file = station / name
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
    [
        StationDocument,
        TopicDocument,
        AbilityDocument,
        EffectDocument,
        OperationDocument,
        SequenceDocument,
        SpecificationDocument,
        WorkMasterDocument,
        AlarmDocument,
        WorkStepDocument,
    ],
    ids=lambda part: part.__name__,
)
def test_every_key_is_described(part: type[DocumentPart]) -> None:
    for name, field in part.model_fields.items():
        assert re.search(rf"`{field.alias or name}[`.]", TEXT), f"{name} of {part.__name__} is not described"


def lines_of(kind: str) -> list[str]:
    return [line for found, _, content in BLOCKS if found == kind for line in content.splitlines()]
