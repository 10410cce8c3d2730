"""The law of the stream: a snapshot and the deltas after it are the view, to the letter."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any, cast

from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.controller.views.station import OverrideFieldView, StationView, VariableView
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.server.stream.broadcast import difference
from sequence_planner.server.stream.messages import MAPS, Delta
from sequence_planner.texts.message import Sentence, Title, message
from support.example_view import example_view

EXAMPLE = example_view()
NAMES = st.sampled_from(["a", "b", "c", 'quote"', "", "é"])
VALUES = st.one_of(st.booleans(), st.integers(0, 2), st.sampled_from(["", "1", "true"]))
TIMES = st.floats(0, 1e10)
FIELDS = st.builds(
    OverrideFieldView,
    type=st.just("real"),
    between=st.none(),
    among=st.none() | st.lists(VALUES, max_size=2),
    value=st.none() | VALUES,
)


def apply(document: dict[str, Any], changed: dict[str, Any], removed: dict[str, list[str]]) -> dict[str, Any]:
    """What a page makes of a delta: the document after it."""
    result = dict(document)
    for name, value in changed.items():
        result[name] = {**document[name], **value} if name in MAPS else value
    for name, keys in removed.items():
        result[name] = {key: value for key, value in result[name].items() if key not in keys}
    return result


def entries(name: str) -> st.SearchStrategy[dict[str, Any]]:
    """Maps of entries that differ from each other in one member or two."""
    entry = next(iter(getattr(EXAMPLE, name).values()))
    member = {
        "resources": st.fixed_dictionaries({"online": st.booleans(), "awaited_topics": st.lists(NAMES, max_size=2)}),
        "variables": st.fixed_dictionaries({"value": st.none() | VALUES, "domain": st.lists(VALUES, max_size=2)}),
        "abilities": st.fixed_dictionaries({"enabled": st.none() | st.booleans()}),
        "operations": st.fixed_dictionaries({"completed": st.integers(0, 2)}),
        "jobs": st.fixed_dictionaries({"stopping": st.booleans(), "waits_for": st.lists(NAMES, max_size=2)}),
        "tasks": st.fixed_dictionaries({"revision": st.integers(0, 2)}),
        "topics": st.fixed_dictionaries({"messages": st.integers(0, 2), "last": st.none() | TIMES}),
        "overrides": st.fixed_dictionaries({"fields": st.dictionaries(NAMES, FIELDS, max_size=2)}),
        "approvals": st.fixed_dictionaries({"why": st.text(max_size=3), "until": TIMES}),
        "forces": st.fixed_dictionaries({"value": VALUES, "until": TIMES}),
        "undecided": st.fixed_dictionaries({"value": VALUES, "quiet": st.lists(VALUES, max_size=2)}),
        "breakpoints": st.fixed_dictionaries({"hits": st.integers(0, 2), "stopped": st.booleans()}),
        "alarms": st.fixed_dictionaries({"text": NAMES}),
    }[name]
    return st.dictionaries(NAMES, member.map(lambda update: entry.model_copy(update=update)), max_size=3)


VIEWS = st.fixed_dictionaries(
    {
        "tick": st.integers(0, 3),
        "time": TIMES,
        "mode": st.sampled_from(Mode),
        "production": st.sampled_from(Production),
        "plan": st.integers(0, 2).map(lambda count: EXAMPLE.plan.model_copy(update={"replanned": count})),
        "station": NAMES.map(lambda title: EXAMPLE.station.model_copy(update={"title": title})),
        **{name: entries(name) for name in MAPS},
    }
).map(lambda changes: EXAMPLE.model_copy(update=changes))


def text(document: object) -> str:
    """JSON, in which true and 1 are not the same."""
    return json.dumps(document, sort_keys=True)


@given(st.lists(VIEWS, min_size=2, max_size=4))
def test_a_snapshot_and_its_deltas_are_the_view(views: list[StationView]) -> None:
    document = json.loads(views[0].model_dump_json())
    for sequence, (old, new) in enumerate(pairwise(views), start=1):
        changed, removed = difference(old, new)
        delta = Delta(kind="delta", sequence=sequence, changed=changed, removed=removed).model_dump_json()
        said = json.loads(delta)
        document = apply(document, said["changed"], said["removed"])
        assert text(document) == text(json.loads(new.model_dump_json()))


@given(VIEWS)
def test_nothing_but_the_time_is_said_of_a_view_that_did_not_change(view: StationView) -> None:
    again = StationView.model_validate_json(view.model_dump_json())
    assert difference(view, again) == ({"time": view.time}, {})


@given(VIEWS, VIEWS)
def test_nothing_is_said_that_did_not_change(old: StationView, new: StationView) -> None:
    changed, removed = cast(tuple[dict[str, Any], dict[str, list[str]]], difference(old, new))
    for name in MAPS:
        before, after = getattr(old, name), getattr(new, name)
        said = changed.get(name, {})
        assert all(key not in before or text(before[key].model_dump()) != text(after[key].model_dump()) for key in said)
        assert set(removed.get(name, [])) == before.keys() - after.keys()


def test_true_is_not_one() -> None:
    def with_value(value: bool | int) -> StationView:
        pose = EXAMPLE.variables["robot.pose"].model_copy(update={"value": value})
        return example_view(variables={"robot.pose": pose})

    changed, _ = difference(with_value(True), with_value(1))
    variables = changed["variables"]
    assert isinstance(variables, dict)
    assert isinstance(variables["robot.pose"], VariableView)


def test_a_sentence_is_told_anew_whose_words_alone_are_others() -> None:
    """What an operation waits for is written as the model has it, whatever of it holds already."""
    (name, operation), *_ = EXAMPLE.operations.items()

    def waiting(words: str, title: str = "Pair") -> StationView:
        pair = Title("Pair", {"en": "Pair", "sv": title})
        until = message("sentence.until", conditions=[Sentence({"en": words}, "all pairs"), pair])
        return example_view(operations={name: operation.model_copy(update={"sentence": until})})

    before = waiting("pairs 4 to 6 are tight")
    assert difference(before, waiting("pairs 4 to 6 are tight")) == ({"time": before.time}, {})
    for after in (waiting("pair 6 is tight"), waiting("pairs 4 to 6 are tight", title="Par")):
        changed, _ = difference(before, after)
        assert changed["operations"] == after.operations


def test_a_delta_can_say_everything_that_a_view_can() -> None:
    whole = {name: getattr(EXAMPLE, name) for name in StationView.model_fields}
    delta = Delta(kind="delta", sequence=1, changed=whole, removed={name: ["a"] for name in MAPS})
    written = delta.model_dump(mode="json")
    assert written["changed"] == EXAMPLE.model_dump(mode="json")
    assert set(written["removed"]) == set(MAPS)
