"""Stage `python`: a user-defined function in a sandboxed, supervised worker process."""

from __future__ import annotations

import ast
import contextlib
import json
import os
import queue
import re
import selectors
import signal
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Iterator, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, ClassVar

from pydantic import Field

from sequence_planner.core.late_log import LateLog
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.field_paths import REAL, TEXT, FieldPath, fits, is_numeric, is_textual, shown
from sequence_planner.language.records.record import FieldType, ListType, NestedType, Record
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange, Place
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.base import Context, NotInvertibleError, StageDeclaration, StageInstance
from sequence_planner.model.stages.marks import NameMark, NameUse
from sequence_planner.model.stages.suggestions import Candidate, Spot
from sequence_planner.texts.message import message

# One process that runs a function, as its keeper sees it. All calls may wait, at most for the time they are given.

LOG = LateLog(__name__)

STARTING = 10.0  # seconds within which a file must have been loaded
MOST_LINES = 20  # of what is printed during one call, in the log
LONGEST_LINE = 500
MOST_ANSWERED = 1_000_000  # characters
_PROGRAM = Path(__file__).with_name("sandbox") / "program.py"
_CHUNK = 65_536
_PASSED = frozenset({"LANG", "TZ", "LD_LIBRARY_PATH", "PATH", "PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV"})
_PASSED_STARTS = ("LC_", "OMP_", "OPENBLAS_")


class OwnStageError(Exception):
    """A function gave no answer; the text says why."""


class FunctionFailed(OwnStageError):
    """The function raised an exception; its process goes on."""


@dataclass(frozen=True)
class Function:
    """A function in a file of a station, given as they were written and as a path."""

    file: str
    name: str
    path: Path
    folder: Path

    def __str__(self) -> str:
        return f"{self.file} {self.name}"


class FunctionProcess:
    """Starts the process; `load` waits until it can be asked."""

    def __init__(self, function: Function) -> None:
        self._function = function
        command = [sys.executable, "-B", "-P", str(_PROGRAM), str(function.folder), str(function.path), function.name]
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(
            command, stdin=pipe, stdout=pipe, stderr=pipe, bufsize=0, start_new_session=True, env=_environment()
        )
        self._requests, self._answers, self._prints = (
            stream.fileno()
            for stream in (self._process.stdin, self._process.stdout, self._process.stderr)
            if stream is not None
        )
        os.set_blocking(self._requests, False)
        self._answer = self._printed = b""
        self._alive = True
        self._lock = threading.Lock()

    def load(self) -> None:
        """Wait until the file has been loaded. Raises `OwnStageError` if it cannot be."""
        try:
            note_unconfined(self._exchange(b"", STARTING).get("without"))
        except OwnStageError as error:
            raise OwnStageError(f"cannot be loaded: {error}") from None

    def call(self, arguments: Mapping[str, object], deadline: float) -> object:
        """Return what the function returns. Raises `OwnStageError` if it raises, or gives no answer in time."""
        return self._exchange(json.dumps(arguments).encode() + b"\n", deadline).get("gives")

    def kill(self) -> None:
        """End it and what it has started, without waiting. May be called from any thread."""
        with self._lock, contextlib.suppress(ProcessLookupError, PermissionError):
            if self._alive:
                os.killpg(self._process.pid, signal.SIGKILL)

    def close(self) -> None:
        """End it, and wait for that."""
        self.kill()
        os.waitid(os.P_PID, self._process.pid, os.WEXITED | os.WNOWAIT)
        with self._lock:  # from here on the number may belong to another process
            self._alive = False
            self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream is not None:
                stream.close()

    def _exchange(self, request: bytes, deadline: float) -> dict[str, object]:
        end = time.monotonic() + deadline
        try:
            with selectors.DefaultSelector() as selector:
                selector.register(self._answers, selectors.EVENT_READ)
                selector.register(self._prints, selectors.EVENT_READ)
                if request:
                    selector.register(self._requests, selectors.EVENT_WRITE)
                while b"\n" not in self._answer:
                    left = end - time.monotonic()
                    ready = selector.select(left) if left > 0 else []
                    if not ready:
                        raise OwnStageError(f"gave no answer within {deadline:g} s")
                    for key, _ in ready:
                        if key.fd == self._requests:
                            request = request[os.write(key.fd, request) :]
                            is_done = not request
                        else:
                            is_done = not self._receive(key.fd)
                        if is_done:
                            selector.unregister(key.fd)
        except OSError:
            raise OwnStageError("has ended by itself") from None
        finally:
            self._log()
        line, _, self._answer = self._answer.partition(b"\n")
        try:
            word: dict[str, object] = json.loads(line)
        except (ValueError, RecursionError):
            raise OwnStageError("gave an answer that cannot be read") from None
        if "failed" in word:
            raise FunctionFailed(str(word["failed"]))
        return word

    def _receive(self, pipe: int) -> bool:
        """Take what has come; whether more can come."""
        chunk = os.read(pipe, _CHUNK)
        if pipe == self._prints:
            self._printed = (self._printed + chunk)[:_CHUNK]
            return bool(chunk)
        self._answer += chunk
        if not chunk:
            raise OwnStageError("has ended by itself")
        if len(self._answer) > MOST_ANSWERED:
            raise OwnStageError(f"returned more than {MOST_ANSWERED} characters")
        return True

    def _log(self) -> None:
        lines = self._printed.decode(errors="replace").splitlines()
        self._printed = b""
        for line in lines[:MOST_LINES]:
            LOG.info("a stage printed", stage=str(self._function), line=line[:LONGEST_LINE])
        if len(lines) > MOST_LINES:
            LOG.info("a stage printed more", stage=str(self._function), lines=len(lines) - MOST_LINES)


def _environment() -> dict[str, str]:
    """Return what Python and its libraries go by, and nothing that tells of the station."""
    return {name: value for name, value in os.environ.items() if name in _PASSED or name.startswith(_PASSED_STARTS)}


def note_unconfined(without: object) -> None:
    """Say once in this process from what the system does not keep stages."""
    if isinstance(without, list) and without:
        _note_once(", ".join(map(str, without)))


@cache
def _note_once(without: str) -> None:
    LOG.warning("this system cannot keep Python stages from all that they have no use for", open_to_them=without)


# Keeps a function's process: asks it in a thread of its own, and replaces it when it gives no answer.

FIRST_REST = 0.1  # seconds before a process that gave no answer is replaced, twice as long each time in a row
LONGEST_REST = 5.0

_Request = tuple[Mapping[str, object], float, "Future[object]"]


class PythonWorker:
    """Starts at once. No call waits."""

    def __init__(self, function: Function) -> None:
        self._function = function
        self._requests: queue.SimpleQueue[_Request | None] = queue.SimpleQueue()
        self._process: FunctionProcess | None = None
        self._closed = False
        self._lock = threading.Lock()
        self._failures = 0  # in a row
        self._rests_until = 0.0
        self._trouble = ""
        threading.Thread(target=self._work, daemon=True, name=f"stage {function}").start()

    def ask(self, arguments: Mapping[str, object], deadline: float) -> Future[object]:
        """Return what the function returns for these arguments; its exception is an `OwnStageError`.

        The deadline counts from when the process can be asked.
        """
        future: Future[object] = Future()
        if self._closed:
            future.set_exception(OwnStageError("has been closed"))
        else:
            self._requests.put((arguments, deadline, future))
        return future

    def close(self) -> None:
        """End the process, and the thread. What has been asked gets no answer. May be repeated."""
        with self._lock:
            self._closed = True
            if self._process is not None:
                self._process.kill()
        self._requests.put(None)

    def _work(self) -> None:
        self._prepare()
        while (request := self._requests.get()) is not None and not self._closed:
            arguments, deadline, future = request
            try:
                future.set_result(self._call(arguments, deadline))
            except OwnStageError as error:
                future.set_exception(error)
            if time.monotonic() >= self._rests_until:
                self._prepare()
        self._end()

    def _call(self, arguments: Mapping[str, object], deadline: float) -> object:
        if time.monotonic() < self._rests_until:
            raise OwnStageError(self._trouble)
        process = self._started()
        try:
            returned = process.call(arguments, deadline)
        except FunctionFailed:
            raise
        except OwnStageError as error:
            raise self._replaced(error) from None
        self._failures = 0
        return returned

    def _prepare(self) -> None:
        """Start the process before it is asked; a failure is told to the one who asks."""
        try:
            self._started()
        except OwnStageError:
            return

    def _started(self) -> FunctionProcess:
        if self._process is not None:
            return self._process
        try:
            with self._lock:
                if self._closed:
                    raise OwnStageError("has been closed")
                self._process = FunctionProcess(self._function)
            self._process.load()
        except OSError as error:
            raise self._replaced(OwnStageError(f"cannot be started: {error}")) from None
        except OwnStageError as error:
            raise self._replaced(error) from None
        return self._process

    def _replaced(self, error: OwnStageError) -> OwnStageError:
        """End the process; the next is started after a rest, so that one that always fails costs little."""
        self._end()
        self._failures += 1
        self._trouble = str(error)
        rest = FIRST_REST * 2 ** min(self._failures - 1, 10)
        self._rests_until = time.monotonic() + min(rest, LONGEST_REST)
        return error

    def _end(self) -> None:
        with self._lock:
            process, self._process = self._process, None
        if process is not None:
            process.close()


# `python`: a function of the station's own as a stage.

LOOKS = 0.002  # seconds between two looks whether an answer has come
LEAST_PATIENCE = 2.0  # seconds for an answer where time is only told: a busy machine makes no example fail


@dataclass(frozen=True)
class Argument:
    """A parameter of the function: a field of that name, and the type with which it is called."""

    path: FieldPath
    type: FieldType


@dataclass(frozen=True)
class PythonStage:
    """A function that is called with fields, and returns a dict of what it gives. What is unknown is None to it.

    Without an answer within `deadline` seconds, what it gives is unknown, as it is after an error.
    """

    place: Place
    function: Function
    arguments: tuple[Argument, ...]
    gives: Mapping[str, FieldType]
    deadline: float
    kind: ClassVar[str] = "python"
    is_timed: ClassVar[bool] = True

    @property
    def reads(self) -> frozenset[str]:
        """The fields it is called with."""
        return frozenset(argument.path.text for argument in self.arguments)

    def begin(self) -> PythonCourse:
        """Start its process. Records go on when it has answered; of those that come meanwhile only the newest."""
        return PythonCourse(self, is_patient=False)

    def begin_patiently(self) -> PythonCourse:
        """Start its process. Each record waits for its answer, where time is only told."""
        return PythonCourse(self, is_patient=True)

    def loading_trouble(self) -> str | None:
        """Load the file in a process and end it again; why that failed, or None."""
        try:
            process = FunctionProcess(self.function)
        except OSError as error:
            return f"{self.function} cannot be started: {error}"
        try:
            process.load()
        except OwnStageError as error:
            return f"{self.function} {error}"
        finally:
            process.close()
        return None

    def backwards(self, values: dict[str, object]) -> None:
        """Nobody knows what a function must read to give something."""
        if any(values.get(name) is not None for name in self.gives):
            raise NotInvertibleError(f"{self.function} cannot be read backwards: give its values in another way")

    def call_arguments(self, record: Record) -> dict[str, object]:
        """Return what the function is called with; a value that is not of its type is unknown, and that is a
        trouble.
        """
        found: dict[str, object] = {}
        for argument in self.arguments:
            value = argument.path.get(record.values)
            if value is not None and not fits(argument.type, value):
                record.troubles.append(f"{argument.path} is {shown(value)}, and {self.function} reads {argument.type}")
                value = None
            found[argument.path.text] = value
        return found

    def complete(self, record: Record, answer: Future[object]) -> Record:
        """`record` with what the function has returned; waits for it."""
        returned = None
        try:
            returned = answer.result()
        except OwnStageError as error:
            record.troubles.append(f"{self.function} {error}")
        else:
            if not isinstance(returned, dict):
                record.troubles.append(f"{self.function} returned {shown(returned)}, and no dict")
        given = returned if isinstance(returned, dict) else {}
        for name, type_ in self.gives.items():
            record.values[name] = given.get(name) if fits(type_, given.get(name)) else None
        for name, value in given.items():
            if (wanted := self.gives.get(name)) is None:
                record.troubles.append(f"{self.function} returned {shown(name)}, which is not among what it gives")
            elif value is not None and not fits(wanted, value):
                record.troubles.append(f"{self.function} gave {name} the value {shown(value)}, which is not {wanted}")
        return record


class PythonCourse(StageInstance):
    """Has the record for which an answer is awaited, and the newest of those that came since."""

    due: float | None = None

    def __init__(self, stage: PythonStage, is_patient: bool) -> None:
        self._stage = stage
        self._is_patient = is_patient
        self._keeper = PythonWorker(stage.function)
        self._asked: tuple[Record, Future[object]] | None = None
        self._waiting: Record | None = None
        self.close = weakref.finalize(self, self._keeper.close)

    def take(self, record: Record, now: float) -> Record | None:
        """A record that has been answered."""
        if self._waiting is not None:
            record.troubles = record.troubles or self._waiting.troubles
        self._waiting = record
        return self.wake(now)

    def wake(self, now: float) -> Record | None:
        """A record that has been answered."""
        if self._asked is None:
            self._ask()
        answered = None
        if self._asked is not None and (self._is_patient or self._asked[1].done()):
            answered = self._stage.complete(*self._asked)
            self._asked = None
            self._ask()
        self.due = None if self._asked is None else now + LOOKS
        return answered

    def _ask(self) -> None:
        if self._waiting is not None:
            record, self._waiting = self._waiting, None
            deadline = max(self._stage.deadline, LEAST_PATIENCE if self._is_patient else 0.0)
            self._asked = record, self._keeper.ask(self._stage.call_arguments(record), deadline)


# `python` from documents: the file and its function are read, and not yet run.

FOLDER = "stages"

_SIMPLE: Mapping[str, FieldType] = {"bool": BOOLEAN, "real": REAL, "text": TEXT}
_RANGE = re.compile(r"(-?\d+)\.\.(-?\d+)")
_NAMES = re.compile(r"\{\s*(\w+(?:\s*,\s*\w+)*)\s*\}")
_LIST = re.compile(r"(.+)\[(\d*)\]")


_FUNCTION = "the function of a `python` stage"


class PythonDocument(StageDeclaration):
    """A function of the station's own, in a file of its folder `stages`."""

    kind: ClassVar[str] = "python"
    about: ClassVar[str] = "A function of the station's own."

    file: SourceText
    """The file, as in `stages/force.py`."""
    function: SourceText
    """The function's name. It is called with the fields it reads, and returns a dict of what it gives."""
    reads: dict[
        Annotated[SourceText, NameMark(NameUse.READ, NameUse.READ, outsider=_FUNCTION)],
        SourceText,
    ]
    """The fields it is called with, and their types: `bool`, `0..9`, `{a, b}`, `real`, `text`."""
    gives: Annotated[
        dict[Annotated[SourceText, NameMark(NameUse.GIVEN, NameUse.GIVEN, outsider=_FUNCTION)], SourceText],
        Field(min_length=1),
    ]
    """What it returns, and the types."""
    deadline: Annotated[float, Field(gt=0, le=60)] = 0.05
    """Seconds within which it answers."""

    def check(self, context: Context) -> PythonStage | None:
        """A function whose file, parameters and types fit."""
        path = _file(self, context)
        is_function = path is not None and _has_function(path, self, context)
        arguments = [_argument(name, type_, context) for name, type_ in self.reads.items()]
        gives = {str(name): _type(text, context) for name, text in self.gives.items()}
        read = tuple(argument for argument in arguments if argument is not None)
        given = {name: type_ for name, type_ in gives.items() if type_ is not None}
        if path is None or not is_function or len(read) != len(arguments) or len(given) != len(gives):
            return None
        function = Function(str(self.file), str(self.function), path, path.parent)
        return PythonStage(context.place, function, read, given, self.deadline)

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        for path in sorted((spot.folder / FOLDER).rglob("*.py")):
            try:
                functions = [each for each in ast.parse(path.read_bytes()).body if isinstance(each, ast.FunctionDef)]
            except (OSError, ValueError, SyntaxError, RecursionError, MemoryError):
                continue
            file = f"{FOLDER}/{path.relative_to(spot.folder / FOLDER).as_posix()}"
            for function in functions:
                reads = {each.arg: _python_type(spot.fields.get(each.arg)) for each in function.args.args}
                if not function.name.startswith("_") and all(reads.values()):
                    name = spot.name(function.name) if spot.is_incoming else next(iter(spot.open), function.name)
                    settings = {"file": file, "function": function.name, "reads": reads, "gives": {name: "bool"}}
                    yield Candidate({cls.kind: settings}, {name: "bool"} if spot.is_incoming else {})

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        return None  # without a function that could be called there is none


def _python_type(type_: FieldType | None) -> str | None:
    return None if type_ is None or isinstance(type_, NestedType) else str(type_)


def _file(document: PythonDocument, context: Context) -> Path | None:
    folder = (context.folder / FOLDER).resolve()
    path = (context.folder / document.file).resolve()
    if not path.is_relative_to(folder):
        context.found(document.file.place, message("wrong.outside-folder", file=str(document.file), folder=FOLDER))
        return None
    if not path.is_file():
        others = [f"{FOLDER}/{other.relative_to(folder)}" for other in sorted(folder.rglob("*.py"))]
        near = suggestion(document.file, others)
        context.found(document.file.place, message("wrong.no-python-file", file=str(document.file), hint=near))
        return None
    return path


def _has_function(path: Path, document: PythonDocument, context: Context) -> bool:
    try:
        module = ast.parse(path.read_bytes())
    except SyntaxError as error:
        file, why = str(document.file), error.msg
        said = (
            message("wrong.no-python.line", file=file, why=why, line=error.lineno)
            if error.lineno
            else message("wrong.no-python", file=file, why=why)
        )
        context.found(document.file.place, said)
        return False
    except (OSError, ValueError, RecursionError, MemoryError) as error:
        context.found(document.file.place, message("wrong.no-python", file=str(document.file), why=str(error)))
        return False
    defined = {part.name: part for part in module.body if isinstance(part, ast.FunctionDef)}
    function = defined.get(document.function)
    if function is None:
        near = suggestion(document.function, defined)
        said = message("wrong.no-function", file=str(document.file), function=str(document.function), hint=near)
        context.found(document.function.place, said)
        return False
    return _takes(function, document, context)


def _takes(function: ast.FunctionDef, document: PythonDocument, context: Context) -> bool:
    """Check whether the function can be called with exactly what the stage reads."""
    arguments = function.args
    named = [argument.arg for argument in (*arguments.args, *arguments.kwonlyargs)]
    without_default = arguments.args[: len(arguments.args) - len(arguments.defaults)] + [
        argument
        for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
        if default is None
    ]
    refused = [name for name in document.reads if name not in named and arguments.kwarg is None]
    for name in refused:
        hint = suggestion(name, named) if name.isidentifier() else message("hint.rename-field")
        context.found(
            name.place,
            message("wrong.no-function-parameter", function=str(document.function), name=str(name), hint=hint),
        )
    missing = [argument.arg for argument in without_default if argument.arg not in document.reads]
    missing += [argument.arg for argument in arguments.posonlyargs]
    if missing:
        said = message("wrong.function-needs", function=str(document.function), names=", ".join(missing))
        context.found(document.function.place, said)
    return not refused and not missing


def _argument(name: SourceText, text: SourceText, context: Context) -> Argument | None:
    found, type_ = context.field(name), _type(text, context)
    if found is None or type_ is None:
        return None
    path, given = found
    if not _readable(given, type_):
        context.found(text.place, message("wrong.function-reads", name=str(name), given=str(given), wanted=str(type_)))
        return None
    return Argument(path, type_)


def _readable(given: FieldType, wanted: FieldType) -> bool:
    """Return whether values of the one type may be of the other."""
    if isinstance(given, ListType) and isinstance(wanted, ListType):
        lengths = {given.length, wanted.length} - {None}
        return len(lengths) <= 1 and _readable(given.element, wanted.element)
    if isinstance(wanted, IntegerRange):
        return isinstance(given, IntegerRange)
    if isinstance(wanted, BooleanType):
        return given == BOOLEAN
    return (is_numeric(wanted) and is_numeric(given)) or (is_textual(wanted) and is_textual(given))


def _type(text: SourceText, context: Context) -> FieldType | None:
    type_ = _read_type(text)
    if type_ is None:
        names = "{open, closed}"
        context.found(text.place, message("wrong.unknown-field-type", type=str(text), names=names))
    return type_


def _read_type(text: str) -> FieldType | None:
    if text in _SIMPLE:
        return _SIMPLE[text]
    if match := _LIST.fullmatch(text):
        element = _read_type(match[1])
        return None if element is None else ListType(element, int(match[2]) if match[2] else None)
    if match := _RANGE.fullmatch(text):
        low, high = int(match[1]), int(match[2])
        return IntegerRange(low, high) if low <= high else None
    if match := _NAMES.fullmatch(text):
        return EnumerationType(tuple(dict.fromkeys(name.strip() for name in match[1].split(","))))
    return None
