"""What is shown of the draft as it is tried with emulated devices."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, JsonValue

from sequence_planner.controller.views.part import Value, View
from sequence_planner.editor.schemas.draft import StepChangeView
from sequence_planner.model.paths import EditError
from sequence_planner.texts.message import Message


class NoSimulationError(EditError):
    """There is no such simulation any more."""


class SimulationStop(StrEnum):
    """Why time was let pass no further than was asked for."""

    UNTIL = "until"  # the condition has come to hold
    LATE = "late"  # the machine had no time for more; go on from there
    RESTLESS = "restless"  # abilities finish again and again, without anything new from a device


class Advance(BaseModel):
    """How a simulation is to go on: from a moment `at` which it has been, where that is given. What is done there is
    that devices get `faults`, as lines such as `robot silent for 5 s` or `clear`, that variables are brought to values
    by hand, and that tasks are done.

    Then `seconds` pass, until the condition `until` comes to hold or, `once`, something happens. People do their tasks
    by themselves, or where they `people_wait` not.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    at: float | None = Field(default=None, ge=0)
    faults: list[Annotated[str, Field(max_length=1000)]] = Field(default=[], max_length=100)
    sets: dict[str, Value] = Field(default={}, max_length=1000)
    done: list[str] = Field(default=[], max_length=1000)
    seconds: float = Field(default=0.0, ge=0, le=600)
    until: str | None = Field(default=None, min_length=1, max_length=2000)
    once: bool = False
    people_wait: bool = False


class SimulationMomentView(View):
    """A moment in which something happened, so many `seconds` after the beginning: what somebody `did`, what has
    changed, and what runs and is active then. Outside its safe states the station is not `safe`.
    """

    seconds: float
    did: list[Message]
    changes: list[StepChangeView]
    started: list[str]
    ended: list[str]
    completed: list[str]
    running: list[str]
    active: list[str]
    safe: bool


class SimulatedTaskView(View):
    """A task that a person has, since so many seconds after the beginning."""

    task: str
    ability: str
    title: str
    text: str
    resource: str
    since: float


class SimulatedFaultView(View):
    """A fault that a device has: as a line, and in words."""

    line: str
    target: str
    said: Message


class SimulatedStartView(View):
    """A start that is planned, with when it is expected to begin and to end."""

    ability: str
    title: str
    resource: str
    start: float
    end: float


class DisturbableView(View):
    """What a measured variable can be brought to by hand, or be wrong about."""

    resource: str
    domain: list[Value]


class SimulatedModelView(View):
    """The model that is tried: the values `before` the moment at which it began, whose each ability is, what things are
    called, which resources have devices that can fail, and what can be disturbed.
    """

    before: dict[str, Value | None]
    running: list[str]
    active: list[str]
    safe: bool
    abilities: dict[str, str]
    titles: dict[str, str]
    operations: dict[str, str]
    resources: dict[str, str]
    failing: list[str]
    disturbable: dict[str, DisturbableView]


class ScenarioPlaceView(View):
    """Where something about scenarios is written, and what is said of it."""

    file: str
    line: int
    column: int
    said: Message


class ScenarioRunView(View):
    """A scenario that was carried out in so many `seconds` of simulated time, with what failed, if anything did."""

    name: str
    seconds: float
    failure: ScenarioPlaceView | None


class ScenarioView(View):
    """A scenario of the draft: what it is called, and where it is written."""

    name: str
    title: str
    file: str
    line: int


class ScenariosView(View):
    """The scenarios of the draft after its change `number`, what is `wrong` with those that cannot be carried out, how
    those ran that were, and the abilities and operations that they did not exercise. With an `obstacle` none can be
    carried out.
    """

    number: int
    obstacle: Message | None
    scenarios: list[ScenarioView]
    wrong: list[ScenarioPlaceView]
    runs: list[ScenarioRunView]
    not_exercised: dict[str, list[str]]


class ScenarioExpectation(BaseModel):
    """What is to be expected of a simulation that becomes a scenario: up to which moment `at` it goes, which condition
    `holds` there, and whether what has started since somebody did something last is to start again.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    at: float | None = Field(default=None, ge=0)
    title: str = Field(default="", max_length=200)
    holds: str | None = Field(default=None, min_length=1, max_length=2000)
    starts: bool = False


class WrittenScenarioView(View):
    """A scenario as it stands in a file of `tests`."""

    document: dict[str, JsonValue]


class SimulationView(View):
    """A station that is tried with the draft after its change `number`, so many `seconds` after the beginning.

    All `moments` after `since` are told: those that were told before are no more. `model` is told where it is new, at
    the beginning and where the draft is another one. Of what is planned all that is ahead is told. `unplanned` says
    why there is no plan. `scenario` is the one that it began with, as it ran. With an `obstacle` time stands still;
    without an `id` nothing has begun.
    """

    id: str | None
    number: int
    obstacle: Message | None
    seconds: float
    since: float
    model: SimulatedModelView | None
    moments: list[SimulationMomentView]
    tasks: list[SimulatedTaskView]
    faults: list[SimulatedFaultView]
    plan: list[SimulatedStartView]
    unplanned: Message | None
    violated: list[str]
    stopped: SimulationStop | None
    scenario: ScenarioRunView | None = None
