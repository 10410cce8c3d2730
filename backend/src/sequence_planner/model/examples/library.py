"""Where the example stations are, and what becomes of one where somebody begins with it."""

from __future__ import annotations

import re
from pathlib import Path

from sequence_planner.model.files import Files, read_files
from sequence_planner.model.paths import EditError
from sequence_planner.model.yaml import editor

STATION = "station.yaml"
PROGRAM = Path(__file__).resolve().parents[2]
# In a distribution they are in the package, and in the repository beside the backend.
PACKAGED = PROGRAM / "models"
EXAMPLES = PACKAGED if PACKAGED.is_dir() else PROGRAM.parents[2] / "models"
# A file says by its first line where the schemas are that an editor completes and checks by.
_SCHEMA = re.compile(r"^(# yaml-language-server: \$schema=(?:\.\./)*)\.\./\.\./docs/schemas/")


def example_folders(folder: Path = EXAMPLES) -> dict[str, Path]:
    """The folders of the examples below `folder` by their names, in the order of these; none where it is not there."""
    return {path.parent.name: path.parent for path in sorted(folder.glob(f"*/{STATION}"))}


def example_files(folder: Path) -> dict[str, str]:
    """The files of an example as they are in a station of one's own, whose schemas are in `.schemas`.

    Raises `OSError`.
    """
    return {
        path: _SCHEMA.sub(r"\1.schemas/", text, count=1) if path.endswith(".yaml") else text
        for path, text in read_files(folder).items()
    }


def renamed_station(files: Files, name: str) -> dict[str, str]:
    """The same files with another name of the station."""
    return {**files, STATION: editor.replace(files[STATION], ("name",), name)}


def station_name(files: Files) -> str | None:
    """The name of the station; None where its file says none, or cannot be read."""
    try:
        found = editor.value_at(files.get(STATION, ""), ("name",))
    except EditError:
        return None
    return found if isinstance(found, str) else None
