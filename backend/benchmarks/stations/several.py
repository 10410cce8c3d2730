"""A model with the resources of the truck engine station several times, side by side.

Each copy has its own names and topics. Neighbours share the place at which the kit is taken from the AGV, so that what
one does matters to the next: a robot is there while no neighbour is. `several.py FOLDER NUMBER` writes it.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

MODEL = Path(__file__).parents[3] / "models" / "truck_engine_station"
_ONCE = {Path("mimic.yaml"), Path("shifts.yaml")}
"""What a station has once, and says nothing of what several do."""
_AT_KIT = "target_pose == AtLadderFrameTCPPose or pose == AtLadderFrameTCPPose"


def write_several(folder: Path, number: int) -> Path:
    """Write the model with `number` copies into a new folder, which it gives back."""
    files = {path.relative_to(MODEL): path.read_text() for path in MODEL.rglob("*") if path.is_file()}
    files = {name: text for name, text in files.items() if name not in _ONCE}
    station = _read(files.pop(Path("station.yaml")))
    resources = [name.stem for name in files if name.parent == Path("resources")]
    things = [*station["predicates"], *station["estimated"], *resources]
    tops = [key for name, text in files.items() if name.parent == Path() for key in _read(text)]

    def copy(text: str, which: int, names: Iterable[str] = things) -> str:
        """The text with the names of the copy; a resource may call its own variable like an operation."""
        word = rf"(?<![.\w])({'|'.join(sorted(names, key=len, reverse=True))})\b"
        return re.sub(word, rf"\1_{which}", text.replace("/unification_ros", f"/station_{which}/unification_ros"))

    copies = range(1, number + 1)
    for name, text in files.items():
        if name.parent == Path("resources"):
            for which in copies:
                _write(folder / "resources" / f"{name.stem}_{which}.yaml", copy(text, which))
        elif name.suffix == ".yaml":
            _write(folder / name, "".join(copy(text, which, (*things, *tops)) for which in copies))
        else:
            _write(folder / name, text)
    with (folder / "specifications.yaml").open("a") as file:
        for which in copies[:-1]:
            zone = {f"robot_{each}": _AT_KIT for each in (which, which + 1)}
            title = f"One of stations {which} and {which + 1} at the kit"
            file.write(f"one_at_kit_{which}: {json.dumps({'title': title, 'zone': zone})}\n")
    for section in ("predicates", "estimated"):
        text = json.dumps(station[section])
        station[section] = {name: what for which in copies for name, what in json.loads(copy(text, which)).items()}
    station["rest"] = " and ".join(f"({copy(station['rest'], which)})" for which in copies)
    _write(folder / "station.yaml", json.dumps(station))
    return folder


def _read(text: str) -> dict[str, Any]:
    found: dict[str, Any] = YAML(typ="safe").load(text)
    return found


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


if __name__ == "__main__":
    write_several(Path(sys.argv[1]), int(sys.argv[2]))
