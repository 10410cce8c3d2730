"""Execution state beside the variables: mode, forces, operator plan, service, and goals of operations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType
from typing import Any, Final

from sequence_planner.automaton.automaton import Ability, Automaton, State, target
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.execution.jobs import Jobs
from sequence_planner.execution.vocabulary import Mode, Production, ServiceKind
from sequence_planner.language.syntax import TRUE, Expression
from sequence_planner.language.types import Value
from sequence_planner.planning.goals.pursuit import moved, settled
from sequence_planner.planning.problem import Circumstances, Goal, Plan, PlanTick, goal_of

# An operator plan: a plan that a person has seen and taken, and that is carried out as it is and never made anew.
#
# A way back, the reset of an operation and a goal by hand are operator plans. They have their abilities from one plan;
# what they are for is a goal of its own beside the operations, which wait meanwhile. So is a trial: one start of one
# ability.


class OperatorPlanKind(StrEnum):
    """The purpose of an operator plan."""

    WAY_BACK = "way-back"  # into the safe states, or to where operations can go on
    RESET = "reset"  # to the precondition of an operation
    GOAL = "goal"  # to what an engineer has asked for
    TRIAL = "trial"  # one run of an ability alone, to see what it does


NAME = "errand"  # of its goal in records, beside those of operations


class OperatorPlan(Immutable):
    """`goal` is what its `plan` reaches. With `unsupervised` starts outside the safe states go by written guards alone,
    as a person has confirmed; from inside none leads out all the same. `operation` is the one that is reset. With
    `restart` its plan may have restart abilities, and it is carried out in restart mode only. One `into_safe` begins
    outside the safe states, and is not done before the station is inside.

    With an `ability` it is a trial of that: it starts at once or not at all, and is done when that run has ended. Then
    `goal` only says by what an end is known.
    """

    kind: OperatorPlanKind
    title: str
    plan: Plan
    goal: Expression = TRUE
    restart: bool = False
    unsupervised: bool = False
    operation: str | None = None
    by: str = ""
    why: str = ""
    taken: Timestamp = Timestamp(0.0, 0.0)
    ability: str | None = None
    into_safe: bool = False

    @classmethod
    def trial(cls, ability: Ability, title: str, by: str, why: str, taken: Timestamp) -> OperatorPlan:
        """A run of one ability alone."""
        return cls(
            kind=OperatorPlanKind.TRIAL,
            title=title,
            plan=Plan((PlanTick((), (ability.name,)), PlanTick((), ())), minimal_ticks=False, minimal_starts=True),
            goal=TRUE if ability.finish_guard is None else ability.finish_guard,
            by=by,
            why=why,
            taken=taken,
            ability=ability.name,
        )

    @property
    def pursued(self) -> Goal:
        """Its goal, as plans are made for."""
        return Goal(NAME, self.goal)


# How a station is to execute, beside its state: what people have asked of it, and what the station has given up.
#
# A value: each change makes a new one, so that a tick that fails leaves no trace, and a snapshot is one object.


class Force(Immutable):
    """A forced variable; `real` is what it would be."""

    value: Value
    until: Timestamp
    by: str
    why: str
    real: Value | None


class OutOfService(Immutable):
    """A thing that is out of service; `by` is None where the station has given an ability up itself."""

    of: ServiceKind
    name: str
    since: Timestamp
    by: str | None
    why: str


class LastOperatorPlan(Immutable):
    """The end of the last operator plan, or of the trial of an `ability`; `by` is who ended it, None: the station."""

    title: str
    done: bool
    why: str
    ended: Timestamp
    by: str | None = None
    ability: str | None = None


class CycleStop(Immutable):
    """A wish that the station pauses when the product that is in work is done. From when that is `reached` nothing
    starts, and it lasts as long as the pause.
    """

    by: str
    why: str
    asked: Timestamp
    reached: bool = False


Service = Mapping[tuple[ServiceKind, str], OutOfService]

NOTHING: Final[Mapping[Any, Any]] = MappingProxyType({})


class InitialState(Immutable):
    """The things that are known as an execution begins: estimates and outputs that came back, as `values`.

    Nobody has seen since `unconfirmed_since` whether the estimates are still true; None where nothing came back. `done`
    are the operations that do not repeat and have been completed. It goes on in the same mode, with the same jobs, and
    steps as before: who had held the station finds it held. `revision` is higher than any that was shown before, so
    that nobody decides on a state of another life. `answers` are those of `ExecutionState`.
    """

    values: Mapping[str, Value]
    unconfirmed_since: float | None
    service: tuple[OutOfService, ...]
    done: frozenset[str]
    now: Timestamp
    mode: Mode = Mode.AUTOMATIC
    stepping: bool = False
    revision: int = 0
    jobs: Jobs = Jobs()
    answers: Mapping[str, Value] = NOTHING

    def as_the_model_says(self) -> InitialState:
        """The same with all variables as the model has them at first, which nobody need confirm."""
        return replace(self, values=NOTHING, unconfirmed_since=None, done=frozenset(), answers=NOTHING)


class ExecutionState(Immutable):
    """`steps` may be taken while it is `stepping`. `returned` are outputs that came back and nobody has decided on.

    `tried` counts for each ability how often it was called off because it was overdue, since it last did finish.
    `answers` are the estimates that somebody has confirmed or corrected, as they said, until operations go on with
    them.
    """

    mode: Mode = Mode.AUTOMATIC
    production: Production = Production.WAITING
    stepping: bool = False
    steps: int = 0
    service: Service = NOTHING
    forces: Mapping[str, Force] = NOTHING
    operator_plan: OperatorPlan | None = None
    last_operator_plan: LastOperatorPlan | None = None
    returned: frozenset[str] = frozenset()
    done: frozenset[str] = frozenset()
    tried: Mapping[str, int] = NOTHING
    silent: frozenset[str] = frozenset()  # resources that are not heard
    jobs: Jobs = Jobs()
    answers: Mapping[str, Value] = NOTHING
    cycle_stop: CycleStop | None = None

    @property
    def executes_operations(self) -> bool:
        """True if operations are planned for and executed, or would be if it were not paused."""
        return self.operator_plan is None and self.mode is not Mode.RESTART

    @property
    def may_start(self) -> bool:
        """True if it allows any start."""
        if self.production is not Production.STARTED or (self.stepping and not self.steps):
            return False
        if self.operator_plan is None:
            return self.mode is Mode.AUTOMATIC and not (self.cycle_stop and self.cycle_stop.reached)
        return self.mode is Mode.RESTART or (self.mode is Mode.PAUSED and not self.operator_plan.restart)

    def idle_operations(
        self, automaton: Automaton, active: frozenset[str] = frozenset(), reached: frozenset[str] = frozenset()
    ) -> frozenset[str]:
        """The operations that do not become active; `active` could be for all that the automaton knows, and the goals
        of others are `reached`.
        """
        out = self.done | self.out_of(ServiceKind.OPERATION)
        return out | self.jobs.idle(automaton, (active - out) | reached)

    def out_of(self, kind: ServiceKind) -> frozenset[str]:
        """The names of what is out of service, of one kind."""
        return frozenset(name for of, name in self.service if of is kind)

    def circumstances(self, automaton: Automaton) -> Circumstances:
        """In what plans are made and followed."""
        forced = self.forces.keys() & automaton.outputs
        barred = self.out_of(ServiceKind.ABILITY) | writing(automaton, forced)
        offline = self.silent | self.out_of(ServiceKind.RESOURCE)
        restart = self.operator_plan is not None and self.operator_plan.restart
        return Circumstances(offline=offline, restart=restart, barred=barred)

    def sensing(self, measured: Mapping[str, Value | None]) -> tuple[Mapping[str, Value | None], ExecutionState]:
        """The measured values as they are forced, and the conduct that keeps what these would be."""
        forced = self.forces.keys() & measured.keys()
        held = {name: self.forces[name].value for name in forced}
        return {**measured, **held} if forced else measured, self._with_real({name: measured[name] for name in forced})

    def keeping(
        self, values: Mapping[str, Value | None], outputs: Iterable[str]
    ) -> tuple[Mapping[str, Value | None], ExecutionState]:
        """Return what forced outputs are again after abilities wrote to them; the conduct keeps what they would be."""
        forced = [name for name in self.forces if name in outputs and values[name] != self.forces[name].value]
        held = {name: self.forces[name].value for name in forced}
        return held, self._with_real({name: values[name] for name in forced})

    def _with_real(self, real: Mapping[str, Value | None]) -> ExecutionState:
        changed = {name: value for name, value in real.items() if self.forces[name].real != value}
        if not changed:
            return self
        return replace(self, forces={**self.forces, **{n: replace(self.forces[n], real=v) for n, v in changed.items()}})

    def without_service(self, gone: Iterable[OutOfService]) -> ExecutionState:
        """With more out of service."""
        return replace(self, service={**self.service, **{(each.of, each.name): each for each in gone}})

    def started_one(self) -> ExecutionState:
        """After a start: with stepping, that step has been taken."""
        return replace(self, steps=self.steps - 1) if self.stepping else self


def writing(automaton: Automaton, outputs: Iterable[str]) -> frozenset[str]:
    """The abilities whose starts write one of the outputs."""
    forced = frozenset(outputs)
    if not forced:
        return forced
    return frozenset(
        ability.name
        for ability in automaton.abilities.values()
        if any(target(action) in forced for action in ability.start_actions)
    )


# The goals of a running station: of each active operation how far its local formula has come, and what it forbade.
#
# The positions of a formula are the state at its operation's activation, then every state after step 3 and after each
# start, up to the first after step 3 that satisfies the goal. None is counted before production is started, since till
# then nobody steers the station. What unknown values leave open counts as violated: nobody can say that it was kept.


@dataclass(frozen=True)
class ActiveGoals:
    """The state of what is pursued. Each step gives a new one.

    `violated` says when the formula of an operation was violated, from then until the operation is activated again.
    """

    goals: Mapping[str, Goal] = field(default_factory=dict)
    violated: Mapping[str, Timestamp] = field(default_factory=dict)

    def activated(self, automaton: Automaton, names: Iterable[str], state: State, now: Timestamp) -> ActiveGoals:
        """Operations are activated in `state`, the first position of their formulas."""
        fresh = {name: goal_of(automaton.operations[name]) for name in names}
        violated = {name: since for name, since in self.violated.items() if name not in fresh}
        return _stepped({**self.goals, **fresh}, violated, fresh, state, now)

    def settled(self, completed: Iterable[str], state: State, now: Timestamp) -> ActiveGoals:
        """Step 3 has led to `state`, which satisfies the goals of `completed`: the last position of these."""
        done = set(completed)
        broken = [name for name in done & self.goals.keys() if settled((self.goals[name],), state) is None]
        violated = {**dict.fromkeys(broken, now), **self.violated}
        going_on = {name: goal for name, goal in self.goals.items() if name not in done}
        return _stepped(going_on, violated, going_on, state, now)

    def moved(self, state: State, now: Timestamp) -> ActiveGoals:
        """A start has led to `state`."""
        return _stepped(self.goals, self.violated, self.goals, state, now)

    def without(self, names: Iterable[str]) -> ActiveGoals:
        """Operations are pursued no longer, and what they violated is forgotten."""
        gone = set(names)
        if gone.isdisjoint(self.goals) and gone.isdisjoint(self.violated):
            return self
        return ActiveGoals(
            {name: goal for name, goal in self.goals.items() if name not in gone},
            {name: since for name, since in self.violated.items() if name not in gone},
        )

    @property
    def hopeful(self) -> frozenset[str]:
        """The operations whose goals can still be reached as their formulas demand."""
        return frozenset(name for name in self.goals if name not in self.violated)

    def select(self, names: Iterable[str]) -> tuple[Goal, ...]:
        """The goals of operations, in order of their names."""
        return tuple(self.goals[name] for name in sorted(names))


def _stepped(
    goals: Mapping[str, Goal], violated: Mapping[str, Timestamp], stepping: Iterable[str], state: State, now: Timestamp
) -> ActiveGoals:
    """The formulas of those `stepping` go on to `state`; one that has been violated stays where it is."""
    after, broken = dict(goals), dict(violated)
    for name in stepping:
        if name in broken:
            continue
        stepped = moved((after[name],), state)
        if stepped is None:
            broken[name] = now
        else:
            (after[name],) = stepped
    return ActiveGoals(after, broken)
