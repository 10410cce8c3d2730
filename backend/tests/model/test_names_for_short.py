"""What is wrong with sets, orders, relations, maps and predicates is told where it is, and not again wherever they are
used.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from editor.shorthand import SHORTHAND
from sequence_planner.automaton.tick import initial_state, writes
from sequence_planner.language.evaluator import holds
from sequence_planner.station import prepare_station

from .breaking import findings, replace, write

STATION, ARM = "station.yaml", "resources/arm.yaml"
PAIR = "a pair is a list of two, such as `[home, left]`: a set or a list stands for each of its values"
PLACES = "{home, left, right, out}"


@pytest.fixture
def press(tmp_path: Path) -> Path:
    """A station that uses all of them, each more than once."""
    for file, text in SHORTHAND.items():
        write(tmp_path, file, text)
    return tmp_path


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        # enumerations
        (STATION, "includes: [spot]", "includes: [‹spt]", "unknown enumeration `spt`; did you mean `spot`?"),
        # sets, on which other sets, parameters, maps and quantifiers depend
        (STATION, "free: {of: spot", "free: {of: ‹spt", "unknown enumeration or set `spt`; did you mean `spot`?"),
        (
            STATION,
            "values: [home, out]",
            "values: [‹hme, out]",
            f"`hme` is no value of {PLACES} and no set; did you mean `home`?",
        ),
        (
            STATION,
            "values: [home, out]",
            "values: [‹hme]",
            f"`hme` is no value of {PLACES} and no set; did you mean `home`?",
        ),
        (
            STATION,
            "values: [home, out]",
            "except: [‹p1, out]",
            f"`p1` is no value of {PLACES} and no set; it is one of `part`",
        ),
        (STATION, "ends: {of: part", "ends: {of: ‹prt", "unknown enumeration or set `prt`; did you mean `part`?"),
        (
            STATION,
            "  ends: {of: part, values: [p1, p3]}",
            "  ‹ends: {of: part, except: [p1, p2, p3]}",
            "no value of `part` is left in `ends`: a set has at least one",
        ),
        # relations and maps
        (STATION, "[spot, spot]", "[spot, ‹spt]", "unknown enumeration or set `spt`; did you mean `spot`?"),
        (
            STATION,
            "[[home, work]",
            "[[‹hom, work]",
            f"`hom` is no value of {PLACES} and no set; did you mean `home`?",
        ),
        (
            STATION,
            "grip_for: {from: part",
            "grip_for: {from: ‹prt",
            "unknown enumeration or set `prt`; did you mean `part`?",
        ),
        (
            STATION,
            "to: bool",
            "to: ‹bol",
            "unknown type `bol`: write bool, a range such as 0..3, or an enumeration; did you mean `bool`?",
        ),
        (STATION, "values: {p2: big", "values: {p2: ‹bg", "`bg` is not in {bare, big, small}; did you mean `big`?"),
        (
            STATION,
            "values: {p2: big",
            "values: {‹left: big",
            "`left` is no value of {p1, p2, p3} and no set; it is one of `spot`",
        ),
        (
            STATION,
            "  grip_for: {from: part, to: grip, values: {p2: big, ends",
            "  ‹grip_for: {from: part, to: grip, values: {ends",
            "`grip_for` says nothing for `p2`: add it, or `otherwise`",
        ),
        (STATION, "[[home, work], [left", "[‹home, [left", PAIR),
        (STATION, "[[home, work], [left", "[‹[home], [left", PAIR),
        (STATION, "[[home, work], [left", "[‹[home, work, out], [left", PAIR),
        (
            STATION,
            "between: [spot, spot]",
            "between: ‹[spot]",
            "a relation is between two enumerations or sets: write a list of two, such as `[pose, pose]`",
        ),
        # predicates
        (
            STATION,
            '"all p in part: bolts',
            '"all p in ‹prt: bolts',
            "there is no set `prt`: `in` needs values in braces, an enumeration or a named set; did you mean `part`?",
        ),
        (STATION, '"all p in part: bolts', '"all p in part ‹bolts', "expected `:` or `where`, found `bolts`"),
        (STATION, "{which: part}", "{which: ‹prt}", "unknown enumeration `prt`; did you mean `part`?"),
        (ARM, "{q: spot}", "{q: ‹spt}", "unknown enumeration `spt`; did you mean `spot`?"),
        (ARM, "when: at == q", "when: ‹ta == q", "unknown variable or value `ta`; did you mean `target`?"),
    ],
)
def test_the_cause_alone_is_told(press: Path, file: str, old: str, new: str, message: str) -> None:
    [place] = replace(press, file, old, new)
    assert findings(press) == [f"{place}: {message}"]


def test_what_is_wrong_elsewhere_is_told_all_the_same(press: Path) -> None:
    [first] = replace(press, STATION, "free: {of: spot", "free: {of: ‹spt")
    [second] = replace(press, ARM, "held != grip_for[one] and", "held != grip_for[one] and ‹chosn == p1 and")
    assert findings(press) == [
        f"{second}: unknown variable `chosn`; did you mean `chosen`?",
        f"{first}: unknown enumeration or set `spt`; did you mean `spot`?",
    ]


def test_a_circle_is_told_once_and_where_it_is(press: Path) -> None:
    old = "predicates:\n"
    [itself] = replace(press, STATION, old, f"{old}  leads_there: arm.hen\n  one: arm.two\n  itself: ‹itself\n")
    [hen] = replace(press, ARM, old, f"{old}  hen: ‹egg\n  egg: chick\n  chick: hen and leads_there\n  two: hen\n")
    assert findings(press) == [
        f"{hen}: predicates need each other in a circle: arm.egg → arm.chick → arm.hen → arm.egg",
        f"{itself}: predicates need each other in a circle: itself → itself",
    ]


def test_a_value_by_cases_is_written_as_is_told(press: Path) -> None:
    advice = "give the ability a parameter for the case, and let its condition say which case it is"
    start = "start: {do: [target := to]}"
    [place] = replace(press, ARM, start, "start: {do: [target := home if at == out, ‹target := out if at == home]}")
    assert findings(press) == [f"{place}: `arm.target` is written twice by one transition: {advice}"]
    replace(press, ARM, "start: {do: [target := home if at == out, target := out if at == home]}", start)
    lead, map_ = "maps:\n", "  away: {from: spot, to: spot, values: {home: out}, otherwise: home}\n"
    replace(press, STATION, lead, lead + map_)
    away = "  leave:\n    start: {{do: ['target := {}']}}\n    until: at == target\n"
    [place] = replace(press, ARM, "abilities:\n", "abilities:\n" + away.format("‹away[at]"))
    assert findings(press) == [f"{place}: `away[at]` depends on the state: {advice}"]
    parameter = "  leave:\n    parameters: {here: spot}\n    enabled: at == here\n"
    replace(press, ARM, away.format("away[at]"), away.format("away[here]").replace("  leave:\n", parameter))
    automaton = prepare_station(press).automaton
    for here, value in {"home": "out", "left": "home", "right": "home", "out": "home"}.items():
        leave = automaton.abilities[f"arm.leave({here})"]
        state = {**initial_state(automaton), "arm.at": here, "arm.target": "left"}
        assert holds(leave.enabled, state)
        assert writes(leave.start_actions, state) == {"arm.target": value}
        assert not holds(leave.enabled, {**state, "arm.at": "nowhere"})


COLON = "put quotes around a text with a colon, as in"
MOVED = '["all p in part where p == next(chosen): bolts[p] := placed if p != first(ends)"]'


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        (
            ARM,
            f"finish: {{when: is_at(to), do: {MOVED}}}",
            "finish:\n      when: is_at(to)\n      do:\n        - ‹all p in part: bolts[p] := placed",
            f'expected a text, found a mapping: {COLON} "all p in part: …"',
        ),
        (
            ARM,
            "start: {do: [target := to]}",
            "start:\n      ‹do:\n        all p, q in part where p < q: bolts[p] := placed",
            f'expected a list, found a mapping: {COLON} "all p, q in part: …"',
        ),
        (
            STATION,
            'rest: "none p in part where p < chosen and is_done(p): bolts[p] == tight"',
            "‹rest:\n  at most 2 p in part: bolts[p] == placed",
            f'expected a text or true or false, found a mapping: {COLON} "at most 2 p in part: …"',
        ),
        (
            STATION,
            'all_tight: "all p in part: bolts[p] == tight"',
            "all_tight:\n    ‹all p in part: bolts[p] == tight",
            f'this is a mapping, and a condition is a text: {COLON} "all p in part: …"',
        ),
    ],
)
def test_a_quantifier_without_quotes(press: Path, file: str, old: str, new: str, message: str) -> None:
    """YAML takes it for a mapping."""
    [place] = replace(press, file, old, new)
    assert findings(press) == [f"{place}: {message}"]
