"""The nature of a stage: declared once, checked when the station is loaded, and run while the station does.

A stage is a class that is derived from `StageDeclaration`. Its fields are what an engineer writes, with `marks` of what
the stage does with each name. `check` makes of it a `Stage`, which knows the types of
the record before it, and `begin` of that a `StageInstance`, which has what must be remembered from record to record.

A stage reads some fields of a record and gives some; all others pass through it. No stage looks at a clock: times are
given to it, in seconds on any clock that only goes forward, so that a pipeline can be run in an example as on a
station.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import islice
from pathlib import Path
from typing import (
    ClassVar,
    Literal,
    Protocol,
    TypeVar,
    runtime_checkable,
)

from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.field_paths import FieldPath, NoFieldError, find_field
from sequence_planner.language.records.record import FieldType, Record, RecordType
from sequence_planner.language.shorthand.vocabulary import NO_VOCABULARY, Vocabulary
from sequence_planner.language.types import Place
from sequence_planner.model.fields import DocumentPart
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.marks import (
    ExampleValue,
    Mark,
    Marked,
    NameMark,
    NameUse,
    Steps,
    ValueMark,
    Within,
    marks_of,
    texts_at,
)
from sequence_planner.model.stages.suggestions import MOST_SUGGESTED, Candidate, Spot
from sequence_planner.texts.message import message

T = TypeVar("T")

# What a stage is: as written, as checked, and as it runs.


class NotInvertibleError(Exception):
    """A stage cannot be read backwards for these values; the text says why and what to do."""


@dataclass(frozen=True)
class Context:
    """The place of a stage.

    `is_incoming` holds for incoming topics and flows. `fields` are those of the record before the stage. `wanted` are
    the names for which there is a use at the end, with their types: the measured variables of the resource without its
    name (incoming), or the fields of the message (outgoing). A stage may give others, which a later one reads.
    `vocabulary` has the enumerations, named sets, maps and relations of the station; those of the `resource` are known
    there by their own names.
    `found` notes what is wrong at a place; it adds which pipeline and which stage.
    """

    is_incoming: bool
    fields: RecordType
    wanted: Mapping[str, FieldType]
    folder: Path
    place: Place
    found: Callable[[Place, str], None]
    vocabulary: Vocabulary = NO_VOCABULARY
    resource: str = ""

    def named(self, name: SourceText, table: Mapping[str, T]) -> T | None:
        """A map or a relation by its name in the resource or in the station; None, and a finding, without one."""
        own = f"{self.resource}."
        found = table.get(own + str(name), table.get(str(name)))
        if found is None:
            near = suggestion(name, [*table, *(each.removeprefix(own) for each in table)])
            id_ = "wrong.no-relation" if table is self.vocabulary.relations else "wrong.no-map"
            self.found(name.place, message(id_, name=str(name), hint=near))
        return found

    def field(self, path: SourceText) -> tuple[FieldPath, FieldType] | None:
        """A field that the stage reads, by its path; None, and a finding, when there is none."""
        try:
            return find_field(self.fields, path)
        except NoFieldError as error:
            self.found(path.place, error.why)
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
            of_message = self.named(self, True, NameUse.CONSUMED)
            first = (of_message or self.named(self, True, *NameUse))[0]
            hint = message("hint.use", what=self.instead) if self.instead else ""
            context.found(first.place, message(f"wrong.only-{self.direction}", stage=self.kind, hint=hint))
        return is_right

    @classmethod
    def suggest(cls, spot: Spot) -> list[Candidate]:
        """Stages of this kind that the record suggests, the likeliest first; without any, one about some field, so that
        its check says why not. None where nothing is left that it could give.
        """
        if found := list(islice(cls._suggested(spot), MOST_SUGGESTED)):
            return found
        content = cls._about(next((path for path, _ in spot.leaves), "field"), spot)
        return [] if content is None else [Candidate({cls.kind: content})]

    @classmethod
    def _suggested(cls, spot: Spot) -> Iterator[Candidate]:
        """By default one about each field that fits."""
        names = [mark for _, mark in cls.marks() if isinstance(mark, NameMark)]
        fits = next((mark.fits for mark in names if mark.fits is not None), None)
        paths = [path for path, _ in spot.subjects(fits)] if names else [""]
        return (Candidate({cls.kind: cls._about(path, spot)}) for path in paths)

    @classmethod
    def _about(cls, name: str, spot: Spot) -> object:
        """What could be written about a field: its name, free ones for what is given, and examples of all else."""
        content: dict[str, object] = {}
        marks = dict(marks_of(cls))
        for own, info in cls.model_fields.items():
            key = info.alias or own
            mark = marks.get((key,)) or marks.get((key, Within.ENTRIES))
            if (example := next((each for each in info.metadata if isinstance(each, ExampleValue)), None)) is not None:
                content[key] = example.value
            elif mark is not None and not isinstance(mark, ValueMark):
                given = isinstance(mark, NameMark) and mark.use(spot.is_incoming) is NameUse.GIVEN
                text = spot.name(f"{name}_{cls.kind}") if given else name
                content[key] = text if (key,) in marks else [text]
        return next(iter(content.values())) if cls.is_bare else content

    @classmethod
    @cache
    def marks(cls) -> tuple[tuple[Steps, Mark], ...]:
        """The marks of all that is written, each with the steps to it."""
        return tuple((steps[cls.is_bare :], mark) for steps, mark in marks_of(cls))

    @classmethod
    def marked(cls, content: object) -> list[Marked]:
        """The texts that are marked in a stage of this kind: one that was read, or what is written, sound or not."""
        if cls.is_bare and isinstance(content, cls):
            content = getattr(content, next(iter(cls.model_fields)))
        return [Marked(text, path, mark) for steps, mark in cls.marks() for text, path in texts_at(content, steps)]

    @classmethod
    def named(cls, content: object, is_incoming: bool, *uses: NameUse) -> list[SourceText]:
        """The names of which a stage makes one of these uses."""
        found = cls.marked(content)
        return [text for text, _, mark in found if isinstance(mark, NameMark) and mark.use(is_incoming) in uses]


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
