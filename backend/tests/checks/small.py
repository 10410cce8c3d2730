"""Small stations for checks, and what is found in them."""

from __future__ import annotations

from pathlib import Path

from sequence_planner.analysis.checks.connections import Connections
from sequence_planner.analysis.checks.rules import check_automaton
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.model.loader import load_station
from support.told import as_message

STATION = """
name: small
enumerations: {side: [left, right], place: [left, right, between]}
estimated:
  part: {type: bool}
  count: {type: 0..3}
"""

# A device that follows its command, with nothing suspicious about it.
DEVICE = """
measured: {on: {type: bool}}
output: {command: {type: bool}}
abilities:
  go:
    enabled: not command and not on
    start: {do: [command := true]}
    executing: command and not on
    finish: {when: command and on, do: [part := true]}
    effects: {goes: {kind: executing, when: command and not on, do: [on := true]}}
  back:
    enabled: command and on and part
    start: {do: [command := false, part := false]}
    executing: not command and on
    finish: {when: not command and not on}
    effects: {comes: {kind: executing, when: not command and on, do: [on := false]}}
"""


def station(folder: Path, resources: dict[str, str], **documents: str) -> Automaton:
    """A station of these resources; `documents` are its other files, `station` among them."""
    (folder / "resources").mkdir()
    for name, text in resources.items():
        (folder / "resources" / f"{name}.yaml").write_text(text, encoding="utf-8")
    for name, text in {"station": STATION, **documents}.items():
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    return ground(load_station(folder))


def device(folder: Path, *changes: tuple[str, str], **documents: str) -> Automaton:
    """A station of the device alone, with changes of its text."""
    text = DEVICE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return station(folder, {"device": text}, **documents)


def found(automaton: Automaton, connections: Connections | None = None) -> list[str]:
    """What the checks say, which has to be known in other languages too: file:line:column, message and kind; the file
    without its folder.
    """
    return [
        f"{Path(w.place.file).name}:{w.place.line}:{w.place.column}: {as_message(w.message)} [{w.kind}]"
        for w in check_automaton(automaton, connections)
    ]
