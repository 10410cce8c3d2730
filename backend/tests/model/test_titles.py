"""Titles of variables, values, sets and predicates: what they give, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from editor.shorthand import SHORTHAND
from sequence_planner.automaton.grounding import ground
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.model.loader import load_station

from .breaking import findings, replace, write

STATION = "station.yaml"


@pytest.fixture
def press(tmp_path: Path) -> Path:
    """A station with names for what is said more than once."""
    for file, text in SHORTHAND.items():
        write(tmp_path, file, text)
    return tmp_path


TITLED = (
    (
        "state: [empty, placed, tight]",
        "state: {values: [empty, placed, tight], titles: {tight: {en: firm, sv: fast}, empty: {en: open}}}",
    ),
    (
        "bolts: {for: {where: part}, type: state, initial: empty}",
        'bolts: {for: {where: part}, type: state, initial: empty, title: "{where}", phrase: "bolt {where} is {value}"}',
    ),
    (
        "part: {values: [p1, p2, p3], ordered: true}",
        "part: {values: [p1, p2, p3], ordered: true, titles: {p1: one, p2: two}}",
    ),
    ("free: {of: spot, values: [home, out]}", "free: {of: spot, values: [home, out], title: {en: a free spot}}"),
    ("goal: {type: spot, initial: home}", "goal: {type: spot, initial: home, titles: {out: {en: far away}}}"),
)


@pytest.fixture
def titled(press: Path) -> Path:
    """The same with titles."""
    for old, new in TITLED:
        replace(press, STATION, old, new)
    return press


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("bolts[p1]", "tight", {"en": "bolt one is firm", "sv": "bolt one is fast"}),
        ("bolts[p3]", "empty", {"en": "bolt p 3 is open", "sv": "bolt p 3 is open"}),
        # A variable can say of a value something else than its enumeration does.
        ("goal", "out", {"en": "goal is far away", "sv": "goal är far away"}),
        ("arm.target", "out", {"en": "target is out", "sv": "target är out"}),
    ],
)  # fmt: skip
def test_titles_are_told(titled: Path, name: str, value: str, sentence: dict[str, str]) -> None:
    assert sentences_of(ground(load_station(titled))).tell_value(name, value).words == sentence


def test_a_value_has_its_title_in_the_titles_of_abilities(press: Path) -> None:
    replace(
        press,
        STATION,
        "spot: [home, left, right, out]",
        "spot: {values: [home, left, right, out], titles: {out: the exit}}",
    )
    assert ground(load_station(press)).abilities["arm.move(out)"].title == "Move to the exit"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "state: [empty, placed, tight]",
            "state: {values: [empty, placed, tight], titles: {‹tigt: firm}}",
            "`tigt` is no value of `state`, which ranges over {empty, placed, tight}; did you mean `tight`?",
        ),
        (
            "state: [empty, placed, tight]",
            "state: {values: [empty, placed, tight], titles: {tight: firm, placed: ‹Firm}}",
            "`Firm` is what `tight` is called already: nobody could tell them apart; write other words for one of them",
        ),
        (
            "goal: {type: spot, initial: home}",
            "goal: {type: spot, initial: home, titles: {‹hoem: at home}}",
            "`hoem` is no value of `goal`, which ranges over {home, left, right, out}; did you mean `home`?",
        ),
        (
            "goal: {type: spot, initial: home}",
            "goal: {type: spot, initial: home, phrase: ‹the goal is set}",
            "a phrase has a place for the value: write `{value}` in it, as in `the robot is at {value}`",
        ),
        (
            "bolts: {for: {where: part}, type: state, initial: empty}",
            'bolts: {for: {where: part}, type: state, initial: empty, title: {en: ‹"bolt {wher}"}}',
            "`{wher}` stands for no parameter here; did you mean `where`?",
        ),
        (
            'title: "{which} is done"',
            'title: ‹"{wich} is done"',
            "`{wich}` stands for no parameter here; did you mean `which`?",
        ),
        (
            "goal: {type: spot, initial: home}",
            "goal: {type: spot, initial: home, title: {‹de: Ziel}}",
            "`de` is not known here; did you mean `en`?",
        ),
        (
            "goal: {type: spot, initial: home}",
            "goal: {type: spot, initial: home, title: ‹' '}",
            "write a text: this one is empty",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_title_is_told_where_it_is(press: Path, old: str, new: str, message: str) -> None:
    [place] = replace(press, STATION, old, new)
    assert findings(press) == [f"{place}: {message}"]
