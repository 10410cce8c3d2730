"""What is said of a plain automaton that cannot be used, and where: ‹ marks the place."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.model.efa_document import load_plain, read_plain
from sequence_planner.model.source import ModelError

GOOD = """{
  "name": "users",
  "variables": {"u1": ["idle", "has"], "free": "bool", "n": {"min": 0, "max": 3}},
  "initial": "u1 == idle and free and n == 0",
  "transitions": [
    {"event": "grab", "controllable": true, "guard": "u1 == idle", "set": {"u1": "has", "n": "n + 1"}},
    {"event": "drop", "controllable": false, "set": {"u1": "idle", "free": true}}
  ],
  "forbidden": ["n == 3"],
  "goal": ["F (u1 == has)"]
}"""


def findings(text: str) -> Sequence[str]:
    with pytest.raises(ModelError) as caught:
        plain_automaton(read_plain(text, "users.efa.json"))
    return [str(finding) for finding in caught.value.findings]


def test_the_one_that_is_broken_below_is_fine() -> None:
    automaton = plain_automaton(read_plain(GOOD.replace("\n  ", "\n\t"), "users.efa.json"))
    assert (list(automaton.abilities), [effect.name for effect in automaton.effects]) == (["grab"], ["drop"])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"name"', '‹"nam"', "`nam` is not known here; did you mean `name`?"),
        ('"u1 == idle"', '"u1 == ‹idel"', "unknown variable or value `idel`; did you mean `idle`?"),
        ('"n + 1"', '"n + ‹m"', "unknown variable `m`"),
        ('{"u1": "has", "n"', '{"u1": "has", ‹"m"', "unknown variable `m`"),
        ('"free": true', '"free": ‹3', "`3` is no value of `free`, which ranges over bool"),
        ('"n + 1"', '"‹idle"', "unknown variable `idle`; a value stands beside its variable, as in `u1 == idle`"),
        ('{"min": 0, "max": 3}', '{"min": 0, "max": ‹"3"}', "expected an integer, found `3`"),
        ('{"min": 0, "max": 3}', "‹3", 'expected "bool", a list of values, or {"min": 0, "max": 3}, found `3`'),
        ('["idle", "has"]', "‹[]", "expected at least one entry, found an empty list"),
        ('"n": {"min": 0', '"n": ‹{"min": 7', "the range 7..3 is empty: write the smaller number as min"),
        ('"bool"', '‹"boolean"', 'unknown domain `boolean`: write "bool", a list of values, or {"min": 0, "max": 3}'),
        (
            '["idle", "has"]',
            '‹["idle", 1]',
            'a list of values holds names; write integers as a range, such as {"min": 0, "max": 3}',
        ),
        ('["idle", "has"]', '["idle", "has", ‹"idle"]', "duplicate value `idle` of `u1`"),
        ('"controllable": false', '"controllable": ‹"no"', "expected true or false, found `no`"),
        (
            '"event": "drop"',
            '"event": ‹"grab"',
            "the event `grab` is uncontrollable here and controllable in line 6: an event is one or the other; make it "
            "two events",
        ),
        (
            '"event": "drop"',
            '"event": ‹"drop#1"',
            "`drop#1` cannot be the name of an event: `#` numbers the transitions of one event; rename it, for example "
            "to `drop_1`",
        ),
        (
            '"free": "bool"',
            '‹"2free": "bool"',
            "expressions cannot read the variable `2free`: a name has letters, digits and `_`, begins with no digit "
            "and is no word of the language; rename it everywhere, for example to `v_2free`",
        ),
        (
            '"idle", "has"',
            '"idle", ‹"h.1"',
            "expressions cannot read the value `h.1`: a name has letters, digits and `_`, begins with no digit and is "
            "no word of the language; rename it everywhere, for example to `h_1`",
        ),
        ('"u1 == idle and free', '‹"free and not free', "no state satisfies `initial`: there is nowhere to begin"),
        ('"F (u1 == has)"', '"F (u1 == ‹had)"', "unknown variable or value `had`; did you mean `has`?"),
    ],
)
def test_errors_name_their_place(old: str, new: str, message: str) -> None:
    assert GOOD.count(old) == 1
    marked = GOOD.replace(old, new)
    above = marked[: marked.index("‹")].split("\n")
    *_, last = findings(marked.replace("‹", ""))
    assert last == f"users.efa.json:{len(above)}:{len(above[-1]) + 1}: {message}"


def test_too_many_related_variables_are_an_error_and_no_endless_search() -> None:
    names = [f"x{i}" for i in range(20)]
    variables = ", ".join(f'"{name}": {{"min": 0, "max": 9}}' for name in names)
    sums = " + ".join(names)
    text = f'{{"name": "hard", "variables": {{{variables}}},\n "initial": "{sums} == 170 and x19 < 1 and x18 < x17"}}'
    assert findings(text) == [
        "users.efa.json:2:13: no initial state was found in reasonable time: write more of it as `variable == value "
        "and ...`"
    ]


def test_what_is_no_mapping_or_no_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="cannot be read: No such file"):
        load_plain(tmp_path / "none.efa.json")
    assert findings("[1]") == [
        "users.efa.json:1:1: expected a plain automaton with its name, variables and transitions, found a list"
    ]
