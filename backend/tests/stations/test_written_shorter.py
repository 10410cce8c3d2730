"""A station that is written shorter means the same: its automaton is compared with that of the model it was before."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator, Mapping
from contextlib import nullcontext
from itertools import product
from math import prod
from pathlib import Path

import pytest

from golden.journals import model
from sequence_planner.automaton.automaton import Automaton, target
from sequence_planner.cli.model import new
from sequence_planner.core.immutable import Immutable
from sequence_planner.core.immutable import replace as with_fields
from sequence_planner.execution.record.recorder import model_digest
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.printer import print_expression
from sequence_planner.language.records.field_paths import domain
from sequence_planner.language.records.record import FieldType, ListType
from sequence_planner.language.shorthand.titles import Titles, in_language
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Assignment,
    BinaryTemporal,
    Expression,
    Or,
    UnaryTemporal,
    children,
    occurrences,
)
from sequence_planner.language.types import BooleanType, EnumerationType, Place, Type, Value
from sequence_planner.model.stages.base import Stage
from sequence_planner.model.stages.map import MapStage
from sequence_planner.model.stages.match import MemberNamesStage, MemberStage
from sequence_planner.pipelines.examples import bench_of
from sequence_planner.pipelines.graph import Chain, IncomingPipeline, OutgoingPipeline
from sequence_planner.station import ReadyStation, prepare_station

STATIONS = Path(__file__).parents[3] / "models"
BEFORE = Path(__file__).parent / "before"
MOST_STATES = 200_000
# Effects of the truck engine station by the names that they had when each was written out.
ONCE = {
    "feels_lf_tool": "feels_tool[AttachLFToolTCPPose]",
    "feels_nutrunner": "feels_tool[AttachAtlasTCPPose]",
    "feels_filter_tool": "feels_tool[AttachOFToolTCPPose]",
}

# What people were told before that has another name since: words alone, and no meaning.
CALLED = {
    "tool for the ladder frame": "frame tool",
    "tool for the oil filter": "filter tool",
    "home station": "place",
    "the scene": "the planning scene",
    "The tool must turn": "The nutrunner must turn",
    "The tool turns": "The nutrunner turns",
}

# By station, where it is now, and where it is as it was before: kept under its digest, or in a folder here.
TRUCK, TRUCK_BEFORE = "truck_engine_station", "29321a2f211e"
NOW = {
    TRUCK: STATIONS / TRUCK,
    "docking_agv": STATIONS / "docking_agv",
    "new": Path(new.__file__).parent / "templates" / "station",
}


@pytest.fixture(scope="module", params=NOW)
def stations(request: pytest.FixtureRequest) -> tuple[ReadyStation, ReadyStation]:
    with model(TRUCK_BEFORE) if request.param == TRUCK else nullcontext(BEFORE / request.param) as folder:
        before = prepare_station(folder)
    if request.param == TRUCK:
        assert model_digest(before.automaton).startswith(TRUCK_BEFORE)
    return before, prepare_station(NOW[request.param])


def test_its_pipelines_give_what_they_gave(stations: tuple[ReadyStation, ReadyStation]) -> None:
    """Whatever comes, one after the other: a message in all values that a stage looks at, and others at random."""
    before, now = stations
    compared = 0
    for side in ("incoming", "outgoing"):
        one, other = (getattr(each.pipelines, side) for each in stations)
        assert one.keys() == other.keys()
        for topic in one:
            first, second = (bench_of(topic, each.pipelines, each.automaton, each.registry) for each in stations)
            same = _variables(one[topic], before.automaton)
            assert same == _variables(other[topic], now.automaton)
            for at, given in enumerate(_whatever_comes(one[topic].chain, other[topic].chain)):
                for bench in (first, second):
                    bench.give(dict(given), float(at))
                came, comes = first.came(), second.came()
                names = same if side == "incoming" else came
                assert [came[name] for name in names] == [comes[name] for name in names], (topic, given)
                assert (first.trouble is None) == (second.trouble is None), (topic, given)
                compared += 1
    assert compared > 500 or before.automaton.name != TRUCK


def _variables(pipeline: IncomingPipeline | OutgoingPipeline, automaton: Automaton) -> list[str]:
    """The variables that a pipeline writes, by their names in the record; of an outgoing one all have to be alike."""
    if isinstance(pipeline, IncomingPipeline):
        return sorted(writing.field for writing in pipeline.writings)
    return sorted(name for name in pipeline.read if name in automaton.variables)


def _whatever_comes(*chains: Chain) -> list[dict[str, object]]:
    """Records with all values of what stages look at, in two orders; the other truth values are whatever they are."""
    chance = random.Random(1)
    fields = dict(chains[0].fields[0])
    texts = sorted({text for chain in chains for stage in chain.stages for text in _texts_of(stage)})
    looked_at = {name for chain in chains for stage in chain.stages for name in stage.reads if name in fields}
    values = {name: _some_values(fields[name], texts) for name in sorted(looked_at)}
    all_of_them = [dict(zip(values, each, strict=True)) for each in product(*values.values())]
    others = [name for name, type_ in fields.items() if isinstance(type_, BooleanType) and name not in looked_at]
    records = all_of_them + chance.sample(all_of_them, len(all_of_them))
    return [{**each, **{name: chance.random() < 0.5 for name in others}} for each in records]


def _texts_of(stage: Stage) -> list[str]:
    """The texts that a stage tells apart."""
    if isinstance(stage, MemberStage):
        return [str(stage.item)]
    if isinstance(stage, MemberNamesStage):
        return list(stage.names)
    return [str(key) for key, _ in stage.pairs] if isinstance(stage, MapStage) else []


def _some_values(type_: FieldType, texts: list[str]) -> list[object]:
    if isinstance(type_, ListType):
        items = [*texts, "anything"]
        return [
            [item for item, is_in in zip(items, each, strict=True) if is_in]
            for each in product((0, 1), repeat=len(items))
        ]
    return list(domain(type_) or [*texts, "moving"])


def test_it_means_what_it_meant(stations: tuple[ReadyStation, ReadyStation]) -> None:
    before, now = (each.automaton for each in stations)
    assert {each: _plain(variable.type) for each, variable in now.variables.items()} == {
        each: _plain(variable.type) for each, variable in before.variables.items()
    }
    assert {each: (v.kind, v.initial, v.resource) for each, v in now.variables.items()} == {
        each: (v.kind, v.initial, v.resource) for each, v in before.variables.items()
    }
    for table in ("abilities", "operations", "specifications", "work_masters", "alarms"):
        _assert_same(getattr(before, table), getattr(now, table), table, now.titles)
    first, second = ({_renamed(effect.name): effect for effect in each.effects} for each in (before, now))
    for name, effect in second.items():
        second[name] = with_fields(effect, name=first[name].name if name in first else effect.name)
    _assert_same(first, second, "effects", now.titles)
    _assert_same({"rest": before.rest}, {"rest": now.rest}, "rest", now.titles)


def _renamed(effect: str) -> str:
    """What an effect is called now that is written once for several."""
    ability, _, name = effect.rpartition(".")
    return f"{ability}.{ONCE.get(name, name)}"


def _with_titles(text: str, titles: Titles) -> str:
    """A text for people in which values are told by their titles."""
    for words in titles.values.values():
        for value in sorted(map(str, words), key=len, reverse=True):
            said = in_language(words[value], "en") or value
            text = re.sub(rf"\b(?:{value}|{value.replace('_', ' ')})\b", said, text)
    return text


def _assert_same(before: Mapping[str, object], now: Mapping[str, object], what: str, titles: Titles) -> None:
    assert before.keys() == now.keys(), what
    for name, part in before.items():
        _assert_alike(part, now[name], f"{what} {name}", titles)


def _assert_alike(before: object, now: object, where: str, titles: Titles) -> None:
    """Two values are equal, where expressions within them need only have the same value in each state."""
    if before == now or (isinstance(before, Place) and isinstance(now, Place)):
        return
    if isinstance(before, Expression) and isinstance(now, Expression):
        _assert_equivalent(before, now, where)
    elif _are_actions(before) and _are_actions(now):
        first, second = _by_target(before), _by_target(now)
        assert first.keys() == second.keys(), where
        for name, action in first.items():
            _assert_alike(action.value, second[name].value, f"{where}: {name}", titles)
            _assert_equivalent(action.condition or TRUE, second[name].condition or TRUE, f"{where}: {name} if")
    else:
        assert isinstance(before, Immutable), f"{where}: {before} is {now} now"
        assert type(before) is type(now), where
        for field in before._compared:  # of what takes no part in a comparison nothing is asked either
            one, other = getattr(before, field), getattr(now, field)
            if field in ("title", "text") and isinstance(one, str):  # values are told by the titles that they have now
                for named, called in CALLED.items():
                    one = one.replace(named, called)
                assert other in (one, _with_titles(one, titles)), f"{where}.{field}: {one} is {other} now"
            else:
                _assert_alike(one, other, f"{where}.{field}", titles)


def _are_actions(value: object) -> bool:
    return isinstance(value, tuple) and all(isinstance(each, Assignment) for each in value)


def _by_target(actions: object) -> dict[str, Assignment]:
    assert isinstance(actions, tuple)
    return {target(each): each for each in actions}


def _assert_equivalent(before: Expression, now: Expression, where: str) -> None:
    if print_expression(before) == print_expression(now):
        return
    if isinstance(before, UnaryTemporal | BinaryTemporal):
        assert type(before) is type(now), where
        for one, other in zip(children(before), children(now), strict=True):
            _assert_equivalent(one, other, where)
        return
    if not _is_small(before, now) and _has_parts_alike(before, now):
        for one, other in zip(_operands(before), _operands(now), strict=True):
            _assert_equivalent(one, other, where)
        return
    types = _read_types(before, now)
    assert _is_small(before, now), f"{where} reads too much to compare"
    for state in _states(types):
        assert evaluate(before, state) == evaluate(now, state), f"{where} differs where {state}"


def _has_parts_alike(before: Expression, now: Expression) -> bool:
    """Whether both are of one connective and as many parts: where each pair is equivalent, they are."""
    return type(before) is type(now) and len(_operands(before)) == len(_operands(now)) > 0


def _operands(expression: Expression) -> tuple[Expression, ...]:
    return expression.operands if isinstance(expression, And | Or) else ()


def _read_types(*expressions: Expression) -> dict[str, Type]:
    return {each.name: each.type for expression in expressions for each in occurrences(expression)}


def _is_small(*expressions: Expression) -> bool:
    return prod(len(type_.domain) for type_ in _read_types(*expressions).values()) <= MOST_STATES


def _states(types: Mapping[str, Type]) -> Iterator[dict[str, Value | None]]:
    for values in product(*(type_.domain for type_ in types.values())):
        yield dict(zip(types, values, strict=True))


def _plain(type_: Type) -> object:
    """A type without the order of its values, but for the first: that is the one that a variable has at first."""
    return (type_.values[0], frozenset(type_.values)) if isinstance(type_, EnumerationType) else type_
