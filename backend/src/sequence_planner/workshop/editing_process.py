"""The process that does what engineers do to the draft, so that nobody who stops the station waits for it."""

from __future__ import annotations

from sequence_planner.workshop.asking import Changed, DraftAnswering
from sequence_planner.workshop.files import Files
from sequence_planner.workshop.processes import PATIENCE


class EditingProcess:
    """Asked about a draft, of which it is told only what is new. Used from one event loop."""

    def __init__(self) -> None:
        self._process = DraftAnswering("editing_worker", "answering", 1)

    async def close(self) -> None:
        """End the process."""
        await self._process.close()

    async def ask(self, files: Files, name: str, *asked: object) -> object:
        """What `name` of the answers there are says about these files.

        Raises `EditError`, `BodyError` and `WorkEndedError`.
        """

        def question(changed: Changed) -> object:
            return changed, name, asked

        return await self._process.ask(question, files, patience=PATIENCE)
