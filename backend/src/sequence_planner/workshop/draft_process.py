"""The process that keeps what it has read of the draft, and answers questions about it at once."""

from __future__ import annotations

from sequence_planner.analysis.document import FindingDocument
from sequence_planner.workshop.files import Files
from sequence_planner.workshop.processes import PATIENCE, Answering


class DraftProcess:
    """Answers questions about a draft, of which it is told only what is new. Used from one event loop."""

    def __init__(self) -> None:
        self._process = Answering("language_worker", "answering")
        self._told: dict[str, str] = {}  # the files that the process knows

    async def close(self) -> None:
        """End the process."""
        await self._process.close()

    async def ask(self, files: Files, name: str, *asked: object, patience: float = PATIENCE) -> object:
        """What `name` of the answers there are says about these files, within so many seconds once its turn has come.

        Raises `WorkEndedError`.
        """

        def question() -> object:
            if not self._process.begun:
                self._told = {}
            changed: dict[str, str | None] = {
                path: text for path, text in files.items() if self._told.get(path) != text
            }
            changed |= dict.fromkeys(self._told.keys() - files.keys())
            self._told = dict(files)
            return changed, name, asked

        return await self._process.ask(question, patience)

    async def errors(self, files: Files) -> list[FindingDocument]:
        """What makes these files unusable, as far as it shows before pipelines are built. Raises `WorkEndedError`."""
        found = await self.ask(files, "errors")
        assert isinstance(found, list)
        return found
