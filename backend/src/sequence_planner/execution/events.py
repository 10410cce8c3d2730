"""Input events of an `Execution`, deterministic for replay, and the notifications to its listeners."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.automaton.automaton import State
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import Immutable
from sequence_planner.execution.jobs import JobAct, Waits
from sequence_planner.execution.state import OperatorPlan
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.language.types import Value
from sequence_planner.planning.diagnosis import Diagnosis
from sequence_planner.planning.problem import Contract, PlanAnswer

# All that happens to an `Executor`: from the same beginning, the same happenings lead to the same state, bit for bit.
#
# An execution tells whoever listens (`Executor.heard`) what happens to it, as soon as it has; the journal writes that
# down, and `history` takes an execution through it again. Nothing here refers to a clock: whoever calls says when it
# is.


class Ticked(Immutable):
    """A tick with these measured values. `obstacles` keep all from starting, `silent` resources are not heard."""

    measured: Mapping[str, Value | None]
    obstacles: tuple[str, ...]
    silent: frozenset[str]
    now: Timestamp


class Asked(Immutable):
    """The planner has been asked for a plan: one that is needed, or with `MINIMAL` for a better one."""

    contract: Contract


class Answered(Immutable):
    """The planner has answered what it was asked last. The proof is not kept: nothing follows from it."""

    answer: PlanAnswer


class Unanswered(Immutable):
    """The planner could not answer what it was asked last."""

    why: str
    again: bool


class Explained(Immutable):
    """It was found why there is no plan, as far as it was."""

    diagnosis: Diagnosis


class ProductionStarted(Immutable):
    """Outputs are published from now on."""


class ModeChanged(Immutable):
    """The mode is another one; `by` names who wanted it. Holding takes the cancel actions of what runs."""

    mode: Mode
    by: str
    now: Timestamp


class CalledOff(Immutable):
    """The calling off of what ran, by its cancel actions, and of the operator plan with it; the mode is as before."""

    by: str
    now: Timestamp


class CycleStopChanged(Immutable):
    """The station is to pause when the product that is in work is done, or is not to any more."""

    on: bool
    by: str
    why: str
    now: Timestamp


class SteppingChanged(Immutable):
    """From now on every start waits for a step, or none does."""

    on: bool


class StepTaken(Immutable):
    """One start may be taken."""


class ServiceChanged(Immutable):
    """Something is in service from now on, or out of it."""

    of: ServiceKind
    name: str
    in_service: bool
    by: str
    why: str
    now: Timestamp


class Corrected(Immutable):
    """Estimated variables, and outputs before production is started, have these values from now on.

    Where that takes back what was corrected nobody says anything of those in `taken_back` any more.
    """

    values: Mapping[str, Value]
    by: str
    why: str
    now: Timestamp
    taken_back: frozenset[str] = frozenset()


class Confirmed(Immutable):
    """A person has seen that these estimated variables are as believed."""

    names: frozenset[str]
    by: str
    now: Timestamp


class Forced(Immutable):
    """A variable has this value until then, whatever its device or an ability says."""

    name: str
    value: Value
    until: Timestamp
    by: str
    why: str


class ForceReleased(Immutable):
    """A forced variable is as it comes again."""

    name: str


class ByOrderChanged(Immutable):
    """From now on the operations of work masters are active for jobs only, or whenever they can be."""

    on: bool
    by: str
    why: str
    now: Timestamp


class JobTaken(Immutable):
    """The station has taken a job."""

    job: str
    title: str
    work_master: str
    by: str
    now: Timestamp


class JobsSequenced(Immutable):
    """Operations of jobs wait for these of others, and no more for what was said before."""

    waits: Waits
    by: str
    now: Timestamp


class JobCommanded(Immutable):
    """A job under way is paused, resumed, being stopped, or aborted."""

    job: str
    act: JobAct
    by: str
    why: str
    now: Timestamp


class JobForgotten(Immutable):
    """A job that has ended is not kept any longer."""

    job: str
    by: str
    now: Timestamp


class OperatorPlanStarted(Immutable):
    """A person has taken a plan to be carried out."""

    operator_plan: OperatorPlan
    now: Timestamp


class OperatorPlanStopped(Immutable):
    """It is carried out no further."""

    by: str
    now: Timestamp


Event = (
    Ticked
    | Asked
    | Answered
    | Unanswered
    | Explained
    | ProductionStarted
    | ModeChanged
    | CalledOff
    | CycleStopChanged
    | SteppingChanged
    | StepTaken
    | ServiceChanged
    | Corrected
    | Confirmed
    | Forced
    | ForceReleased
    | OperatorPlanStarted
    | OperatorPlanStopped
    | ByOrderChanged
    | JobTaken
    | JobsSequenced
    | JobCommanded
    | JobForgotten
)


# What an execution tells those who listen to it.


@dataclass(frozen=True)
class TickOutcome:
    """The things that a tick did. `outputs` are the output variables to be published now.

    `finished` are the abilities that took their finish actions, which one may do again and again while its finish guard
    holds; `ended` are those of them that had been running. `called_off` took their cancel actions because they were
    overdue, and of these `given_up` are out of service now.
    """

    finished: tuple[str, ...]
    ended: tuple[str, ...]
    started: tuple[str, ...]
    activated: frozenset[str]
    completed: frozenset[str]
    conflicts: tuple[tuple[str, str, str], ...]
    outputs: frozenset[str]
    changed: bool
    called_off: tuple[str, ...] = ()
    given_up: tuple[str, ...] = ()


@dataclass(frozen=True)
class Heard:
    """Something has happened and led from the state `before` to the one `after`; a tick has an outcome.

    `called_off` are the abilities that were running and took their cancel actions because a person has stopped them.
    """

    happening: Event
    before: State
    after: State
    outcome: TickOutcome | None = None
    called_off: tuple[str, ...] = ()
