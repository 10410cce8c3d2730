"""What is wrong with sets, orders, relations, maps and predicates is told where it is, and not again wherever they are
used.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from editor.shorthand import SHORTHAND
from sequence_planner.automaton.tick import initial_state, writes
from sequence_planner.language.evaluator import holds
from sequence_planner.model.loader import ReadBefore, load_station
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
        # sets of a resource
        (ARM, "sides: {of: spot", "sides: {of: ‹spt", "unknown enumeration or set `spt`; did you mean `spot`?"),
        (
            ARM,
            "values: [left, right]}",
            "values: [‹lft, right]}",
            f"`lft` is no value of {PLACES} and no set; did you mean `left`?",
        ),
        (
            ARM,
            "  lone: {of: sides, except: [right]}",
            "  ‹lone: {of: sides, except: [right, left]}",
            "no value of `arm.sides` is left in `arm.lone`: a set has at least one",
        ),
        (
            ARM,
            "  lone: {of: sides,",
            "  ‹grip: {of: spot, values: [home]}\n  lone: {of: sides,",
            "`grip` is an enumeration already: give the set another name",
        ),
        (
            ARM,
            "side: {type: sides}",
            "side: {type: ‹side_s}",
            "unknown type `side_s`: write bool, a range such as 0..3, or an enumeration; did you mean `arm.sides`?",
        ),
        (
            ARM,
            "at in sides and",
            "at in ‹sids and",
            "there is no set `sids`: `in` needs values in braces, an enumeration or a named set; did you mean "
            "`arm.sides`?",
        ),
        (
            "specifications.yaml",
            "arm.at in arm.lone",
            "arm.at in ‹arm.lon",
            "there is no set `arm.lon`: `in` needs values in braces, an enumeration or a named set; did you mean "
            "`arm.lone`?",
        ),
        (
            ARM,
            "across(side, right)",
            "across(side, ‹lone)",
            "`lone` is a set, and one value stands here: write `all l in lone: across(side, l)`",
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


# Sets of a resource.


def test_a_set_of_a_resource_means_what_one_of_the_station_does(press: Path) -> None:
    """It is only known by its own name there alone."""
    before = prepare_station(press).automaton
    for name in (ARM, "specifications.yaml"):
        text = (press / name).read_text()
        (press / name).write_text(text.replace("arm.sides", "sides").replace("arm.lone", "lone"))
    sets = "  sides: {of: spot, values: [left, right]} # of the arm alone\n  lone: {of: sides, except: [right]}\n"
    replace(press, ARM, f"sets:\n{sets}", "")
    replace(press, STATION, "sets:\n", f"sets:\n{sets}")
    after = prepare_station(press).automaton
    for part in ("variables", "abilities", "effects", "operations", "specifications", "rest", "flags"):
        assert getattr(after, part) == getattr(before, part), part
    assert before.indices["arm.turn"] == {"where": "arm.sides"}


def test_a_resource_with_sets_that_has_not_changed_is_the_same_object(press: Path) -> None:
    before = ReadBefore()
    first = load_station(press, before).resources["arm"]
    replace(press, STATION, "name: press", "name: other")
    assert load_station(press, before).resources["arm"] is first
    replace(press, ARM, "values: [left, right]} #", "values: [left, right, out]} #")
    assert load_station(press, before).resources["arm"] != first


def test_a_set_of_a_resource_comes_before_one_of_the_station(press: Path) -> None:
    replace(press, STATION, "  free: {of: spot,", "  sides: {of: spot, values: [home]}\n  free: {of: spot,")
    automaton = prepare_station(press).automaton
    assert {name for name in automaton.abilities if name.startswith("arm.turn")} == {
        "arm.turn(left)",
        "arm.turn(right)",
    }


_TYPE = """\
parameters: {places: enumeration, first: {kind: value, of: places}}
sets:
  others: {of: places, except: [first]}
measured: {at: {type: places, initial: first}}
output: {goal: {type: others}}
abilities:
  go:
    parameters: {where: others}
    enabled: not at in others and goal != where
    start: {do: [goal := where]}
    until: at == where
    effects:
      comes: {for: {each: others}, when: goal == each and at != each, do: [at := each]}
"""


def test_it_is_one_of_its_own_for_each_instance_of_a_type(tmp_path: Path) -> None:
    write(tmp_path, STATION, "name: lines\nenumerations: {spot: [home, left, right], stop: [store, bench]}\n")
    write(tmp_path, "types/line.yaml", _TYPE)
    write(tmp_path, "resources/one.yaml", "type: line\narguments: {places: spot, first: home}\n")
    write(tmp_path, "resources/two.yaml", "type: line\narguments: {places: stop, first: bench}\n")
    automaton = prepare_station(tmp_path).automaton
    assert set(automaton.abilities) == {"one.go(left)", "one.go(right)", "two.go(store)"}
    assert [each.name for each in automaton.effects] == [
        "one.go(left).comes[left]", "one.go(left).comes[right]", "two.go(store).comes[store]"
    ]  # fmt: skip
