"""Broken copies of a small station, in which ‹ marks the place of the error."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sequence_planner.model.source import ModelError
from sequence_planner.station import prepare_station
from support.places import CELL


def copy_of_cell(folder: Path) -> Path:
    """A copy of the station `cell` in `folder`."""
    return Path(shutil.copytree(CELL, folder / "cell"))


def replace(station: Path, file: str, old: str, new: str) -> list[str]:
    """Write `new` in place of `old`; returns the places `file:line:column` of the marks in it, in order."""
    path = station / file
    text = path.read_text(encoding="utf-8")
    assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {file}"
    return write(station, file, text.replace(old, new))


def write(station: Path, file: str, text: str) -> list[str]:
    """Write a whole file; returns the places of the marks in it."""
    places: list[str] = []
    while (index := text.find("‹")) >= 0:
        text = text[:index] + text[index + 1 :]
        above = text[:index].split("\n")
        places.append(f"{station / file}:{len(above)}:{len(above[-1]) + 1}")
    path = station / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return places


def findings(station: Path) -> list[str]:
    """What is said of a station that cannot be used, line by line."""
    with pytest.raises(ModelError) as caught:
        prepare_station(station)
    lines = str(caught.value).split("\n")
    assert lines == [str(finding) for finding in caught.value.findings]
    return lines


def assert_found(folder: Path, file: str, old: str, new: str, message: str) -> None:
    """A copy of the cell with `new` in place of `old` is refused with exactly one line."""
    station = copy_of_cell(folder)
    [place] = replace(station, file, old, new)
    assert findings(station) == [f"{place}: {message}"]
