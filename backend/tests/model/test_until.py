"""An ability that goes on from its command until something holds is short for what it executes and finishes by."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.model.source import ModelError
from sequence_planner.station import read_station

STATION = "name: gate\nenumerations: {goal: [shut, ajar, open]}\nestimated: {passed: {type: bool}}\n"
VARIABLES = """
measured: {position: {type: goal}, stuck: {type: bool}}
output: {wanted: {type: goal}, fast: {type: bool}, lamp: {type: bool}}
estimated: {cycles: {type: 0..3}}
abilities:
"""
SHORT = """
  move:
    parameters: {where: goal}
    timeouts: {finish: 5}
    enabled: wanted == position
    start: {do: [wanted := where, fast := true, lamp := false, passed := false, other.wanted := true]}
    until: position == where and not stuck
    effects:
      arrives: {do: [position := where], takes: 2}
      sticks: {kind: finishing, when: wanted == where, do: [stuck := true], fault: true}
  shine:
    start: {do: [lamp := fast, "fast := false if stuck"]}
    until: stuck
    executing: lamp and stuck
    finish: {when: passed, do: [passed := false]}
    effects:
      ends: {do: [stuck := false]}
"""
LONG = """
  move:
    parameters: {where: goal}
    timeouts: {finish: 5}
    enabled: wanted == position
    start: {do: [wanted := where, fast := true, lamp := false, passed := false, other.wanted := true]}
    executing: wanted == where and fast and not lamp and not (position == where and not stuck)
    finish: {when: wanted == where and fast and not lamp and position == where and not stuck}
    effects:
      arrives:
        kind: executing
        when: wanted == where and fast and not lamp and not (position == where and not stuck)
        do: [position := where]
        takes: 2
      sticks: {kind: finishing, when: wanted == where, do: [stuck := true], fault: true}
  shine:
    start: {do: [lamp := fast, "fast := false if stuck"]}
    executing: lamp and stuck
    finish: {when: lamp == fast and stuck and passed, do: [passed := false]}
    effects:
      ends: {kind: executing, when: lamp and stuck, do: [stuck := false]}
"""


def automaton_with(folder: Path, abilities: str) -> Automaton:
    """The gate with these abilities; beside it another resource with an output of its own."""
    (folder / "resources").mkdir(parents=True)
    (folder / "station.yaml").write_text(STATION)
    (folder / "resources" / "gate.yaml").write_text(VARIABLES.strip() + "\n" + abilities)
    (folder / "resources" / "other.yaml").write_text("output: {wanted: {type: bool}}\n")
    return read_station(folder).automaton


def test_it_means_what_it_is_short_for(tmp_path: Path) -> None:
    short, long = automaton_with(tmp_path / "short", SHORT), automaton_with(tmp_path / "long", LONG)
    assert (short.abilities, short.effects) == (long.abilities, long.effects)
    assert len(short.abilities) == 4


def test_what_is_so_by_the_command_of_another_resource_is_not_waited_for(tmp_path: Path) -> None:
    found = automaton_with(tmp_path, SHORT).abilities["gate.move(open)"]
    assert "other" not in str(found.executing) and "passed" not in str(found.finish_guard)


@pytest.mark.parametrize(
    ("abilities", "said"),
    [
        ("  a:\n    start: {do: [cycles := 1]}\n    until: ‹stuck\n",
         "`until` needs a command: a start action that writes an output of `gate`"),
        ("  a:\n    start: {do: [other.wanted := true]}\n    until: ‹stuck\n",
         "`until` needs a command: a start action that writes an output of `gate`"),
        ("  a:\n    start: {do: [‹lam := true]}\n    until: stuck\n", "unknown variable `lam`; did you mean `lamp`?"),
        ("  a:\n    start: {do: [lamp := true]}\n    until: ‹stuk\n", "unknown variable `stuk`; did you mean `stuck`?"),
        ("  ‹a:\n    timeouts: {finish: 3}\n", "`timeouts` need a `finish` or an `until`: without one the ability is "
         "done with its start"),
        ("  ‹a:\n    finish: {do: [passed := true]}\n",
         "`finish` needs a `when`, or the ability something to go on `until`"),
        ("  ‹a:\n    effects: {goes: {do: [stuck := true]}}\n",
         "the effect `goes` needs a `when`: nothing says when the ability is executing"),
        ("  a:\n    start: {do: [lamp := true]}\n    until: passed\n    effects: {‹goes: {do: [stuck := true]}}\n",
         "without `when` it happens while the ability executes, and `passed` is neither a measured nor an output "
         "variable"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_where_it_stands(tmp_path: Path, abilities: str, said: str) -> None:
    with pytest.raises(ModelError) as error:
        automaton_with(tmp_path, abilities.replace("‹", ""))
    (found,) = error.value.findings
    before = (VARIABLES.strip() + "\n" + abilities).partition("‹")[0]
    assert found.message == said
    assert found.place.line == before.count("\n") + 1
