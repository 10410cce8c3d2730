"""The order of operations as people see it: what comes after what and why, and whose lane each is in."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import JsonValue

from sequence_planner.automaton.automaton import Automaton, GroupKind, OperationGroup
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.sequences.order import LinkKind, OperationLink, lanes_of, links_of
from sequence_planner.editor.draft import AddEntry, SetEntry, applied
from sequence_planner.language.printer import print_expression
from sequence_planner.model.loader import load_station
from sequence_planner.station import prepare_station
from support.places import MODELS

STATION = """
name: engine
enumerations: {pair: [p1, p2, p3]}
estimated:
  frame: {type: 0..3}
  gone: {type: bool}
  bolts: {for: {p: pair}, type: 0..2}
"""
PAIRS = ("p1", "p2", "p3")


def station(folder: Path, operations: str, masters: str = "", estimated: str = "") -> Automaton:
    """A station with these operations."""
    texts = {"station": STATION + estimated, "operations": operations, "work_masters": masters}
    for name, text in texts.items():
        if text:
            (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    return ground(load_station(folder))


def told(link: OperationLink) -> str:
    """A link as a line: what comes before what, and what says so."""
    reasons = [
        f"{each.kind} {each.name}".strip()
        if each.condition is None
        else f"{each.kind} {print_expression(each.condition)}"
        for each in link.reasons
    ]
    return f"{link.before} {'~' if link.again else '-'} {link.after}: {', '.join(reasons)}"


@pytest.mark.parametrize(
    ("operations", "expected"),
    [
        # What a goal makes true for certain, and what it may make true.
        (
            "a: {precondition: not gone, goal: frame == 1}\nb: {precondition: frame > 0, goal: gone}",
            ["a - b: condition frame > 0"],
        ),
        (
            "a: {precondition: not gone, goal: frame > 0}\nb: {precondition: frame == 2, goal: gone}",
            ["a - b: chance frame == 2"],
        ),
        # Where one is sure, those that may are not told; what holds at first needs nobody.
        (
            "a: {precondition: true, goal: frame > 0}\nb: {precondition: true, goal: frame == 2}\n"
            "c: {precondition: frame == 2 and not gone, goal: gone}",
            ["b - c: condition frame == 2"],
        ),
        # What follows by way of a third is left out, and who makes true what was made true before is not told.
        (
            "a: {precondition: true, goal: frame == 1}\nb: {precondition: frame == 1, goal: frame == 2}\n"
            "c: {precondition: frame == 2, goal: gone}\nd: {precondition: frame > 0 and gone, goal: 'bolts[p1] == 1'}",
            ["a - b: condition frame == 1", "b - c: condition frame == 2", "c - d: condition gone"],
        ),
        # A sequence is told, whatever else says it.
        (
            "a: {precondition: true, goal: frame == 1}\nb: {precondition: frame == 1, goal: gone}\n"
            "s: {sequence: [a, b]}",
            ["a - b: sequence s, condition frame == 1"],
        ),
        # A circle is gone round again: the weakest link of it goes back.
        (
            "a: {precondition: frame == 0 and gone, goal: frame == 1}\nb: {precondition: frame == 1, goal: gone}\n"
            "s: {sequence: [a, b]}",
            ["a - b: sequence s, condition frame == 1", "b ~ a: condition gone"],
        ),
        # Several any of which will do.
        (
            "tighten: {parameters: {p: pair}, precondition: true, goal: 'bolts[p] == 2'}\n"
            "b: {precondition: 'any p in pair: bolts[p] == 2', goal: gone}",
            [f"tighten({p}) - b: condition {' or '.join(f'bolts[{q}] == 2' for q in PAIRS)}" for p in PAIRS],
        ),
    ],
)
def test_what_comes_after_what(tmp_path: Path, operations: str, expected: list[str]) -> None:
    assert [told(link) for link in links_of(station(tmp_path, operations))] == expected


def test_a_work_master_puts_its_steps_in_order(tmp_path: Path) -> None:
    operations = "".join(f"{name}: {{precondition: true, goal: gone}}\n" for name in "abc")
    links = links_of(station(tmp_path, operations, "engine: {sequence: [a, b, c]}\n"))
    assert [told(link) for link in links] == ["a - b: work_master engine", "b - c: work_master engine"]


def test_what_sequences_put_beside_one_another_is_told_with_what_says_so(tmp_path: Path) -> None:
    """A sequence that stands in another is told once, and one part of it alone puts nothing beside anything."""
    operations = (
        "\n".join(f"{name}: {{precondition: not gone, goal: gone}}" for name in "abcd")
        + """
place: {parameters: {p: pair}, precondition: not gone, goal: "bolts[p] == 1"}
both: {sequence: [a, {alternative: [b, {sequence: [c, d]}]}, {arbitrary: [{for: {p: pair}, parallel: place(p)}]}]}
all: {sequence: both}
"""
    )
    found = station(tmp_path, operations, "job: {arbitrary: [a, b]}").groups
    places = tuple(f"place({each})" for each in PAIRS)
    assert found == (
        OperationGroup(GroupKind.ALTERNATIVE, ("b", "c", "d"), "all", for_jobs=False),
        OperationGroup(GroupKind.PARALLEL, places, "all", for_jobs=False),
        OperationGroup(GroupKind.ARBITRARY, ("a", "b"), "job", for_jobs=True),
    )


WORDS = "abcdef"


@st.composite
def orders(draw: st.DrawFn) -> tuple[list[JsonValue], list[JsonValue]]:
    """A plain sequence, and the same with some that follow on one another put beside one another."""
    names = draw(st.lists(st.sampled_from(WORDS), min_size=2, unique=True))
    first = draw(st.integers(0, len(names) - 2))
    last = draw(st.integers(first + 2, len(names)))
    kind = draw(st.sampled_from([each.value for each in GroupKind]))
    picked = draw(st.permutations(names[first:last]))
    return [*names], [*names[:first], {kind: [*picked]}, *names[last:]]


@given(orders())
def test_a_group_written_by_an_edit_means_what_is_written_by_hand(
    order: tuple[list[JsonValue], list[JsonValue]],
) -> None:
    """As the page does it: the list is set anew, or another sequence is added; all else stays as it is written."""
    names, grouped = order
    head = "# Done by hand.\n" + "\n".join(
        f"{name}: {{precondition: not gone, goal: frame == 1}}  # {name}" for name in WORDS
    )
    written = f"{head}\nwork:\n  title: Work  # for people\n  sequence: {json.dumps(names)}\n"
    by_hand = f"{head}\nwork: {{title: Work, sequence: {json.dumps(grouped)}}}\n"
    edited = applied(
        {"operations.yaml": written},
        [SetEntry(file="operations.yaml", path=["work", "sequence"], was=names, value=grouped)],
    )["operations.yaml"]
    assert edited.startswith(f"{head}\nwork:\n  title: Work  # for people\n")
    added = applied(
        {"operations.yaml": f"{head}\n"},
        [AddEntry(file="operations.yaml", path=["work"], value={"title": "Work", "sequence": grouped})],
    )["operations.yaml"]
    assert added.startswith(head)
    with TemporaryDirectory() as folder:
        meant = [station(Path(folder), each) for each in (by_hand, edited, added)]
    assert meant[0] == meant[1] == meant[2]
    assert meant[0].groups == meant[1].groups == meant[2].groups != ()


def test_a_goal_of_very_many_valuations_says_nothing_of_the_order(tmp_path: Path) -> None:
    more = "".join(f"  v{number}: {{type: 0..9}}\n" for number in range(5))
    goal = " + ".join(f"v{number}" for number in range(5))
    operations = f"a: {{precondition: true, goal: {goal} == 45}}\nb: {{precondition: v0 == 9, goal: gone}}\n"
    assert links_of(station(tmp_path, operations, estimated=more)) == ()


@given(st.lists(st.sampled_from("abcdef"), min_size=2, max_size=6, unique=True))
def test_links_that_do_not_go_back_make_no_circle_whatever_is_needed(
    tmp_path_factory: pytest.TempPathFactory, ring: list[str]
) -> None:
    """Each needs what the one before it does, and the first what the last does."""
    variables = "".join(f"  v_{name}: {{type: bool}}\n" for name in ring)
    steps = [*pairwise(ring), (ring[-1], ring[0])]
    operations = "".join(f"{after}: {{precondition: v_{before}, goal: v_{after}}}\n" for before, after in steps)
    links = links_of(station(tmp_path_factory.mktemp("ring"), operations, estimated=variables))
    assert {(link.before, link.after) for link in links} == set(steps)
    assert sum(link.again for link in links) == 1


def test_the_order_of_the_truck_engine_station() -> None:
    automaton = prepare_station(MODELS / "truck_engine_station").automaton
    links = links_of(automaton)
    surely = {
        (link.before.partition("(")[0], link.after.partition("(")[0])
        for link in links
        if not link.again and any(each.kind is not LinkKind.CHANCE for each in link.reasons)
    }
    assert surely == {
        ("identify_engine", "bring_kit"),
        ("bring_kit", "mount_ladder_frame"),
        ("take_lf_tool", "mount_ladder_frame"),
        ("mount_ladder_frame", "place_bolt_pair"),
        ("mount_ladder_frame", "take_nutrunner"),
        ("place_bolt_pair", "tighten_bolt_pair"),
        ("place_bolt_pair", "return_kit"),
        ("take_nutrunner", "tighten_bolt_pair"),
        ("tighten_bolt_pair", "tighten_bolt_pair"),
        ("tighten_bolt_pair", "take_filter_tool"),
        ("take_filter_tool", "tighten_oil_filter"),
        ("tighten_oil_filter", "release_engine"),
        ("return_kit", "release_engine"),
    }
    lanes = {name.partition("(")[0]: lane for name, lane in lanes_of(automaton).items()}
    assert lanes == {
        "identify_engine": "engine",
        "bring_kit": "agv",
        "return_kit": "agv",
        "take_lf_tool": "end_effector",
        "take_nutrunner": "end_effector",
        "take_filter_tool": "end_effector",
        "mount_ladder_frame": "end_effector",
        "place_bolt_pair": "operator",
        "tighten_bolt_pair": "nutrunner",
        "tighten_oil_filter": "robot",
        "release_engine": "engine",
    }


def test_what_no_ability_brings_about_is_in_the_lane_of_its_variable_or_of_the_station(tmp_path: Path) -> None:
    (tmp_path / "resources").mkdir()
    (tmp_path / "resources" / "door.yaml").write_text("measured: {is_open: {type: bool}}\n", encoding="utf-8")
    operations = "a: {precondition: true, goal: door.is_open}\nb: {precondition: true, goal: gone}\n"
    assert lanes_of(station(tmp_path, operations)) == {"a": "door", "b": None}
