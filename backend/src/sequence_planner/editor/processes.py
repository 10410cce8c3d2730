"""Worker processes of the editor: edits, checks and language queries on the draft, and request bodies."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import json
import tempfile
import time
from collections import OrderedDict
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
from sequence_planner.editor.schemas.check import CheckState, CheckView, doing, waiting
from sequence_planner.editor.schemas.diff import comparison_begun
from sequence_planner.model.files import Files
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.model.paths import EditError
from sequence_planner.model.validation import members
from sequence_planner.process.memory_limit import memory_limit
from sequence_planner.process.task import NO_ANSWER, BackgroundTask, WorkerError
from sequence_planner.process.worker import FOLDER, Worker, WorkerLateError
from sequence_planner.texts.message import message

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
    What another module of the editor finds is named as in `module:name`.

    Iterating raises `WorkerError`.
    """
    with tempfile.TemporaryDirectory(prefix="sequence-planner-workshop-") as folder:
        # Named and not handed over: the server does without what that imports.
        module, _, function = name.rpartition(":")
        work = f"sequence_planner.editor.{module or 'checks'}:{function}"
        task: BackgroundTask[object] = BackgroundTask(
            work, (*arguments, Path(folder)), function, _NICENESS, memory_limit()
        )
        async with task.telling() as found:
            yield found


async def worked(name: str, *arguments: object, patience: float = PATIENCE) -> object:
    """Return what `name` of the checks finds within so many seconds. Raises `WorkerError`."""
    try:
        async with asyncio.timeout(patience), working(name, *arguments) as found:
            return await anext(found)
    except TimeoutError:
        raise WorkerError(message("work.given-up", seconds=f"{patience:g}")) from None


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

    def __init__(self, module: str, versions: int, rests_after: float = RESTS_AFTER) -> None:
        self._process: Worker[object, object] = Worker(
            f"sequence_planner.editor.{module}:answering",  # named: the server does without what that imports
            FOLDER,
            module.rpartition(".")[2],
            niceness=_ANSWERING,
            errors=(EditError, BodyError),
            late=0.0,
            starting=None,
            rests_after=rests_after,
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
                raise WorkerError(message("work.late", seconds=f"{patience:g}")) from None
            except WorkerError:
                raise WorkerError(NO_ANSWER) from None

    def close(self) -> None:
        """End the process."""
        self._process.close()


class DraftProcess:
    """Keeps what it has read of the draft, and answers at once what `module` can be asked about it."""

    def __init__(self, module: str = "language_worker", *, rests_after: float = RESTS_AFTER) -> None:
        self._process = DraftAnswering(module, 1, rests_after)

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
                    waiting(number).model_copy(update={"state": CheckState.DONE, **doing(None), "findings": errors})
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
            late = message("work.given-up", seconds=f"{self._deadline:g}")
            self._tell(view.model_copy(update={"state": CheckState.FAILED, **doing(late)}))
        except WorkerError as ended:
            self._tell(view.model_copy(update={"state": CheckState.FAILED, **doing(ended.why)}))


# Comparisons of versions of the model, each for all who ask about the same two.
#
# One goes on as long as somebody asks for it, and what came of the last ones is known.

LEFT_AFTER = 3.0  # seconds without a question, after which nobody waits for a comparison any more
MOST_KNOWN = 6  # comparisons that have ended

Pair = tuple[bytes, bytes, bool]  # which models, and whether only what is written in them


class Comparing:
    """One comparison under way, or what came of it."""

    def __init__(self) -> None:
        self.told: str | None = None  # JSON of a `ComparisonView`
        self.whole = False
        self.ended = asyncio.Event()
        self.trouble: WorkerError | None = None
        self.asking = 0
        self.left = time.monotonic()
        self.task: asyncio.Task[None] | None = None

    @property
    def abandoned(self) -> bool:
        """True once nobody has asked for it for a while."""
        return not self.asking and time.monotonic() - self.left > LEFT_AFTER


class ComparisonDesk:
    """Compares models with the Python stages of the model `stages`, from one event loop."""

    def __init__(self, stages: Path | None) -> None:
        self._stages = stages
        self._known: OrderedDict[Pair, Comparing] = OrderedDict()
        self._prepared: bytes | None = None
        self._preparing: asyncio.Task[None] | None = None

    def warm_up(self, running: Files) -> None:
        """Find out about the model that runs what others are compared with: it is known then, whoever compares it."""
        if (digest := _digest(running)) != self._prepared:
            self._prepared = digest
            if self._preparing is not None:
                self._preparing.cancel()
            self._preparing = asyncio.create_task(self._prepare(dict(running)))

    async def _prepare(self, running: Files) -> None:
        with contextlib.suppress(WorkerError):  # who compares it finds out why
            await worked("comparing.comparison:made_known", running, self._stages)

    async def compare(self, old: Files, new: Files, patience: float, *, written_only: bool = False) -> str:
        """Return what is known within so many seconds of how two models differ, or only of how that is written, as JSON
        of a `ComparisonView`.

        Raises `WorkerError`.
        """
        pair = _digest(old), _digest(new), written_only
        comparing = self._known.get(pair)
        if comparing is None:
            comparing = self._known[pair] = Comparing()
            comparing.task = asyncio.create_task(self._work(pair, comparing, old, new))
        self._known.move_to_end(pair)
        comparing.asking += 1
        try:
            async with asyncio.timeout(patience):
                await comparing.ended.wait()
        except TimeoutError:
            pass  # what is known by now
        finally:
            comparing.asking -= 1
            comparing.left = time.monotonic()
        if comparing.trouble is not None:
            raise comparing.trouble
        return comparing.told or comparison_begun({}).model_dump_json()

    async def close(self) -> None:
        """End what is being compared."""
        tasks = [task for task in (self._preparing, *(each.task for each in self._known.values())) if task is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _work(self, pair: Pair, comparing: Comparing, old: Files, new: Files) -> None:
        """Compare two models, until that is done or nobody asks for it any more."""
        telling = asyncio.create_task(self._tell(comparing, dict(old), dict(new), written_only=pair[2]))
        try:
            while not telling.done() and not comparing.abandoned:
                await asyncio.wait((telling,), timeout=LEFT_AFTER)
            if telling.done():
                await telling
        except WorkerError as error:
            comparing.trouble = error
        finally:
            telling.cancel()
            await asyncio.gather(telling, return_exceptions=True)
            comparing.ended.set()
            if not comparing.whole:
                self._known.pop(pair, None)  # whoever asks again wants it tried again
            self._forget()

    async def _tell(self, comparing: Comparing, old: Files, new: Files, *, written_only: bool) -> None:
        asked = old, new, written_only, self._stages
        try:
            async with asyncio.timeout(PATIENCE), working("comparing.comparison:comparison", *asked) as found:
                async for told in found:
                    assert isinstance(told, tuple)
                    comparing.told, comparing.whole = told
        except TimeoutError:
            raise WorkerError(message("work.given-up", seconds=f"{PATIENCE:g}")) from None

    def _forget(self) -> None:
        """Keep no more of what has ended than the last ones."""
        ended = [pair for pair, each in self._known.items() if each.ended.is_set()]
        for pair in ended[:-MOST_KNOWN]:
            del self._known[pair]


def _digest(files: Files) -> bytes:
    total = hashlib.sha256()
    for path, text in sorted(files.items()):
        for each in (path.encode(), text.encode()):
            total.update(len(each).to_bytes(8) + each)
    return total.digest()


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
