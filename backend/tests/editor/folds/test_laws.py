"""A fold that is offered means the same: over random stations, each state and each choice of unknown values."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from itertools import product
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from language.trees import predicates
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.editor.draft import applied
from sequence_planner.editor.folds.finder import FoldFinder
from sequence_planner.editor.folds.sameness import are_equivalent, difference
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import Expression, occurrences
from sequence_planner.language.types import Type, Value
from sequence_planner.model.files import write_files
from sequence_planner.station import read_station
from support.examples import examples

STATION = """\
name: cell # what is said of it stays
enumerations:
  part: [p1, p2, p3]
  pose: [home, left, right, out]
  state: [empty, placed]
estimated:
  # One for each part.
  bolts: {for: {where: part}, type: state}
  at: {type: pose}
  to: {type: pose}
  ready: {for: {which: part}, type: bool}
"""
PARTS, POSES = ("p1", "p2", "p3"), ("home", "left", "right", "out")


def _joined(parts: SearchStrategy[list[str]]) -> SearchStrategy[str]:
    return st.tuples(parts, st.sampled_from([" and ", " or "])).map(lambda each: f"({each[1].join(each[0])})")


def _of_each(said: str) -> SearchStrategy[str]:
    """Something said of some parts, in some order, or of all of them."""
    some = st.lists(st.sampled_from(PARTS), min_size=2, max_size=3, unique=True)
    return _joined(st.one_of(some, st.permutations(PARTS)).map(lambda parts: [said.format(each) for each in parts]))


_lists = st.tuples(
    st.sampled_from(["at", "to"]), st.lists(st.sampled_from(POSES), min_size=2, max_size=3, unique=True)
).map(lambda each: f"{each[0]} in {{{', '.join(each[1])}}}")
_cases = st.tuples(
    st.sampled_from([("==", " or "), ("!=", " and "), ("==", " and ")]),
    st.lists(st.sampled_from(POSES), min_size=2, max_size=4, unique=True),
).map(lambda each: "(" + each[0][1].join(f"at {each[0][0]} {value}" for value in each[1]) + ")")
_pairs = st.lists(st.tuples(st.sampled_from(POSES), st.sampled_from(POSES)), min_size=2, max_size=5, unique=True).map(
    lambda pairs: "(" + " or ".join(f"at == {one} and to == {other}" for one, other in pairs) + ")"
)
_leaves = st.one_of(
    st.sampled_from(
        ["bolts[{}] == placed", "not ready[{}]", "bolts[{0}] == empty and ready[{0}]", "(ready[{0}] or ready[{0}])"]
    ).flatmap(_of_each),
    _lists,
    _cases,
    _pairs,
    st.just("at != home"),
)
_conditions = st.recursive(_leaves, lambda parts: _joined(st.lists(parts, min_size=2, max_size=3)), max_leaves=4)


@st.composite
def stations(draw: st.DrawFn) -> dict[str, str]:
    """Stations whose conditions have parts in common, as those of people have."""
    known = draw(st.lists(_conditions, min_size=1, max_size=3))
    written = st.lists(st.sampled_from(known), min_size=1, max_size=2).map(" and ".join)
    operations = "".join(
        f"o{number}:\n  precondition: >-\n    {draw(written)}\n  goal: {draw(written)} # stays\n" for number in range(3)
    )
    return {"station.yaml": STATION, "operations.yaml": operations}


@given(stations())
@examples(15, least=4)
def test_whatever_is_offered_means_the_same(files: dict[str, str]) -> None:
    before = _read(files)
    with tempfile.TemporaryDirectory() as folder:
        for fold in FoldFinder(Path(folder)).folds(files).folds:
            after = applied(files, fold.edits)
            assert {**files, **fold.files} == after
            assert "# what is said of it stays" in after["station.yaml"]
            assert after["operations.yaml"].count("# stays") == 3
            now = _read(after)
            for name, operation in before.operations.items():
                _assert_same(operation.precondition, now.operations[name].precondition)
                _assert_same(operation.goal, now.operations[name].goal)


@given(stations(), st.data())
@examples(6)
def test_one_after_the_other_until_nothing_is_left(files: dict[str, str], data: st.DataObject) -> None:
    before, number = _read(files), 0
    with tempfile.TemporaryDirectory() as folder:
        finder = FoldFinder(Path(folder))
        while folds := finder.folds(files).folds:
            files = {**files, **data.draw(st.sampled_from(folds)).files}
            number += 1
            assert number < 30
    assert difference(before, _read(files)) is None


@given(predicates, predicates)
@examples(300)
def test_what_counts_as_equivalent_has_one_value_in_each_state(one: Expression, other: Expression) -> None:
    names = {each.name: each.type for each in (*occurrences(one), *occurrences(other))}
    if len(names) > 4:
        return
    same = all(evaluate(one, state) == evaluate(other, state) for state in _states(names))
    assert are_equivalent(one, other) <= same
    assert are_equivalent(one, one)


def _assert_same(before: Expression, now: Expression) -> None:
    types = {each.name: each.type for each in (*occurrences(before), *occurrences(now))}
    for state in _states(types):
        assert evaluate(before, state) == evaluate(now, state), state


def _states(types: Mapping[str, Type]) -> Iterator[dict[str, Value | None]]:
    domains = [(None, *type_.domain) for type_ in types.values()]
    return (dict(zip(types, values, strict=True)) for values in product(*domains))


def _read(files: dict[str, str]) -> Automaton:
    with tempfile.TemporaryDirectory() as folder:
        write_files(files, Path(folder))
        return read_station(Path(folder)).automaton


RESOURCE = """\
output:
  on: {type: bool}
abilities:
  empty:
    enabled: not on
    start:
      do:
        - on := true
        # All of them.
        - bolts[p2] := empty if at != home and ready[p2]
        - bolts[p1] := empty if at != home and ready[p1]
        - bolts[p3] := empty if at != home and ready[p3]
        - ready[p1] := false
        - ready[p2] := false # and this
        - ready[p3] := false
        - at := home
"""


def test_actions_for_each_value_are_one() -> None:
    files = {"station.yaml": STATION, "resources/arm.yaml": RESOURCE}
    with tempfile.TemporaryDirectory() as folder:
        (found,) = FoldFinder(Path(folder)).folds(files).folds
    assert (
        found.files["resources/arm.yaml"].partition("do:\n")[2]
        == """\
        - on := true
        # All of them.
        - 'all p in part: bolts[p] := empty if at != home and ready[p]'
        - ready[p1] := false
        - ready[p2] := false # and this
        - ready[p3] := false
        - at := home
"""
    )
    assert difference(_read(files), _read({**files, **found.files})) is None


def test_formulas_are_folded_where_they_are_about_a_state() -> None:
    formula = "G (ready[p1] and ready[p2] and ready[p3] implies at != home) and (F bolts[p1] == placed and F ready[p2])"
    operation = f"precondition: at == home\n  goal: at == out\n  local: {formula}"
    files = {"station.yaml": STATION, "operations.yaml": f"one:\n  {operation}\ntwo:\n  {operation}\n"}
    with tempfile.TemporaryDirectory() as folder:
        found = FoldFinder(Path(folder)).folds(files).folds
    assert [fold.title for fold in found if fold.kind is FoldKind.QUANTIFIER] == [
        "Write `all which in part: ready[which]`"
    ]
    for fold in found:
        assert difference(_read(files), _read({**files, **fold.files})) is None


def test_each_kind_is_found() -> None:
    conditions = (
        "bolts[p1] == placed and bolts[p3] == placed and bolts[p2] == placed and at in {left, right, out}",
        "to in {left, right, out} and (at == home and to in {left, right} or at == left and to in {home, out} "
        "or at == out and to in {right, left} or to == out and at == right or at == right and to == home)",
        "ready[p1] and not (bolts[p1] == empty and ready[p2]) and at != home",
        "to == left or ready[p1] and not (bolts[p1] == empty and ready[p2]) and at != home",
    )
    operations = "".join(f"o{n}: {{precondition: '{each}', goal: '{each}'}}\n" for n, each in enumerate(conditions))
    with tempfile.TemporaryDirectory() as folder:
        found = FoldFinder(Path(folder)).folds({"station.yaml": STATION, "operations.yaml": operations}).folds
    assert {fold.kind for fold in found} == {
        FoldKind.QUANTIFIER,
        FoldKind.SET,
        FoldKind.PREDICATE,
        FoldKind.RELATION,
    }
    (relation,) = (fold for fold in found if fold.kind is FoldKind.RELATION)
    assert (
        "o1: {precondition: 'to in {left, right, out} and belong_together(at, to)'" in relation.files["operations.yaml"]
    )
    assert "  belong_together:\n    between: [pose, pose]\n    symmetric: true\n" in relation.files["station.yaml"]
