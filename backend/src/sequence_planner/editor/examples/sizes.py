"""What the example stations are called and how large they are, found by a process of its own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from sequence_planner.editor.examples.schemas import ExamplesView, ExampleView
from sequence_planner.model.examples.library import example_folders
from sequence_planner.model.fields import words_of
from sequence_planner.model.loader import load_station
from sequence_planner.model.source import ModelError


def listed_examples(folder: Path, _: Path) -> Iterator[ExamplesView]:
    """Tell of all examples below `folder`; one that cannot be read is none."""
    yield ExamplesView(examples=[view for name, path in example_folders(folder).items() for view in _views(name, path)])


def _views(name: str, folder: Path) -> Iterator[ExampleView]:
    try:
        station = load_station(folder)
    except ModelError:
        return
    written = words_of(station.station.title)
    yield ExampleView(
        name=name,
        title={"en": str(station.title), **{each: said for each, said in written.items() if each}},
        description=str(station.station.description or ""),
        resources=len(station.resources),
        abilities=sum(len(each.abilities) for each in station.resources.values()),
        operations=len(station.operations),
    )
