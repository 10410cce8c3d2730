"""Finds folds of a station, and proves each before it is offered: the station is read with it, and compared."""

from __future__ import annotations

import re
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from sequence_planner.editor.draft import Edit, applied
from sequence_planner.editor.folds.all_proposals import all_proposals
from sequence_planner.editor.folds.pipelines import pipeline_difference
from sequence_planner.editor.folds.proposal import FoldProposal, WrittenPlace
from sequence_planner.editor.folds.sameness import difference
from sequence_planner.editor.folds.texts import FoldableStation
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.editor.symbols.texts import ModelContent
from sequence_planner.model.files import Files, write_files
from sequence_planner.model.paths import EditError
from sequence_planner.model.source import ModelError
from sequence_planner.model.yaml.content import plain
from sequence_planner.station import Before, MeantStation, read_station

_COMMENT = re.compile(r"(?:^|(?<=\s))#[^\n]*", re.MULTILINE)
_FOR_EDITORS = "# yaml-language-server:"
_WORTH_A_NAME = 30  # characters that a predicate saves


@dataclass(frozen=True)
class Fold:
    """A way to write something shorter that means the same, which was proven.

    `files` are those that are others with it. Of characters and lines it `saves` so many.
    """

    id: str
    kind: FoldKind
    title: str
    name: str | None
    places: list[WrittenPlace]
    edits: list[Edit]
    files: Mapping[str, str]
    saved_lines: int
    saved_characters: int


class FoundFolds(NamedTuple):
    """Folds of a station, and whether all that could be any were looked at."""

    folds: list[Fold]
    is_whole: bool


class FoldFinder:
    """Finds what can be written shorter in a station, which is written into the empty `folder`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._written: dict[str, str] = {}
        self._before = Before()

    def folds(
        self, files: Files, within: float | None = None, wanted: Callable[[FoldProposal], bool] = lambda _: True
    ) -> FoundFolds:
        """All folds that are `wanted`, those that save most first; as many as can be proven in so many seconds.

        Raises `ModelError` for a station that cannot be used.
        """
        until = None if within is None else time.monotonic() + within
        meant, station = self._look(files)
        proposed = sorted(filter(wanted, all_proposals(station)), key=lambda each: -each.worth)
        found: list[Fold] = []
        for proposal in proposed:
            if until is not None and time.monotonic() > until:
                return FoundFolds(_in_order(found), is_whole=False)
            if (fold := self._proven(files, meant, proposal, proposal.name)) is not None:
                found.append(fold)
        return FoundFolds(_in_order(found), is_whole=True)

    def fold(self, files: Files, wanted: str, name: str | None = None) -> Fold:
        """The fold of which `wanted` is the mark, with another name for what it adds.

        Raises `EditError` where there is none, or it cannot have that name, and `ModelError`.
        """
        meant, station = self._look(files)
        proposal = next((each for each in all_proposals(station) if each.id == wanted), None)
        if proposal is None:
            raise EditError(f"there is no fold `{wanted}`: look at those that there are now")
        if name is not None and proposal.name is None:
            raise EditError(f"the fold `{wanted}` adds nothing that could be called `{name}`")
        if name is not None and (fault := proposal.fault_of(name)) is not None:
            raise EditError(fault)
        if name is not None and name != proposal.name and name in station.taken:
            raise EditError(f"`{name}` is the name of something else: take another one")
        if (fold := self._proven(files, meant, proposal, name or proposal.name)) is None:
            named = "" if name is None else f" with the name `{name}`"
            raise EditError(f"the fold `{wanted}`{named} cannot be proven to leave what the station means as it is")
        return fold

    def _look(self, files: Files) -> tuple[MeantStation, FoldableStation]:
        meant = self._read(files)
        return meant, FoldableStation.made_of(files, meant)

    def _proven(self, files: Files, meant: MeantStation, proposal: FoldProposal, name: str | None) -> Fold | None:
        """The fold, if it is shorter, keeps all comments, and means the same."""
        made = proposal.with_name(name) if name is not None else proposal
        if made.worth <= 0 and made.kind is not FoldKind.SET:
            return None
        try:
            after = applied(files, made.edits)
        except EditError:
            return None
        changed = {file: text for file, text in after.items() if files.get(file) != text}
        lines = sum(files.get(file, "").count("\n") - text.count("\n") for file, text in changed.items())
        characters = sum(len(files.get(file, "")) - len(text) for file, text in changed.items())
        if not _is_shorter(proposal.kind, lines, characters) or not _keeps_comments(proposal.kind, files, changed):
            return None
        try:
            now = self._read(after)
        except ModelError:
            return None
        if difference(meant.automaton, now.automaton) is not None:
            return None
        if proposal.kind is FoldKind.TYPE:  # nothing is said in other words
            if _resources(files) != _resources(after):
                return None
        elif pipeline_difference(meant, now) is not None:
            return None
        return Fold(proposal.id, proposal.kind, made.title, name, made.places, made.edits, changed, lines, characters)

    def _read(self, files: Files) -> MeantStation:
        self._folder.mkdir(exist_ok=True)
        for file in self._written.keys() - files.keys():
            (self._folder / file).unlink()
        write_files({file: text for file, text in files.items() if self._written.get(file) != text}, self._folder)
        self._written = dict(files)
        return read_station(self._folder, self._before)


def _in_order(folds: list[Fold]) -> list[Fold]:
    return sorted(folds, key=lambda fold: (-fold.saved_lines, -fold.saved_characters))


def _resources(files: Files) -> Mapping[str, object]:
    """What each resource says, with what it has of its types."""
    return {name: plain(content) for name, _, content in ModelContent(files).resources()}


def _is_shorter(kind: FoldKind, lines: int, characters: int) -> bool:
    """Return whether a fold is worth it; values that are named are written once, be that longer."""
    match kind:
        case FoldKind.SET:
            return True
        case FoldKind.PREDICATE:
            return characters > _WORTH_A_NAME
        case FoldKind.INCLUDES:
            return lines >= 0
    return characters > 0


def _keeps_comments(kind: FoldKind, files: Files, changed: Mapping[str, str]) -> bool:
    """Return whether each file keeps its comments; with a type, whether they are kept anywhere."""
    if kind is FoldKind.TYPE:
        kept = set[str]().union(*(_comments(text) for text in changed.values()))
        return all(kept.issuperset(_comments(files.get(file, ""))) for file in changed)
    return all(not _comments(files.get(file, "")) - _comments(text) for file, text in changed.items())


def _comments(text: str) -> Counter[str]:
    return Counter(found.strip() for found in _COMMENT.findall(text) if not found.startswith(_FOR_EDITORS))
