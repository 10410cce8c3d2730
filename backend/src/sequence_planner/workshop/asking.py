"""A process that is asked about the draft again and again, and knows its files from one question to the next."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sequence_planner.control.view_part import View
from sequence_planner.model.paths import EditError
from sequence_planner.workshop.bodies import BodyError
from sequence_planner.workshop.files import Files
from sequence_planner.workshop.processes import Answering

Changed = Mapping[str, str | None]


class Knowing:
    """What such a process has been told of some files; only what is another text is told again."""

    def __init__(self) -> None:
        self._told: dict[str, str] = {}

    def forget(self) -> None:
        """Nobody knows anything."""
        self._told = {}

    def news(self, files: Files) -> Changed:
        """What is to be told so that all is known; none is a file that is gone."""
        changed: dict[str, str | None] = {path: text for path, text in files.items() if self._told.get(path) != text}
        changed |= dict.fromkeys(self._told.keys() - files.keys())
        self._told = dict(files)
        return changed


def answered(work: Callable[[], object]) -> object:
    """What such a process answers: what `work` gives, views of it as JSON, or why there is nothing."""
    try:
        found = work()
    except (EditError, BodyError) as error:
        return error
    return found.model_dump_json() if isinstance(found, View) else found


class DraftAnswering:
    """Asks `name`, a function of a module of this room, about several versions of a model."""

    def __init__(self, module: str, name: str, versions: int) -> None:
        self._process = Answering(module, name)
        self._known = [Knowing() for _ in range(versions)]

    async def ask(self, question: Callable[..., object], *versions: Files, patience: float) -> object:
        """The answer to what `question` makes of what has changed in each version.

        Raises `WorkEndedError`, and the `EditError` or `BodyError` that was answered.
        """

        def asked() -> object:
            if not self._process.begun:
                for known in self._known:
                    known.forget()
            return question(*(known.news(files) for known, files in zip(self._known, versions, strict=True)))

        answer = await self._process.ask(asked, patience)
        if isinstance(answer, EditError | BodyError):
            raise answer
        return answer

    async def close(self) -> None:
        """End the process."""
        await self._process.close()
