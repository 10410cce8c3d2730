"""Whether two folders hold the same model: `same_meaning.py FOLDER OTHER` says what is otherwise, and ends with 1 then.

What the models do is compared as the page Review changes compares revisions: variables, abilities with what the supervisor adds,
effects, operations, specifications, plans. All else of the documents is compared as it is loaded, without comments and
line breaks; messages are compared by their type hashes.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from sequence_planner.analysis.finding import analyses
from sequence_planner.model.paths import DEFINITIONS
from sequence_planner.model.loader import load_station
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.editor.comparing.behaviour import behaviour_differences, plan_differences
from sequence_planner.editor.comparing.diff import Written, differences
from sequence_planner.editor.comparing.meant import Meant


def meant(station: ReadyStation) -> Meant:
    """What it does; an error where it cannot be supervised."""
    for found in analyses(station.automaton):
        if found.supervisor is not None and found.guards is not None:
            return Meant(station.automaton, found.supervisor, found.guards, found.reached)
    raise SystemExit(f"{station.automaton.name} has no supervisor")


def documents(folder: Path) -> dict[str, object]:
    """All that is written, by path of the entry, as it is loaded."""
    loaded = load_station(folder)
    whole = {"station": loaded.station, **{f"resources/{name}": each for name, each in loaded.resources.items()}}
    listed = {"operations": loaded.operations, "specifications": loaded.specifications, "work_masters": loaded.work_masters}
    entries = {f"{file}/{name}": each for file, named in listed.items() for name, each in named.items()}
    return {path: plain(document.model_dump()) for path, document in {**whole, **entries}.items()}


def plain(value: object) -> object:
    """Without the line breaks of texts."""
    if isinstance(value, str):
        return " ".join(value.split())
    if isinstance(value, dict):
        return {plain(key): plain(each) for key, each in value.items()}
    return [plain(each) for each in value] if isinstance(value, list | tuple) else value


def hashes(folder: Path, station: ReadyStation) -> dict[str, str]:
    """The type hashes of the messages, services and actions that are defined there, by name."""
    names = [
        f"{path.parents[1].name}/{kind}/{path.stem}"
        for kind in DEFINITIONS
        for path in (folder / "messages").glob(f"*/{kind}/*.{kind}")
    ]
    return {name: station.registry.type_hash(name) for name in names}


def otherwise(first: dict[str, object], second: dict[str, object]) -> Iterator[str]:
    """What is in one of them only, or is another."""
    for name in sorted(first.keys() | second.keys()):
        if first.get(name) != second.get(name):
            yield f"{name}:\n  {first.get(name)}\n  {second.get(name)}"


def all_differences(one: Path, other: Path) -> Iterator[str]:
    """What is otherwise, in words."""
    first, second = prepare_station(one), prepare_station(other)
    yield from otherwise({**hashes(one, first)}, {**hashes(other, second)})
    yield from otherwise(documents(one), documents(other))
    old, new = meant(first), meant(second)
    written = differences(Written(old.automaton, old.guards), Written(new.automaton, new.guards))
    behaviour, undecided = behaviour_differences(old, new)
    plans, unplanned = plan_differences(old, new, (behaviour, undecided))
    for found in (*written, *behaviour, *plans):
        yield found.model_dump_json()
    for name in (*undecided, *unplanned):
        yield f"It is not known whether {name} does the same."


if __name__ == "__main__":
    said = list(all_differences(Path(sys.argv[1]), Path(sys.argv[2])))
    sys.stdout.write("".join(f"{each}\n" for each in said))
    sys.exit(bool(said))
