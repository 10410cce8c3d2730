"""What each document of a station may hold. Texts keep their place (`SourceText`), so that errors can name it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from sequence_planner.model.source import SourceText


class DocumentPart(BaseModel):
    """Base of all parts: nothing beside what is declared."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


# A predicate is a text of the guard language; YAML itself reads a bare `true` as a truth value.
Predicate = SourceText | bool
Seconds = Annotated[float, Field(ge=0, le=86_400)]
Parameters = dict[SourceText, SourceText]


def _interval(value: object) -> object:
    if isinstance(value, list) and len(value) == 2:
        return value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return (value, value)
    raise ValueError("expected seconds, or the fewest and the most as in `[0.5, 1.5]`")


def _ascending(interval: tuple[float, float]) -> tuple[float, float]:
    if interval[0] > interval[1]:
        raise ValueError(f"from {interval[0]:g} to {interval[1]:g} seconds is no duration: write the fewest first")
    return interval


Duration = Annotated[tuple[Seconds, Seconds], BeforeValidator(_interval), AfterValidator(_ascending)]


class VariableDocument(DocumentPart):
    """A variable: `type` is `bool`, an enumeration, or a range such as `0..3`.

    A measured or output variable without one has the type of the message field that it belongs to.
    """

    type: SourceText | None = None
    initial: bool | int | SourceText | None = None
    each: Parameters = Field(default_factory=dict, alias="for")


class StartDocument(DocumentPart):
    """The start of an ability: a further guard beside `enabled`, and the actions."""

    when: Predicate = True
    do: list[SourceText] = Field(default_factory=list)


class FinishDocument(DocumentPart):
    """The finish of an ability: its guard and actions."""

    when: Predicate
    do: list[SourceText] = Field(default_factory=list)


class EffectDocument(DocumentPart):
    """How measured variables are expected to react; `takes` is its shortest and longest time in seconds."""

    kind: Literal["starting", "executing", "finishing"]
    when: Predicate
    do: list[SourceText] = Field(min_length=1)
    takes: Duration = (0.5, 0.5)
    fault: bool = False


class HumanDocument(DocumentPart):
    """A person carries the ability out: what the watch says, and the measured variable that is the acknowledgement."""

    task: SourceText
    acknowledgement: SourceText


class CancelDocument(DocumentPart):
    """What is done when a running ability is called off."""

    do: list[SourceText] = Field(min_length=1)


class TimeoutsDocument(DocumentPart):
    """Seconds after the start until an alarm is raised: by when it must have reacted, and have finished."""

    react: Seconds | None = None
    finish: Seconds | None = None


class AbilityDocument(DocumentPart):
    """An ability of a resource. `duration` estimates in seconds how long a run takes."""

    title: SourceText | None = None
    parameters: Parameters = Field(default_factory=dict)
    restart: bool = False
    human: HumanDocument | None = None
    timeouts: TimeoutsDocument = TimeoutsDocument()
    duration: Duration | None = None
    enabled: Predicate = True
    start: StartDocument = StartDocument()
    executing: Predicate = False
    finished: Predicate = False
    finish: FinishDocument | None = None
    cancel: CancelDocument | None = None
    effects: dict[SourceText, EffectDocument] = Field(default_factory=dict)


Coordinates = dict[SourceText, Annotated[list[float], Field(min_length=1)]]


class DiscretiseDocument(DocumentPart):
    """Numbers of a message become the value whose coordinates are within `tolerance` of each, else `otherwise`."""

    field: SourceText
    variable: SourceText
    values: Coordinates
    tolerance: Annotated[float, Field(gt=0)]
    otherwise: SourceText


class RememberDocument(DocumentPart):
    """A variable keeps the last value of another, but for the values in `except`."""

    variable: SourceText
    of: SourceText
    ignored: list[SourceText] = Field(default_factory=list, alias="except")


class UndiscretiseDocument(DocumentPart):
    """A value becomes its coordinates."""

    variable: SourceText
    field: SourceText
    values: Coordinates


class StageDocument(DocumentPart):
    """One stage of a pipeline: exactly one kind. Fields and variables of one name are mapped without being asked."""

    discretise: DiscretiseDocument | None = None
    remember: RememberDocument | None = None
    undiscretise: UndiscretiseDocument | None = None
    constant: Mapping[SourceText, Any] | None = None
    rename: dict[SourceText, SourceText] | None = None  # field: variable

    @model_validator(mode="after")
    def _one_kind(self) -> StageDocument:
        kinds = [name for name in type(self).model_fields if getattr(self, name) is not None]
        if len(kinds) != 1:
            raise ValueError(f"a stage is exactly one of {', '.join(type(self).model_fields)}")
        return self


class TopicDocument(DocumentPart):
    """A ROS 2 topic. An incoming one is stale after `deadline` seconds; an outgoing one is repeated `every` seconds."""

    type: SourceText
    direction: Literal["in", "out"]
    deadline: Annotated[float, Field(gt=0)] | None = None
    every: Annotated[float, Field(gt=0)] | None = None
    quality: Literal["reliable", "sensor_data", "latched"] = "reliable"
    ignore: list[SourceText] = Field(default_factory=list)  # fields that are no variables
    pipeline: list[StageDocument] = Field(default_factory=list)

    @model_validator(mode="after")
    def _timing_fits_direction(self) -> TopicDocument:
        if self.direction == "in" and self.every is not None:
            raise ValueError("`every` repeats an outgoing message; an incoming topic has a `deadline`")
        if self.direction == "out" and self.deadline is not None:
            raise ValueError("`deadline` is for incoming topics; an outgoing one is repeated with `every`")
        return self


class ResourceDocument(DocumentPart):
    """A resource: its topics, its variables by who writes them, and what it can do."""

    title: SourceText | None = None
    topics: dict[SourceText, TopicDocument] = Field(default_factory=dict)
    measured: dict[SourceText, VariableDocument] = Field(default_factory=dict)
    output: dict[SourceText, VariableDocument] = Field(default_factory=dict)
    estimated: dict[SourceText, VariableDocument] = Field(default_factory=dict)
    abilities: dict[SourceText, AbilityDocument] = Field(default_factory=dict)


class StationDocument(DocumentPart):
    """The station as a whole: what is common to its resources. `rest` describes the states of rest."""

    name: SourceText
    title: SourceText | None = None
    description: SourceText | None = None
    enumerations: dict[SourceText, Annotated[list[SourceText], Field(min_length=1)]] = Field(default_factory=dict)
    estimated: dict[SourceText, VariableDocument] = Field(default_factory=dict)
    rest: Predicate = True


class OperationDocument(DocumentPart):
    """A production operation: active from its precondition to its goal. The highest `priority` is kept longest.

    `local` is a formula of linear temporal logic over the run from activation to goal.
    """

    title: SourceText | None = None
    parameters: Parameters = Field(default_factory=dict)
    precondition: Predicate
    goal: Predicate
    local: Predicate | None = None
    priority: int = 0


class SpecificationDocument(DocumentPart):
    """What must never be. One of: states that are `forbidden`; `never` one thing `while` another; abilities that are
    `exclusive`; a `zone` that resources share; an `order` of conditions.
    """

    title: SourceText | None = None
    parameters: Parameters = Field(default_factory=dict)
    forbidden: Predicate | None = None
    never: Predicate | None = None
    during: Predicate | None = Field(default=None, alias="while")
    exclusive: list[SourceText] | None = Field(default=None, min_length=2)
    zone: dict[SourceText, Predicate] | None = Field(default=None, min_length=2)
    order: list[Predicate] | None = Field(default=None, min_length=2)

    @model_validator(mode="after")
    def _one_kind(self) -> SpecificationDocument:
        if (self.never is None) != (self.during is None):
            raise ValueError("`never` and `while` belong together: what must not be, and while what")
        kinds = (self.forbidden, self.never, self.exclusive, self.zone, self.order)
        if sum(kind is not None for kind in kinds) != 1:
            raise ValueError("a specification is exactly one of forbidden, never and while, exclusive, zone, order")
        return self


class WorkStepDocument(DocumentPart):
    """An operation of a job: which others must be completed before it."""

    after: list[SourceText] = Field(default_factory=list)


class WorkMasterDocument(DocumentPart):
    """What a job consists of: its operations with their order, and the estimated values a new product `brings`."""

    title: SourceText | None = None
    brings: list[SourceText] = Field(default_factory=list)
    operations: dict[SourceText, WorkStepDocument | None] = Field(min_length=1)
