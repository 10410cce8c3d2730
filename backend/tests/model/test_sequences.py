"""Sequences of operations: what each form adds to preconditions and to jobs, and what is said of those that are wrong.

That this allows the orders a sequence stands for, and no others, is a law of `core/test_sequences`.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from shutil import copytree

import pytest

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.execution.record.recorder import model_digest
from sequence_planner.language.printer import print_expression
from sequence_planner.model.loader import load_station
from sequence_planner.model.source import ModelError
from sequence_planner.station import prepare_station
from support.places import MODELS

STATION = """
name: engine
enumerations: {pair: [p1, p2, p3]}
estimated:
  laid: {type: bool}
  seen: {type: bool}
  felt: {type: bool}
  gone: {type: bool}
  bolts: {for: {p: pair}, type: 0..2}
"""
OPERATIONS = """\
lay: {precondition: not gone, goal: laid}
place: {parameters: {p: pair}, precondition: "bolts[p] == 0", goal: "bolts[p] == 1"}
tighten: {parameters: {p: pair}, precondition: "bolts[p] == 1", goal: "bolts[p] == 2"}
look: {precondition: not gone, goal: seen}
feel: {precondition: laid, goal: felt}
leave: {precondition: true, goal: gone}
"""


def station(folder: Path, sequences: str, masters: str = "") -> Automaton:
    """The engine's operations with these entries below them."""
    for name, text in {"station": STATION, "operations": OPERATIONS + sequences, "work_masters": masters}.items():
        if text:
            (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    return ground(load_station(folder))


def preconditions(automaton: Automaton) -> dict[str, str]:
    """Those that are more than what is written."""
    return {name: print_expression(each.precondition) for name, each in automaton.operations.items() if each.turns}


@pytest.mark.parametrize(
    ("sequence", "expected"),
    [
        ("s: {sequence: [lay, leave]}", {"leave": "laid"}),
        ("s: {sequence: lay}", {}),
        ("s: {parallel: [lay, look]}", {}),
        (
            "s: {sequence: [lay, {parallel: [look, feel]}, leave]}",
            {"look": "not gone and laid", "feel": "laid", "leave": "seen and felt"},
        ),
        (
            "s: {for: {p: pair}, sequence: tighten(p)}",
            {"tighten(p2)": "bolts[p2] == 1 and bolts[p1] == 2", "tighten(p3)": "bolts[p3] == 1 and bolts[p2] == 2"},
        ),
        (
            "s: {sequence: [{for: {p: pair}, parallel: {sequence: [place(p), tighten(p)]}}, leave]}",
            {
                **{f"tighten({p})": f"bolts[{p}] == 1" for p in ("p1", "p2", "p3")},
                "leave": "bolts[p1] == 2 and bolts[p2] == 2 and bolts[p3] == 2",
            },
        ),
        (
            "s: {sequence: [{alternative: [look, feel]}, leave]}",
            {
                "look": "not gone and not (operation.feel.active or felt)",
                "feel": "laid and not (operation.look.active or seen or not gone and not seen)",
                "leave": "seen or felt",
            },
        ),
        (
            "s: {arbitrary: [look, {sequence: [lay, feel]}]}",
            {
                "look": "not gone and "
                "not (operation.lay.active or operation.feel.active or (laid or felt) and not felt)",
                "lay": "not gone and not (operation.look.active or not gone and not seen)",
                "feel": "laid",
            },
        ),
        (
            "whole: {sequence: [begin, leave]}\nbegin: {sequence: [lay, look]}",
            {"look": "not gone and laid", "leave": "seen"},
        ),
        ("s: {sequence: [lay, leave]}\nt: {sequence: [look, leave]}", {"leave": "laid and seen"}),
    ],
)
def test_what_is_added_to_preconditions(tmp_path: Path, sequence: str, expected: dict[str, str]) -> None:
    automaton = station(tmp_path, sequence)
    assert preconditions(automaton) == expected
    read = set(automaton.names(Kind.ACTIVITY))
    assert read == {
        f"operation.{name}.active" for name in automaton.operations if f"operation.{name}.active" in str(expected)
    }


def test_a_sequence_that_adds_nothing_new_changes_nothing(tmp_path: Path) -> None:
    """Each pair is placed before it is tightened, as the preconditions say already."""
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    with_it = station(tmp_path / "a", "s: {for: {p: pair}, parallel: {sequence: [place(p), tighten(p)]}}")
    assert with_it == station(tmp_path / "b", "")


JOB = """\
m:
  title: Engine
  sequence:
    - lay
    - for: {p: pair}
      parallel: {sequence: [place(p), tighten(p)]}
    - alternative: [look, feel]
    - leave
"""


def test_a_work_master_in_sequence(tmp_path: Path) -> None:
    master = station(tmp_path, "", JOB).work_masters["m"]
    tightened = frozenset(f"tighten({p})" for p in ("p1", "p2", "p3"))
    assert master.operations == {
        "lay": frozenset(),
        **{f"place({p})": frozenset({"lay"}) for p in ("p1", "p2", "p3")},
        **{f"tighten({p})": frozenset({f"place({p})"}) for p in ("p1", "p2", "p3")},
        "look": tightened,
        "feel": tightened,
        "leave": frozenset({"look", "feel"}),
    }
    assert master.alternatives == ((frozenset({"look"}), frozenset({"feel"})),)
    assert master.arbitrary == ()


def test_steps_add_to_the_sequence_of_a_work_master(tmp_path: Path) -> None:
    masters = "m: {sequence: [lay, leave], operations: {look: {after: [lay]}, leave: {after: [look]}}}"
    assert station(tmp_path, "", masters).work_masters["m"].operations == {
        "lay": frozenset(),
        "look": frozenset({"lay"}),
        "leave": frozenset({"lay", "look"}),
    }


def test_further_orders_hold_as_well(tmp_path: Path) -> None:
    masters = (
        "m: {sequence: [lay, leave], orders: [{sequence: [lay, look, leave]}, {alternative: [look, feel]}], "
        "operations: {feel: {after: [lay]}}}"
    )
    master = station(tmp_path, "", masters).work_masters["m"]
    assert master.operations == {
        "lay": frozenset(),
        "leave": frozenset({"lay", "look"}),
        "look": frozenset({"lay"}),
        "feel": frozenset({"lay"}),
    }
    assert master.alternatives == ((frozenset({"look"}), frozenset({"feel"})),)
    (tmp_path / "only").mkdir()
    only = station(tmp_path / "only", "", "m: {orders: [{sequence: [lay, look]}, {sequence: [lay, leave]}]}")
    assert only.work_masters["m"].operations == {
        "lay": frozenset(),
        "look": frozenset({"lay"}),
        "leave": frozenset({"lay"}),
    }


def in_a_circle(circle: str) -> str:
    """What is said of orders that contradict each other."""
    return f"each of these would have to come before the next: {circle}. Leave out one of the orders that say so"


ONE_OF = "write exactly one of sequence, parallel, alternative, arbitrary here"
CIRCLE = "sequences order these in a circle, each before the next"


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("s: {sequence: [lay, ‹lok]}", "there is no operation `lok`; did you mean `look`?"),
        ("s: {sequence: [lay, ‹place(p4)]}", "there is no operation `place(p4)`; did you mean `place(p3)`?"),
        (
            "s: {sequence: [lay, ‹place]}",
            "`place` has parameters: write one, such as `place(p1)`, or all of them, such as "
            "`{for: {p: pair}, parallel: place(p)}`",
        ),
        ("s: {sequence: [lay, ‹lay(p1)]}", "`lay` has no parameters: write `lay`"),
        ("s: {sequence: [lay, ‹not gone]}", "expected the name of an operation, such as `tighten(left)`"),
        (
            "s: {sequence: [lay, {parallel: [look, ‹lay]}]}",
            "`lay` is in this sequence already, at line 7: an operation stands once in it",
        ),
        ("s: {for: {p: ‹pairs}, sequence: tighten(p)}", "unknown enumeration `pairs`; did you mean `pair`?"),
        (
            "s: {for: {‹laid: pair}, sequence: tighten(laid)}",
            "the parameter `laid` hides the variable `laid`: rename one of them",
        ),
        ("s: {sequence: ‹[]}", "expected at least one entry, found an empty list"),
        ("s: {sequence: [lay, ‹{}]}", ONE_OF),
        ("s: ‹{sequence: [lay], parallel: [look]}", ONE_OF),
        ("s: {sequence: [lay, {alternative: [look], ‹goal: gone}]}", "`goal` is not known here"),
        ("s: {‹sequnce: [lay]}", "`sequnce` is not known here; did you mean `sequence`?"),
        (
            "‹lay: {sequence: [look]}",
            "duplicate name `lay`, first used in line 1: rename one of them, or leave one out",
        ),
        ("s: {sequence: [lay, ‹s]}", "sequences stand in each other in a circle: s → s"),
        ("s: {sequence: [lay, ‹look]}\nt: {sequence: [look, lay]}", f"{CIRCLE}: look → lay → look (`t`, `s`)"),
        (
            "s: {sequence: [lay, ‹look]}\nt: {sequence: [look, leave]}\nu: {sequence: [leave, lay]}",
            f"{CIRCLE}: look → leave → lay → look (`t`, `u`, `s`)",
        ),
    ],
)
def test_what_is_wrong_with_a_sequence(tmp_path: Path, written: str, message: str) -> None:
    assert said(tmp_path, written, "") == [f"{place_in('operations.yaml', OPERATIONS + written)}: {message}"]


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("m: ‹{title: Nothing}", "write its `operations`, or one of sequence, parallel, alternative, arbitrary"),
        ("m: {sequence: [lay, ‹lok]}", "there is no operation `lok`; did you mean `look`?"),
        (
            "m: ‹{for: {p: pair}, operations: {lay: }}",
            "`for` repeats what stands in a sequence, parallel, alternative or arbitrary beside it",
        ),
        (
            "m: {sequence: [‹lay, look], operations: {lay: {after: [look]}}}",
            in_a_circle("lay → look → lay"),
        ),
        (
            "m: {sequence: [‹lay, look], orders: [{sequence: [look, lay]}]}",
            in_a_circle("lay → look → lay"),
        ),
        (
            "m: {orders: [{sequence: [‹lay, look]}, {sequence: [look, lay]}]}",
            in_a_circle("lay → look → lay"),
        ),
        ("m: {orders: [{sequence: [lay, ‹lok]}]}", "there is no operation `lok`; did you mean `look`?"),
        ("m: {sequence: lay, orders: [‹{}]}", ONE_OF),
        # The other order is that of the sequence `s`.
        (
            "m: {sequence: [‹leave, feel]}",
            in_a_circle("leave → feel → leave"),
        ),
        (
            "m: {operations: {‹leave: , look: {after: [leave]}, feel: {after: [look]}}}",
            in_a_circle("leave → look → feel → leave"),
        ),
    ],
)
def test_what_is_wrong_with_the_sequence_of_a_work_master(tmp_path: Path, written: str, message: str) -> None:
    expected = f"{place_in('work_masters.yaml', written)}: {message}"
    assert said(tmp_path, "s: {sequence: [feel, leave]}", written) == [expected]


def place_in(file: str, text: str) -> str:
    above = text[: text.index("‹")].split("\n")
    return f"{file}:{len(above)}:{len(above[-1]) + 1}"


def said(folder: Path, sequences: str, masters: str) -> list[str]:
    with pytest.raises(ModelError) as caught:
        station(folder, sequences.replace("‹", ""), masters.replace("‹", ""))
    return [str(each).removeprefix(f"{folder}/") for each in caught.value.findings]


# The stations of the repository mean what they did when each step of theirs was written out.

_PAIRS = [f"AtBoltPair{number}TCPPose" for number in range(1, 7)]
_ENGINE = """\
  sequence:
    - identify_engine
    - bring_kit
    - mount_ladder_frame
    - for: {pair: bolt_pair}
      parallel: place_bolt_pair(pair)
    - return_kit
    - release_engine
  orders:
    - for: {pair: bolt_pair}
      parallel: {sequence: [place_bolt_pair(pair), tighten_bolt_pair(pair)]}
    # In the order in which the ladder frame settles evenly.
    - sequence: [tighten_bolts, tighten_oil_filter, release_engine]
"""
_AFTER = {
    "identify_engine": [],
    "bring_kit": ["identify_engine"],
    "mount_ladder_frame": ["bring_kit"],
    **{f"place_bolt_pair({pair})": ["mount_ladder_frame"] for pair in _PAIRS},
    "return_kit": [f"place_bolt_pair({pair})" for pair in _PAIRS],
    f"tighten_bolt_pair({_PAIRS[0]})": [f"place_bolt_pair({_PAIRS[0]})"],
    **{
        f"tighten_bolt_pair({pair})": [f"place_bolt_pair({pair})", f"tighten_bolt_pair({before})"]
        for before, pair in pairwise(_PAIRS)
    },
    "tighten_oil_filter": [f"tighten_bolt_pair({_PAIRS[-1]})"],
    "release_engine": ["return_kit", "tighten_oil_filter"],
}
_ENGINE_STEPS = "  operations:\n" + "".join(
    f"    {name}: {{after: [{', '.join(all_)}]}}\n" for name, all_ in _AFTER.items()
)
_TIGHTENING = """
# In the order in which the ladder frame settles evenly.
tighten_bolts:
  title: {en: Tighten all bolts, sv: Dra åt alla skruvar}
  for: {pair: bolt_pair}
  sequence: tighten_bolt_pair(pair)
"""
_READY = "bolts[pair] == placed and nutrunner_is_at_hand\n"
_EACH_AFTER_THE_OTHER = (
    ">-\n    bolts[pair] == placed and nutrunner_is_at_hand\n"
    "    and (pair == first(bolt_pair) or bolts[previous(pair)] == tightened)\n"
)


@pytest.mark.parametrize(
    ("model", "steps"),
    [
        (
            "docking_agv",
            {
                "work_masters.yaml": [
                    (
                        "  sequence: [fetch_kit, hand_over_kit, assemble]\n",
                        "  operations:\n    fetch_kit:\n    hand_over_kit: {after: [fetch_kit]}\n"
                        "    assemble: {after: [hand_over_kit]}\n",
                    )
                ]
            },
        ),
        (
            "truck_engine_station",
            {
                "work_masters.yaml": [(_ENGINE, _ENGINE_STEPS)],
                "operations.yaml": [(_TIGHTENING, ""), (_READY, _EACH_AFTER_THE_OTHER)],
            },
        ),
    ],
)
def test_a_station_means_the_same_as_step_by_step(
    tmp_path: Path, model: str, steps: dict[str, list[tuple[str, str]]]
) -> None:
    copy = Path(copytree(MODELS / model, tmp_path / model))
    for file, changes in steps.items():
        text = (copy / file).read_text(encoding="utf-8")
        for sequence, written in changes:
            assert text.count(sequence) == 1
            text = text.replace(sequence, written)
        (copy / file).write_text(text, encoding="utf-8")
    in_sequence, step_by_step = (prepare_station(each).automaton for each in (MODELS / model, copy))
    assert in_sequence == step_by_step
    assert model_digest(in_sequence) == model_digest(step_by_step)
