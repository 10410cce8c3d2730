"""Worker processes of the editor: edits, checks and language queries on the draft, and request bodies."""

from __future__ import annotations

import asyncio
import json
import tempfile
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Protocol, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from sequence_planner.analysis.report import FindingDocument
from sequence_planner.controller.views.part import View
from sequence_planner.editor.draft import FilePath, Steps
from sequence_planner.editor.language.schemas import CompletionView, HoverView, ProblemView
from sequence_planner.editor.schemas.check import CheckState, CheckView, waiting
from sequence_planner.model.files import Files
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.model.paths import EditError
from sequence_planner.model.validation import members
from sequence_planner.process.memory_limit import memory_limit
from sequence_planner.process.task import NO_ANSWER, BackgroundTask, WorkerError
from sequence_planner.process.worker import FOLDER, Worker, WorkerLateError

# Bodies of requests that may be large: each is read by the process that does what it asks for.
#
# To read a body of some megabytes takes its reader longer than a stop may wait.

Asked = TypeVar("Asked", bound=BaseModel)


class BodyError(Exception):
    """A body that is not as expected: the places where it is `wrong`, as in `body.change`, each with what is wrong
    there; or else why it is `not_json`.
    """

    def __init__(self, wrong: list[tuple[str, str]], not_json: str = "") -> None:
        super().__init__(wrong, not_json)
        self.wrong = wrong
        self.not_json = not_json


def read_body(model: type[Asked], body: bytes) -> Asked:
    """Return what a body asks for. Raises `BodyError`."""
    if not body:
        raise BodyError([("body", "this is missing")])
    try:
        content = json.loads(body)
    except json.JSONDecodeError as error:
        raise _not_json(error.msg, error.pos) from None
    except UnicodeDecodeError as error:
        raise _not_json("this is not UTF-8", error.start) from None
    except RecursionError:
        raise _not_json("it is nested too deeply", 0) from None
    try:
        return model.model_validate(content)
    except ValidationError as error:
        found = error.errors(include_url=False, include_input=False)
        raise BodyError(members(({**each, "loc": ("body", *each["loc"])} for each in found), model)) from None


def _not_json(why: str, position: int) -> BodyError:
    return BodyError([], f"{why} at character {position}")


# What is found of whole models, each time by a process of its own.

PATIENCE = 60.0  # seconds
_NICENESS = 15  # ticks come first, then whoever waits for an answer


@asynccontextmanager
async def working(name: str, *arguments: object) -> AsyncIterator[AsyncIterator[object]]:
    """Give what `name` of the checks finds, until the block is left; its last argument is the path of an empty folder.

    Iterating raises `WorkerError`.
    """
    with tempfile.TemporaryDirectory(prefix="sequence-planner-workshop-") as folder:
        # Named and not handed over: the server does without what that imports.
        work = f"sequence_planner.editor.checks:{name}"
        task: BackgroundTask[object] = BackgroundTask(work, (*arguments, Path(folder)), name, _NICENESS, memory_limit())
        async with task.telling() as found:
            yield found


async def worked(name: str, *arguments: object, patience: float = PATIENCE) -> object:
    """Return what `name` of the checks finds within so many seconds. Raises `WorkerError`."""
    try:
        async with asyncio.timeout(patience), working(name, *arguments) as found:
            return await anext(found)
    except TimeoutError:
        raise WorkerError(f"it took more than {patience:g} s and was given up") from None


# A process that is asked about the draft again and again, and knows its files from one question to the next.

Changed = Mapping[str, str | None]
RESTS_AFTER = 60.0  # seconds without a question, after which it ends until there is one
_ANSWERING = 5  # niceness: ticks come first, then whoever waits for an answer, then checks


class Knowing:
    """The things that such a process has been told of some files; only what is another text is told again."""

    def __init__(self) -> None:
        self._told: dict[str, str] = {}

    def forget(self) -> None:
        """Nobody knows anything."""
        self._told = {}

    def news(self, files: Files) -> Changed:
        """Return what is to be told so that all is known; none is a file that is gone."""
        changed: dict[str, str | None] = {path: text for path, text in files.items() if self._told.get(path) != text}
        changed |= dict.fromkeys(self._told.keys() - files.keys())
        self._told = dict(files)
        return changed


def encoded(found: object) -> object:
    """Return what such a process answers: views as JSON."""
    return found.model_dump_json() if isinstance(found, View) else found


class DraftAnswering:
    """Asks by `module` of the editor about several versions of a model. Used from one event loop."""

    def __init__(self, module: str, versions: int) -> None:
        self._process: Worker[object, object] = Worker(
            f"sequence_planner.editor.{module}:answering",  # named: the server does without what that imports
            FOLDER,
            module.rpartition(".")[2],
            niceness=_ANSWERING,
            errors=(EditError, BodyError),
            late=0.0,
            starting=None,
            rests_after=RESTS_AFTER,
            kept=False,
        )
        self._turn = asyncio.Lock()
        self._known = [Knowing() for _ in range(versions)]

    async def ask(self, question: Callable[..., object], *versions: Files, patience: float) -> object:
        """The answer to what `question` makes of what has changed in each version, within so many seconds from its turn
        on.

        Raises `WorkerError`, and the `EditError` or `BodyError` that was answered.
        """
        async with self._turn:
            if not self._process.begun:
                for known in self._known:
                    known.forget()
            asked = question(*(known.news(files) for known, files in zip(self._known, versions, strict=True)))
            try:
                return await self._process.ask(asked, patience)
            except WorkerLateError:
                raise WorkerError(f"there was no answer within {patience:g} s") from None
            except WorkerError:
                raise WorkerError(NO_ANSWER) from None

    def close(self) -> None:
        """End the process."""
        self._process.close()


class DraftProcess:
    """Keeps what it has read of the draft, and answers at once what `module` can be asked about it."""

    def __init__(self, module: str = "language_worker") -> None:
        self._process = DraftAnswering(module, 1)

    def close(self) -> None:
        """End the process."""
        self._process.close()

    async def ask(self, files: Files, name: str, *asked: object, patience: float = PATIENCE) -> object:
        """Return what `name` of the answers there are says about these files, within so many seconds once its turn has
        come.

        Views are told as JSON. Raises `EditError`, `BodyError` and `WorkerError`.
        """

        def question(changed: Changed) -> object:
            return changed, name, asked

        return await self._process.ask(question, files, patience=patience)

    async def errors(self, files: Files) -> list[FindingDocument]:
        """Return what makes these files unusable, as far as it shows before pipelines are built; or `WorkerError`."""
        found = await self.ask(files, "errors")
        assert isinstance(found, list)
        return found


# Checks of the draft, of which only the newest matters.

SETTLED = 0.15  # seconds without a change after which the whole is checked


class QuickCheck(Protocol):
    """What says at once what makes a draft unusable."""

    async def errors(self, files: Files) -> list[FindingDocument]:
        """Return what makes these files unusable, as far as it shows before pipelines are built; or `WorkerError`."""
        ...


class CheckDesk:
    """Checks what it is told to, from one event loop. `stages` is the model whose Python stages belong to the draft,
    which is to be run as `start` says.

    `process` says at once what makes the draft unusable; all else is found by a process for each check, from scratch,
    within `deadline` seconds if that is given. `tell` is called with each view, all of one check in their order.
    """

    def __init__(
        self,
        stages: Path | None,
        start: StartNeeds,
        process: QuickCheck,
        tell: Callable[[CheckView], None],
        deadline: float | None = None,
    ) -> None:
        self._stages = stages
        self._start = start
        self._process = process
        self._tell = tell
        self._deadline = deadline
        self._wanted: tuple[int, Files] | None = None
        self._looking: asyncio.Task[None] | None = None
        self._checking: asyncio.Task[None] | None = None

    def check(self, number: int, files: Files) -> None:
        """Check this now, and nothing else any more."""
        if self._checking is not None:
            self._checking.cancel()
        self._tell(waiting(number))
        self._wanted = number, dict(files)
        if self._looking is None or self._looking.done():
            self._looking = asyncio.create_task(self._look())

    async def close(self) -> None:
        """End what is being checked."""
        tasks = [task for task in (self._looking, self._checking) if task is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _look(self) -> None:
        """Look for errors in what is wanted last, and check it as a whole if there are none."""
        while self._wanted is not None:
            (number, files), self._wanted = self._wanted, None
            try:
                errors = await self._process.errors(files)
            except WorkerError:
                errors = []  # then the check says what is the matter
            if self._wanted is not None:
                continue
            if errors:
                self._tell(
                    waiting(number).model_copy(update={"state": CheckState.DONE, "doing": "", "findings": errors})
                )
            else:
                self._checking = asyncio.create_task(self._checked(number, files, self._checking))

    async def _checked(self, number: int, files: Files, before: asyncio.Task[None] | None) -> None:
        if before is not None:
            await asyncio.gather(before, return_exceptions=True)
        await asyncio.sleep(SETTLED)
        view = waiting(number)
        try:
            arguments = number, files, self._stages, self._start
            async with asyncio.timeout(self._deadline), working("checked", *arguments) as found:
                async for told in found:
                    assert isinstance(told, CheckView)
                    view = told
                    self._tell(view)
                    if view.state is CheckState.DONE:
                        break
        except TimeoutError:
            doing = f"it took more than {self._deadline:g} s and was given up"
            self._tell(view.model_copy(update={"state": CheckState.FAILED, "doing": doing}))
        except WorkerError as ended:
            self._tell(view.model_copy(update={"state": CheckState.FAILED, "doing": str(ended)}))


# What is asked about texts of the draft while they are written, and what is answered.

LONGEST_TEXT = 20_000  # characters


class LanguageQuestionKind(StrEnum):
    """A kind of question that can be asked about a text."""

    CHECK = "check"
    COMPLETION = "completion"
    HOVER = "hover"
    FORMAT = "format"


class TextAt(BaseModel):
    """A text that stands, or shall stand, at the entry `path` of a file.

    `parameters` are those of its ability, operation or specification, by name with their enumerations, where it is so
    new that the draft does not have it yet.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    file: FilePath
    path: Annotated[Steps, Field(min_length=1)]
    text: Annotated[str, Field(max_length=LONGEST_TEXT)]
    parameters: dict[str, str] | None = Field(default=None, max_length=20)


class PlaceInText(TextAt):
    """A place in it, counted in characters from its beginning."""

    offset: Annotated[int, Field(ge=0, le=LONGEST_TEXT, strict=True)]


class ProblemsView(View):
    """Problems of a text; none where it has no names."""

    problems: tuple[ProblemView, ...]


class HoverAnswer(View):
    """The name at the place; null where there is none."""

    hover: HoverView | None


class FormatView(View):
    """The text as it is written best, with the same meaning."""

    text: str


LanguageAnswer = ProblemsView | CompletionView | HoverAnswer | FormatView
