"""Maps and relations in expressions over records: the same as in conditions on variables."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.references.stations import of_folder
from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed, usages
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_calculation
from sequence_planner.language.printer import print_expression
from sequence_planner.language.records.expressions import Tables, read_calculation, read_condition
from sequence_planner.language.records.field_paths import TEXT
from sequence_planner.language.records.record import RecordType
from sequence_planner.language.resolver import resolve_predicate
from sequence_planner.language.shorthand.vocabulary import ValueMap, ValueRelation, Vocabulary
from sequence_planner.language.syntax import ExpressionError
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type
from sequence_planner.station import prepare_station

from .station_writing import Heard
from .test_tables_of_the_station import sent, tank

POSE = EnumerationType(("unknown", "home", "left", "right"))
NAMED = EnumerationType(("home", "left", "right"))
TOOL = EnumerationType(("none", "drill", "saw"))
VOCABULARY = Vocabulary(
    {"pose": POSE, "named": NAMED, "tool": TOOL},
    relations={
        "near": ValueRelation((NAMED, NAMED), frozenset({("home", "left"), ("left", "home"), ("right", "right")})),
        "arm.fits": ValueRelation((TOOL, NAMED), frozenset({("drill", "left"), ("saw", "right")})),
    },
    maps={
        "tool_at": ValueMap(NAMED, TOOL, {"home": "none", "left": "drill", "right": "saw"}),
        "beside": ValueMap(NAMED, NAMED, {"home": "left", "left": "right", "right": "home"}),
        "is_free": ValueMap(NAMED, BOOLEAN, {"home": True, "left": False, "right": False}),
        "arm.height": ValueMap(TOOL, IntegerRange(0, 9), {"none": 0, "drill": 3, "saw": 7}),
    },
)
FIELDS: Mapping[str, Type] = {"pose": POSE, "goal": NAMED, "held": TOOL, "on": BOOLEAN}
TABLES = Tables(VOCABULARY, ("arm.",))
SCOPE = NameScope({f"arm.{name}": type_ for name, type_ in FIELDS.items()}, ("arm.",), vocabulary=VOCABULARY)

PLACES = st.recursive(
    st.sampled_from(["pose", "goal", "home", "left"]),
    lambda inner: inner.map(lambda each: f"beside[{each}]"),
    max_leaves=3,
)
CONDITIONS = st.recursive(
    st.one_of(
        st.just("on"),
        PLACES.map(lambda each: f"is_free[{each}]"),
        st.builds("near({}, {})".format, PLACES, PLACES),
        st.builds("fits({}, {})".format, st.sampled_from(["held", "saw", "tool_at[goal]", "tool_at[pose]"]), PLACES),
        st.builds("tool_at[{}] {} held".format, PLACES, st.sampled_from(["==", "!="])),
        st.builds("tool_at[{}] in {{held, saw}}".format, PLACES),
        st.builds("height[held] + height[tool_at[{}]] {} 4".format, PLACES, st.sampled_from(["<", ">=", "=="])),
        st.builds("beside[{}] {} goal".format, PLACES, st.sampled_from(["==", "!="])),
    ),
    lambda inner: st.one_of(
        inner.map("not ({})".format),
        st.builds("({}) and ({})".format, inner, inner),
        st.builds("({}) or ({})".format, inner, inner),
        st.builds("({}) implies ({})".format, inner, inner),
    ),
    max_leaves=4,
)


@given(text=CONDITIONS)
def test_they_are_what_they_are_in_a_condition(text: str) -> None:
    """For all values, also those of which a map says nothing."""
    condition = resolve_predicate(parse(text), SCOPE)
    calculation = read_condition(text, FIELDS, TABLES)
    for values in product(*(type_.domain for type_ in FIELDS.values())):
        record = dict(zip(FIELDS, values, strict=True))
        troubles: list[str] = []
        found = calculation.value(record, troubles)
        assert found is evaluate(condition, {f"arm.{name}": value for name, value in record.items()}), record
        assert troubles == []


@given(text=CONDITIONS, unknown=st.sets(st.sampled_from(sorted(FIELDS)), min_size=1))
def test_what_is_unknown_stays_unknown_or_does_not_matter(text: str, unknown: set[str]) -> None:
    """An expression may know less than a condition, and never anything else."""
    condition = resolve_predicate(parse(text), SCOPE)
    record = {name: None if name in unknown else type_.domain[1] for name, type_ in FIELDS.items()}
    found = read_condition(text, FIELDS, TABLES).value(record, [])
    assert found in (None, evaluate(condition, {f"arm.{name}": value for name, value in record.items()}))


@given(text=CONDITIONS)
def test_what_is_printed_is_read_again(text: str) -> None:
    tree = parse_calculation(text)
    assert parse_calculation(print_expression(tree)) == tree


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("tool_at[goal]", "drill"),
        ("height[tool_at[goal]] * 2.5", 7.5),
        ("arm.height[saw]", 7),
        ("tool_at[pose]", None),
        ("is_free[pose]", False),
        ("near(word, goal)", True),
        ("tool_at[word] == none", True),
        ("near(other, goal)", False),
        ("tool_at[other] != none", False),
    ],
)
def test_their_values_in_a_record(text: str, expected: object) -> None:
    """A text that is no value is like a value of which nothing is said."""
    fields: RecordType = {**FIELDS, "word": TEXT, "other": TEXT}
    record = {"pose": "unknown", "goal": "left", "held": "saw", "on": True, "word": "home", "other": "moving"}
    assert read_calculation(text, fields, TABLES).value(record, []) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("‹neer(pose, goal)", "there is no relation `neer`; did you mean `near`?"),
        ("‹tool_at(pose)", "`tool_at` is a map: write `tool_at[pose]`"),
        ("‹near[pose, goal]", "`near` is a relation: write `near(pose, goal)`"),
        ("on and ‹near(pose)", "`near` has 2 arguments, found 1"),
        ("‹tool_at[pose, goal] == saw", "`tool_at` has 1 argument, found 2"),
        ("near(pose, ‹held)", "cannot compare one of {home, left, right} with one of {none, drill, saw}"),
        ("near(pose, ‹hme)", "no field `hme`"),
        ("‹tool_ad[pose] == saw", "no field `tool_ad`"),
        ("‹pose(goal)", "there is no relation `pose`"),
        ("tool_at[goal] == ‹home", "no field `home`"),
    ],
)
def test_what_is_refused_with_its_column(text: str, message: str) -> None:
    with pytest.raises(ExpressionError) as error:
        read_calculation(text.replace("‹", ""), FIELDS, TABLES)
    assert message in error.value.message
    assert error.value.span.start == text.index("‹")


TOPICS = """
topics:
  /tank/state:
    type: tank_msgs/msg/State
    direction: in
    pipeline:
      - expression: {opposite: "other[word]"}
  /tank/command:
    type: tank_msgs/msg/Command
    direction: out
    pipeline:
      - expression: {code: "code_of[wanted] + 1", far: "far(at, goal) and in_use[wanted]", height: "height_of[goal]"}
measured:
  at: {type: place, initial: store}
  opposite: {type: stop}
output:
  wanted: {type: drive}
  goal: {type: stop}
"""


def test_a_stage_of_a_station_asks_them(tmp_path: Path) -> None:
    ready = prepare_station(tank(tmp_path, TOPICS))
    message = sent(ready, {"wanted": "automatic", "at": "between", "goal": "store"})
    assert (message["code"], message["far"], message["height"]) == (5, True, -120)
    assert sent(ready, {"wanted": "off", "at": "between", "goal": "store"})["far"] is False
    heard = Heard(ready)
    assert heard.take("/tank/state", word="store", code=0, height=0)["tank.opposite"] == "bench"
    assert heard.take("/tank/state", word="nowhere", code=0, height=0)["tank.opposite"] is None


@pytest.mark.parametrize(("part", "new"), [("map:code_of", "number_of"), ("relation:far", "apart")])
def test_they_are_renamed_where_they_are_asked(tmp_path: Path, part: str, new: str) -> None:
    station = tank(tmp_path, TOPICS)
    files = of_folder(station)
    assert len(usages(files, parse_part(part)).found) == 2
    for name, text in renamed(files, parse_part(part), new).items():
        (station / name).write_text(str(text))
    prepare_station(station)


def test_values_among_their_arguments_are_found(tmp_path: Path) -> None:
    files = of_folder(tank(tmp_path, TOPICS.replace("far(at, goal)", "far(store, goal) and code_of[off] > 1")))
    for part in ("value:place.store", "value:drive.off"):
        found = usages(files, parse_part(part)).found
        assert "expression.far" in {".".join(map(str, each.path[-2:])) for each in found}, part
