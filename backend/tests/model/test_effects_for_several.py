"""An effect with `for` is short for one effect per value, each with that in its name."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sequence_planner.automaton.automaton import Automaton, Effect
from sequence_planner.core.immutable import replace as with_fields
from sequence_planner.station import read_station

from .breaking import findings, replace, write

STATION = "name: rack\nenumerations: {tool: [drill, saw, file], side: [left, right]}\n"
RACK = "resources/rack.yaml"
RESOURCE = """\
measured:
  home: {for: {which: tool}, type: bool}
  away: {for: {which: tool, where: side}, type: bool}
  lid: {type: bool}
output: {held: {type: tool}}
abilities:
  take:
    parameters: {what: tool}
    start: {do: [held := what]}
    until: not home[what]
    effects:
"""
LEAVES = """\
      leaves: {for: {each: tool}, when: "home[each] and held == each", do: ["home[each] := false"], takes: [1, 2]}
"""


def rack(folder: Path, effects: str) -> Path:
    write(folder, "station.yaml", STATION)
    write(folder, RACK, RESOURCE + effects)
    return folder


def automaton(folder: Path, effects: str) -> Automaton:
    return read_station(rack(folder, effects)).automaton


def test_it_has_the_value_in_its_name_as_a_variable_has(tmp_path: Path) -> None:
    """What does not depend on the parameter of the ability is one effect for all of these."""
    found = automaton(tmp_path, LEAVES)
    assert [each.name for each in found.effects] == [
        f"rack.take(drill).leaves[{each}]" for each in ("drill", "saw", "file")
    ]
    assert found.reactions["rack.take(saw)"] == tuple(each.name for each in found.effects)
    assert {found.places[each.name].line for each in found.effects} == {RESOURCE.count("\n") + 1}
    assert found.indices["rack.take.leaves"] == {"each": "tool"}


def test_what_an_effect_never_has_is_none(tmp_path: Path) -> None:
    """The parameter of the ability and the word of the effect are told apart."""
    found = automaton(
        tmp_path,
        '      leaves: {for: {each: tool}, when: "home[each] and held == what", do: ["home[each] := false"]}\n',
    )
    assert len(found.effects) == 9
    assert {each.name for each in found.effects} >= {"rack.take(saw).leaves[file]", "rack.take(file).leaves[saw]"}


_CONDITIONS = (
    "home[{0}]",
    "held == {0}",
    "not away[{0}, {1}]",
    "lid",
    "held != {0} and away[{0}, {1}]",
    "away[{0}, {1}] implies lid",
)
_ACTIONS = ("home[{0}] := false", "away[{0}, {1}] := lid", "away[{0}, {1}] := home[{0}] if held == {0}")


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    conditions=st.lists(st.sampled_from(_CONDITIONS), min_size=1, max_size=3),
    actions=st.lists(st.sampled_from(_ACTIONS), min_size=1, max_size=2, unique_by=lambda each: each.partition(" ")[0]),
    fault=st.booleans(),
)
def test_it_means_the_same_as_effects_that_are_written_out(
    tmp_path: Path, conditions: list[str], actions: list[str], fault: bool
) -> None:
    def written(name: str, tool: str, side: str, each: str = "") -> str:
        when = " and ".join(conditions).format(tool, side)
        do = ", ".join(f'"{action.format(tool, side)}"' for action in actions)
        return f'      {name}: {{{each}when: "{when}", do: [{do}], takes: [1, 3], fault: {str(fault).lower()}}}\n'

    once = automaton(tmp_path, written("moves", "t", "s", "for: {t: tool, s: side}, "))
    several = automaton(
        tmp_path,
        "".join(
            written(f"moves_{tool}_{side}", tool, side)
            for tool in ("drill", "saw", "file")
            for side in ("left", "right")
        ),
    )

    def plain(effect: Effect) -> Effect:
        return with_fields(effect, name="")

    def different(effects: tuple[Effect, ...]) -> list[str]:
        return sorted({repr(plain(each)) for each in effects})

    assert different(once.effects) == different(several.effects)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("{each: tool}", "{each: ‹tol}", "unknown enumeration `tol`; did you mean `tool`?"),
        ("{each: tool}", "{‹lid: tool}", "the parameter `lid` hides the variable `rack.lid`: rename one of them"),
        ("{each: tool}", "{‹saw: tool}", "the parameter `saw` hides the value `saw` of `tool`: rename one of them"),
        (
            "{each: tool}",
            "{each: tool, ‹what: side}",
            "`what` is a parameter of the ability already: take another word",
        ),
        ("held == each", "held == ‹ech", "unknown variable or value `ech`; did you mean `each`?"),
        ('"home[each] := false"', '"held ‹:= each"', None),
    ],
)
def test_what_is_wrong_with_it_is_told_once(tmp_path: Path, old: str, new: str, message: str | None) -> None:
    station = rack(tmp_path, LEAVES)
    [place] = replace(station, RACK, old, new)
    found = findings(station)
    if message is None:
        assert found == [found[0]]
        assert found[0].endswith("an effect writes measured variables, and `held` is an output variable")
    else:
        assert f"{place}: {message}" in found
        assert len({each for each in found if message in each}) == 1


def test_it_stands_in_a_type_with_its_parameters(tmp_path: Path) -> None:
    station = rack(tmp_path, LEAVES)
    write(
        station,
        "types/rack.yaml",
        "parameters: {things: enumeration}\n" + (RESOURCE + LEAVES).replace(": tool", ": things"),
    )
    plain = read_station(station).automaton
    write(station, RACK, "type: rack\narguments: {things: tool}\n")
    assert read_station(station).automaton == plain
    [place] = replace(station, "types/rack.yaml", "held == each", "held == ‹ech")
    assert any(each.startswith(f"{place}: in rack") for each in findings(station))
