"""The process that keeps what it has read of the draft, and answers questions about it at once."""

from __future__ import annotations

from sequence_planner.analysis.document import FindingDocument
from sequence_planner.workshop.asking import Changed, DraftAnswering
from sequence_planner.workshop.files import Files
from sequence_planner.workshop.processes import PATIENCE


class DraftProcess:
    """Answers questions about a draft, of which it is told only what is new. Used from one event loop."""

    def __init__(self) -> None:
        self._process = DraftAnswering("language_worker", "answering", 1)

    async def close(self) -> None:
        """End the process."""
        await self._process.close()

    async def ask(self, files: Files, name: str, *asked: object, patience: float = PATIENCE) -> object:
        """What `name` of the answers there are says about these files, within so many seconds once its turn has come.

        Views are told as JSON. Raises `EditError` and `WorkEndedError`.
        """

        def question(changed: Changed) -> object:
            return changed, name, asked

        return await self._process.ask(question, files, patience=patience)

    async def errors(self, files: Files) -> list[FindingDocument]:
        """What makes these files unusable, as far as it shows before pipelines are built. Raises `WorkEndedError`."""
        found = await self.ask(files, "errors")
        assert isinstance(found, list)
        return found
