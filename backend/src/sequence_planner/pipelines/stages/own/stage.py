"""`python`: a function of the station's own as a stage."""

from __future__ import annotations

import weakref
from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from typing import ClassVar

from sequence_planner.expressions.place import Place
from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.record import FieldType, Record
from sequence_planner.pipelines.stage import NotInvertibleError
from sequence_planner.pipelines.stages.own.keeper import Keeper
from sequence_planner.pipelines.stages.own.process import Function, FunctionProcess, OwnStageError
from sequence_planner.pipelines.stages.values import fits, shown

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
        """What the function is called with; a value that is not of its type is unknown, and that is a trouble."""
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


class PythonCourse:
    """Has the record for which an answer is awaited, and the newest of those that came since."""

    def __init__(self, stage: PythonStage, is_patient: bool) -> None:
        self._stage = stage
        self._is_patient = is_patient
        self._keeper = Keeper(stage.function)
        self._asked: tuple[Record, Future[object]] | None = None
        self._waiting: Record | None = None
        self.due: float | None = None
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
