"""Drafts whose pipelines are looked at: the stations that come with the program, and the one of the documentation."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from sequence_planner.editor.draft import Edit, applied
from sequence_planner.editor.pipelines.graph import DraftPipelines
from sequence_planner.editor.pipelines.reader import DraftReader
from sequence_planner.model.files import read_files, write_files
from sequence_planner.station import ReadyStation, prepare_station

REPOSITORY = Path(__file__).parents[4]
MODELS = ("bolt_tightening", "docking_agv", "robots_with_buffer", "truck_engine_station")
REACH = "reach"  # of docs/pipelines.md: most kinds of stages, a flow, examples
NOWHERE = Path("/nowhere")


@cache
def files_of(name: str) -> Mapping[str, str]:
    """The files of a station."""
    if name != REACH:
        return read_files(REPOSITORY / "models" / name)
    text = (REPOSITORY / "docs" / "pipelines.md").read_text(encoding="utf-8")
    found: dict[str, str] = {}
    for path, content in re.findall(r"^```\w+ (\S+)\n((?:.*\n)*?)```$", text, re.MULTILINE):
        found.setdefault(path, content)
    return found


def graph_of(files: Mapping[str, str]) -> DraftPipelines:
    """The pipelines of a draft that consists of these files."""
    return DraftPipelines(DraftReader(Path(mkdtemp())).sketch(files))


@cache
def shipped(name: str) -> DraftPipelines:
    """The pipelines of a station as it is."""
    return graph_of(files_of(name))


def prepared(files: Mapping[str, str], folder: Path) -> ReadyStation:
    """The station as a controller has it. Raises `ModelError`."""
    write_files(files, folder)
    return prepare_station(folder)


def edited(files: Mapping[str, str], *edits: Edit) -> dict[str, str]:
    """The files after these edits."""
    return applied(files, edits)
