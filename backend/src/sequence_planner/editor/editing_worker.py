"""The work of engineers on the draft and its revisions, by a process that keeps what it has read of the draft's files.

Whoever stops the station does not wait for any of it. What is shown is told as JSON, ready to be sent.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from sequence_planner.core.actor import Actor
from sequence_planner.editor import draft as drafts
from sequence_planner.editor.draft import ChangeBody, Differences, Draft, DraftChange, DraftProposal, Edit
from sequence_planner.editor.processes import encoded, read_body
from sequence_planner.editor.revision import Revision
from sequence_planner.editor.revisions import Revisions, tree_of
from sequence_planner.editor.schemas.draft import FileReader
from sequence_planner.model.examples.library import renamed_station, station_name
from sequence_planner.model.files import Files
from sequence_planner.process.budget import Budget

# Files that are others since the last question, none for those that are gone; what is asked, and about what.
EditingQuestion = tuple[Mapping[str, str | None], str, tuple[object, ...]]


class EditingBench:
    """The files of the draft, as they were told last."""

    def __init__(self) -> None:
        self._files: dict[str, str] = {}
        self._reader = FileReader()

    def answer(self, question: EditingQuestion) -> object:
        """Return what is answered. Raises as what is asked for does."""
        changed, name, asked = question
        for path, text in changed.items():
            if text is None:
                self._files.pop(path, None)
            else:
                self._files[path] = text
        return _ANSWERS[name](self, *asked)

    def requested(self, body: bytes) -> DraftProposal:
        """Return what becomes of it by a request of an engineer."""
        asked = read_body(ChangeBody, body)
        return self.edited(asked.edits, asked.title)

    def edited(self, edits: Sequence[Edit], title: str) -> DraftProposal:
        """Return what becomes of it by edits."""
        return drafts.editing(self._draft, edits, title)

    def begun_with(self, example: Files, title: str) -> DraftProposal:
        """Return what becomes of it where it is begun with an example: the name of the station stays."""
        name = station_name(self._files)
        return drafts.replacing(self._draft, example if name is None else renamed_station(example, name), title)

    def undone(self, of: DraftChange, differences: Differences) -> DraftProposal:
        """Return what becomes of it without a change."""
        return drafts.undoing(self._draft, of, differences)

    def redone(self, of: DraftChange, differences: Differences) -> DraftProposal:
        """Return what becomes of it with a change that was taken back."""
        return drafts.redoing(self._draft, of, differences)

    def taken_up(self, number: int, base: Files, files: Files) -> DraftProposal:
        """Return what becomes of it when what it began from is others' files by now."""
        return drafts.taking_up(Draft(number, self._files, base), files)

    def shown(self, number: int, paths: Sequence[str] | None) -> str:
        """JSON of a `FilesView` of these files, or of all."""
        return self._reader.shown(Draft(number, self._files, {}), list(self._files) if paths is None else paths)

    def saved(self, folder: Path, base: Files, name: str, message: str, by: Actor, now: float) -> Revision:
        """The draft saved as a revision."""
        return Revisions(folder).save(self._files, base, name, message, by, now)

    def revised(self, folder: Path, base: Files) -> tuple[list[Revision], str, str]:
        """All revisions, the tree of what runs, and that of the draft."""
        return list(Revisions(folder).all()), tree_of(base), tree_of(self._files)

    def files_of(self, folder: Path, revision: str) -> dict[str, str]:
        """The files of a revision."""
        return Revisions(folder).files(revision)

    @property
    def _draft(self) -> Draft:
        return Draft(0, self._files, {})


# What can be asked, by the names that questions bear.
_ANSWERS: Mapping[str, Callable[..., object]] = {
    each.__name__: each
    for each in (
        EditingBench.requested,
        EditingBench.edited,
        EditingBench.begun_with,
        EditingBench.undone,
        EditingBench.redone,
        EditingBench.taken_up,
        EditingBench.shown,
        EditingBench.saved,
        EditingBench.revised,
        EditingBench.files_of,
    )
}


def answering(_: Path) -> Callable[[EditingQuestion, Budget], object]:
    """Return what answers questions; a process's life."""
    bench = EditingBench()
    return lambda question, _: encoded(bench.answer(question))
