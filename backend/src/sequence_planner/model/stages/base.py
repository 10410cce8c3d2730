"""The nature of a stage: declared once, checked when the station is loaded, and run while the station does.

A stage is a class that is derived from `StageDeclaration`. Its fields are what an engineer writes; their annotations
say what the stage does with each name, from which all follows that others must know: what renaming looks at, which
fields become variables by themselves, what may stand where. `check` makes of it a `Stage`, which knows the types of
the record before it, and `begin` of that a `StageInstance`, which has what must be remembered from record to record.

A stage reads some fields of a record and gives some; all others pass through it. No stage looks at a clock: times are
given to it, in seconds on any clock that only goes forward, so that a pipeline can be run in an example as on a
station.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from types import UnionType
from typing import (
    Annotated,
    ClassVar,
    Literal,
    NamedTuple,
    Protocol,
    Union,
    get_args,
    get_origin,
    get_type_hints,
    runtime_checkable,
)

from pydantic import BaseModel

from sequence_planner.language.records.field_paths import FieldPath, NoFieldError, find_field
from sequence_planner.language.records.record import FieldType, Record, RecordType
from sequence_planner.language.types import Place
from sequence_planner.model.fields import DocumentPart
from sequence_planner.model.source import SourceText

# What a stage does with what is named in it.


class NameUse(Enum):
    """The use of a name: a field before the stage, or, where it is given, behind it."""

    READ = "read"  # it is looked at, and stays what it is
    KEPT = "kept"  # it is given again, from itself alone
    COMBINED = "combined"  # something else is made of it and others
    CONSUMED = "consumed"  # something else is made of it
    RENAMED = "renamed"  # it goes on under another name
    GIVEN = "given"


@dataclass(frozen=True)
class NameMark:
    """Marks a text of a declaration as a name in the record: its use in an incoming pipeline, and in an outgoing one.

    A field must `fit`, and findings call what does `what`. A name that is given `alike` has the values of what is read;
    of `outsider`, who knows the name from elsewhere, renaming tells people.
    """

    incoming: NameUse | None
    outgoing: NameUse | None
    fits: Callable[[FieldType], bool] | None = None
    what: str = ""
    alike: bool = False
    outsider: str | None = None

    def use(self, is_incoming: bool) -> NameUse | None:
        """Its use in a pipeline of this direction."""
        return self.incoming if is_incoming else self.outgoing


@dataclass(frozen=True)
class ValueMark:
    """Marks a text as a value of what the stage reads, or of what it gives; `but` is a word that is none."""

    of_given: bool
    but: str | None = None


@dataclass(frozen=True)
class FormulaMark:
    """Marks a text as an expression over the record; the name that is given at the same place has its value."""


# Names of the message's side and of the model's, of which each is read or given as the pipeline goes.
MessageField = Annotated[SourceText, NameMark(NameUse.CONSUMED, NameUse.GIVEN)]
ModelVariable = Annotated[SourceText, NameMark(NameUse.GIVEN, NameUse.CONSUMED)]
# Names of which a stage does the same whichever way the pipeline goes.
ReadField = Annotated[SourceText, NameMark(NameUse.READ, NameUse.READ)]
KeptField = Annotated[SourceText, NameMark(NameUse.KEPT, NameUse.KEPT)]
CombinedField = Annotated[SourceText, NameMark(NameUse.COMBINED, NameUse.COMBINED)]
GivenField = Annotated[SourceText, NameMark(NameUse.GIVEN, NameUse.GIVEN)]

Scalar = SourceText | bool | int | float
READ_VALUE, GIVEN_VALUE = ValueMark(of_given=False), ValueMark(of_given=True)
ReadValue = Annotated[SourceText, READ_VALUE]
GivenValue = Annotated[SourceText, GIVEN_VALUE]


class Within(Enum):
    """A step into a mapping or a list, whatever is in it."""

    KEYS = "keys"
    ENTRIES = "entries"


Mark = NameMark | ValueMark | FormulaMark
Steps = tuple[str | Within, ...]
EntryPath = tuple[str | int, ...]


class Marked(NamedTuple):
    """A text of a stage as written, where it stands in it (a key at the path of its entry), and what it is."""

    text: SourceText
    path: EntryPath
    mark: Mark


def _marks(annotation: object, steps: Steps) -> Iterator[tuple[Steps, Mark]]:
    """The marks within an annotation, each with the steps to what it marks."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        found = (each for each in arguments[1:] if isinstance(each, NameMark | ValueMark | FormulaMark))
        yield from ((steps, each) for each in found)
        yield from _marks(arguments[0], steps)
    elif origin in (Union, UnionType):
        for each in arguments:
            yield from _marks(each, steps)
    elif origin in (dict, Mapping):
        yield from _marks(arguments[0], (*steps, Within.KEYS))
        yield from _marks(arguments[1], (*steps, Within.ENTRIES))
    elif origin is list:
        yield from _marks(arguments[0], (*steps, Within.ENTRIES))
    elif isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield from _marks_of(annotation, steps)


def _marks_of(part: type[BaseModel], steps: Steps) -> Iterator[tuple[Steps, Mark]]:
    hints = get_type_hints(part, include_extras=True)
    for name, info in part.model_fields.items():
        yield from _marks(hints[name], (*steps, info.alias or name))


def _texts(content: object, steps: Steps, path: EntryPath) -> Iterator[tuple[SourceText, EntryPath]]:
    """The texts at these steps, in a document or in what may become one, of whatever form it is."""
    if not steps:
        if isinstance(content, SourceText):
            yield content, path
        return
    step, rest = steps[0], steps[1:]
    match step, content:
        case Within.KEYS, Mapping():
            yield from ((key, (*path, str(key))) for key in content if isinstance(key, SourceText))
        case Within.ENTRIES, Mapping():
            for key, each in content.items():
                yield from _texts(each, rest, (*path, str(key)))
        case Within.ENTRIES, list():
            for index, each in enumerate(content):
                yield from _texts(each, rest, (*path, index))
        case str(), Mapping():
            yield from _texts(content.get(step), rest, (*path, step))
        case str(), BaseModel():
            fields = type(content).model_fields
            name = next(name for name, info in fields.items() if (info.alias or name) == step)
            yield from _texts(getattr(content, name), rest, (*path, step))


# What a stage is: as written, as checked, and as it runs.


class NotInvertibleError(Exception):
    """A stage cannot be read backwards for these values; the text says why and what to do."""


@dataclass(frozen=True)
class Context:
    """The place of a stage.

    `is_incoming` holds for incoming topics and flows. `fields` are those of the record before the stage. `wanted` are
    the names for which there is a use at the end, with their types: the measured variables of the resource without its
    name (incoming), or the fields of the message (outgoing). A stage may give others, which a later one reads.
    `found` notes what is wrong at a place; it adds which pipeline and which stage.
    """

    is_incoming: bool
    fields: RecordType
    wanted: Mapping[str, FieldType]
    folder: Path
    place: Place
    found: Callable[[Place, str], None]

    def field(self, path: SourceText) -> tuple[FieldPath, FieldType] | None:
        """A field that the stage reads, by its path; None, and a finding, when there is none."""
        try:
            return find_field(self.fields, path)
        except NoFieldError as error:
            self.found(path.place, str(error))
            return None


class StageDeclaration(DocumentPart, ABC):
    """One kind of stage: what is written of it, and what is made of that.

    `kind` is the key by which documents name it, and `about` says under that key what it is for. It is `bare` when what
    is written is what its only field holds. `direction` is that of the topics it is for, if it is not for all, and
    `instead` the kind for the others.
    """

    kind: ClassVar[str]
    about: ClassVar[str]
    is_bare: ClassVar[bool] = False
    direction: ClassVar[Literal["incoming", "outgoing"] | None] = None
    instead: ClassVar[str] = ""

    @abstractmethod
    def check(self, context: Context) -> Stage | None:
        """The stage where it stands; None after all that is wrong with it has been noted in `context`."""

    def is_for(self, context: Context) -> bool:
        """Check whether the stage is of the right direction; a finding when it is not."""
        is_right = self.direction in (None, "incoming" if context.is_incoming else "outgoing")
        if not is_right:
            names = [each for each in self.marked(self) if isinstance(each.mark, NameMark)]
            names.sort(key=lambda each: each.mark != MESSAGE_FIELD)
            use = f"; use `{self.instead}` here" if self.instead else ""
            context.found(names[0].text.place, f"`{self.kind}` is for {self.direction} topics{use}")
        return is_right

    @classmethod
    @cache
    def marks(cls) -> tuple[tuple[Steps, NameMark | ValueMark | FormulaMark], ...]:
        """The marks of all that is written, each with the steps to it."""
        return tuple((steps[cls.is_bare :], mark) for steps, mark in _marks_of(cls, ()))

    @classmethod
    def marked(cls, content: object) -> list[Marked]:
        """The texts that are marked in a stage of this kind: one that was read, or what is written, sound or not."""
        if cls.is_bare and isinstance(content, cls):
            content = getattr(content, next(iter(cls.model_fields)))
        return [Marked(text, path, mark) for steps, mark in cls.marks() for text, path in _texts(content, steps, ())]

    @classmethod
    def named(cls, content: object, is_incoming: bool, *uses: NameUse) -> list[SourceText]:
        """The names of which a stage makes one of these uses."""
        found = cls.marked(content)
        return [text for text, _, mark in found if isinstance(mark, NameMark) and mark.use(is_incoming) in uses]


MESSAGE_FIELD = get_args(MessageField)[1]


class StageInstance(ABC):
    """One stage while it runs."""

    __slots__ = ()

    @property
    def due(self) -> float | None:
        """The moment when `wake` is to be called if nothing comes before; None: not at all."""
        return None

    @abstractmethod
    def take(self, record: Record, now: float) -> Record | None:
        """Return what goes on because of a record, which may be changed in place; None when it is held back or
        dropped.
        """

    def wake(self, now: float) -> Record | None:
        """Return what goes on because time has passed."""
        return None


class Stage(Protocol):
    """One stage as checked: what it reads and gives, of which types. It is immutable, and shared."""

    @property
    def kind(self) -> str:
        """The key by which documents name it, such as `discretise`."""

    @property
    def is_timed(self) -> bool:
        """True if it looks at the time, or asks something that may answer otherwise: the same record again is news."""

    @property
    def place(self) -> Place:
        """The place where it was written."""

    @property
    def reads(self) -> frozenset[str]:
        """The fields it needs; a nested one by its path, such as `pose.position.x`."""

    @property
    def gives(self) -> Mapping[str, FieldType]:
        """The fields that a record has after it, in addition to those it had or with another type."""

    def begin(self) -> StageInstance:
        """Start it afresh, with nothing remembered."""

    def backwards(self, values: dict[str, object]) -> None:
        """Add to `values`, which has what the stage gives, fields it could have read: how an emulated device speaks.

        Raises `NotInvertibleError` when there are none.
        """


@dataclass(frozen=True)
class Override:
    """Values that a person has set in place of those that came; `until` is on the clock of the pipeline."""

    fields: Mapping[str, object]
    actor: str
    until: float


@runtime_checkable
class Overriding(Protocol):
    """The course of a stage whose fields a person can set."""

    @property
    def name(self) -> str:
        """What it is called where it is set."""

    @property
    def override(self) -> Override | None:
        """The override that is set now."""

    def set_override(self, fields: Mapping[str, object], now: float, actor: str) -> Record | None:
        """Set these fields; returns the last record with them. Raises ValueError for what the bounds do not allow."""

    def clear_override(self, now: float) -> Record | None:
        """Take back what is set; returns the last record without it."""

    def restore(self, override: Override) -> None:
        """Go on with what was set before the pipeline began afresh."""


@runtime_checkable
class Closable(Protocol):
    """The course of a stage that holds something of the system's, such as a process."""

    def close(self) -> None:
        """Give it back. May be repeated."""


@runtime_checkable
class Loadable(Protocol):
    """A stage that needs something loaded, which can fail on this machine."""

    def loading_trouble(self) -> str | None:
        """Load it once, beside; what is wrong with it, or None."""


@runtime_checkable
class Patient(Protocol):
    """A stage that works beside, and can be waited for where time is only told, as in an example."""

    def begin_patiently(self) -> StageInstance:
        """Start it afresh so that each record is answered at once."""
