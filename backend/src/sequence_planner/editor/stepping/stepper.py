"""Steps of a station through its model: one tick of the reference semantics each, with what happens in it chosen."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from enum import StrEnum
from typing import Final

import structlog

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Kind, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import (
    Writes,
    apply_effects,
    effect_writes,
    finish,
    record_activity,
    sense,
    start,
    start_guard_holds,
    supervised_start,
    synchronise,
    update_operations,
)
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.syntax import Expression
from sequence_planner.language.types import Value, contains
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.problem import (
    Contract,
    Goal,
    Plan,
    PlanAnswer,
    PlanRequest,
    PlanTick,
    Verdict,
    goals_of,
)
from sequence_planner.planning.recovery.timing import expected_seconds
from sequence_planner.process.budget import Budget
from sequence_planner.texts.message import Message, message

LOG = structlog.get_logger(__name__)

MOST_BY_ITSELF: Final = 100  # ticks in a row in which only finishes happen; then the station is restless
PLANNED_WITHIN: Final = 5.0  # seconds for a plan from a moment
MOST_FOLLOWED: Final = 400  # ticks that plans are followed without being asked again


class TickStep(Immutable):
    """One tick: variables that somebody `sets`, `effects` that happen at once, then `starts` in their order."""

    effects: tuple[str, ...] = ()
    starts: tuple[str, ...] = ()
    sets: Mapping[str, Value | None] = {}


class StepMoment(Immutable):
    """The station after a step, so many `seconds` after the beginning as devices usually need.

    `ended` are abilities whose runs were over, `completed` and `activated` are operations; `done` are those that were
    completed since the beginning and do not repeat. One that is `restless` goes on for ever by itself: abilities finish
    again and again.
    """

    state: State
    active: frozenset[str]
    step: TickStep = TickStep()
    seconds: float = 0.0
    ended: tuple[str, ...] = ()
    completed: tuple[str, ...] = ()
    activated: tuple[str, ...] = ()
    done: frozenset[str] = frozenset()
    restless: bool = False


class StepError(Exception):
    """A step that cannot be taken, and why."""

    def __init__(self, why: Message) -> None:
        super().__init__(why)
        self.why = why


class StopReason(StrEnum):
    """Why plans were followed no further."""

    UNTIL = "until"  # the condition holds
    DONE = "done"  # the goals are reached
    NO_PLAN = "no-plan"
    MOST = "most"  # so many ticks were followed
    TIME = "time"  # there was no more of it


class Stepper:
    """Leads a station through the states of `automaton`, whose starts the `supervisor` allows."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self.automaton = automaton
        self.supervisor = supervisor
        self._effects = {effect.name: effect for effect in automaton.effects}
        self._planner = Planner(automaton, supervisor)

    def first_moment(self, state: State) -> StepMoment:
        """Return the first moment, with what is active and has finished in `state`."""
        active = update_operations(self.automaton, state, frozenset())
        return self.come_to_rest(StepMoment(record_activity(self.automaton, state, active), active))

    def step_on(self, moment: StepMoment, step: TickStep) -> StepMoment:
        """Return the moment after one more tick. Raises `StepError` where it is none of the model."""
        automaton, before = self.automaton, moment.state
        sensed = apply_effects(self._set(before, step.sets), self._of(step.effects))
        if sensed is None:
            raise StepError(message("step.effects-not-now", effects=list(step.effects)))
        finished = synchronise(automaton, finish(automaton, sensed).state)
        active = update_operations(automaton, finished, moment.active) - moment.done
        state = record_activity(automaton, finished, active)
        for name in step.starts:
            ability = automaton.abilities.get(name)
            if ability is None:
                raise StepError(message("step.no-ability", name=name))
            after = supervised_start(automaton, self.supervisor, before, state, ability)
            if after is None:
                raise StepError(message("step.start-not-now", ability=ability.title))
            state = after
        completed = moment.active - active
        seconds = moment.seconds + expected_seconds(automaton, [PlanTick(step.effects, step.starts)])
        return StepMoment(
            state,
            active,
            step,
            seconds,
            tuple(name for name in automaton.abilities if self._runs(before, name) and not self._runs(finished, name)),
            tuple(sorted(completed)),
            tuple(sorted(active - moment.active)),
            moment.done | {name for name in completed if not automaton.operations[name].repeat},
        )

    def come_to_rest(self, moment: StepMoment) -> StepMoment:
        """Return the moment once all has happened that happens by itself: finishes, and what these make possible."""
        for _ in range(MOST_BY_ITSELF):
            after = self.step_on(moment, TickStep())
            if after.state == moment.state and after.active == moment.active:
                return moment
            moment = replace(
                after,
                step=moment.step,
                ended=(*moment.ended, *after.ended),
                completed=(*moment.completed, *after.completed),
                activated=(*moment.activated, *after.activated),
            )
        return replace(moment, restless=True)

    def settable(self) -> Iterator[tuple[str, Sequence[Value], bool]]:
        """Yield what somebody can disturb, with its values and whether it may be unknown."""
        for name, variable in self.automaton.variables.items():
            if variable.kind in (Kind.MEASURED, Kind.ESTIMATED):
                yield name, list(variable.type.domain), variable.kind is Kind.MEASURED

    def possible_effects(self, state: State) -> Iterator[tuple[Effect, Writes]]:
        """Yield the effects that would change something, each with what it writes."""
        for effect in self.automaton.effects:
            written = effect_writes(effect, state)
            if written is not None and any(state[name] != value for name, value in written.items()):
                yield effect, written

    def written_by(self, name: str, state: State) -> Writes:
        """Return what an effect writes in a state; nothing where it does not happen there."""
        effect = self._effects.get(name)
        return {} if effect is None else effect_writes(effect, state) or {}

    def possible_starts(self, state: State) -> Iterator[Ability]:
        """Yield the abilities that may start in automatic mode."""
        for ability in self.automaton.abilities.values():
            if ability.restart or self._runs(state, ability.name):
                continue
            if supervised_start(self.automaton, self.supervisor, state, state, ability) is not None:
                yield ability

    def kept_back(self, state: State) -> Iterator[tuple[Ability, bool]]:
        """Yield the abilities that may not start and do not run, each with whether only the supervisor keeps it."""
        for ability in self.automaton.abilities.values():
            if ability.restart or self._runs(state, ability.name):
                continue
            after = start(self.automaton, state, ability) if start_guard_holds(ability, state) else None
            if after is None:
                yield ability, False
            elif not self.supervisor.allows(state, after):
                yield ability, True

    def running(self, state: State) -> tuple[str, ...]:
        """Return the abilities under way."""
        return tuple(name for name in self.automaton.abilities if self._runs(state, name))

    def violated(self, state: State) -> tuple[str, ...]:
        """Return the titles of the specifications that do not hold for certain."""
        all_ = self.automaton.specifications.values()
        return tuple(each.title for each in all_ if evaluate(each.forbidden, state) is not False)

    def ask_plan(self, moment: StepMoment, until: Expression | None = None) -> PlanAnswer | None:
        """Return what the planner says of the active operations, or of where a condition holds; None where there is
        neither.

        Where no engine could answer nothing is known: `LATE`, as where the time was too short.
        """
        if until is None and not moment.active:
            return None
        goals = goals_of(self.automaton, sorted(moment.active)) if until is None else (Goal("until", until),)
        try:
            return self._planner.answer(PlanRequest(moment.state, goals, PLANNED_WITHIN, contract=Contract.FAST))
        except PlannerError:
            LOG.exception("a step's plan could not be made")
            names = tuple(goal.name for goal in goals)
            return PlanAnswer(Verdict.LATE, None, (), names, 0, 0.0, undecided=names)

    def follow(
        self, moment: StepMoment, until: Expression | None, budget: Budget
    ) -> tuple[list[StepMoment], StopReason]:
        """Follow plans from a moment on: one to its end, or one after the other `until` a condition holds.

        Each moment is one tick with what then happens by itself, as `come_to_rest` has it.
        """
        followed: list[StepMoment] = []
        if until is not None and holds(until, moment.state):
            return followed, StopReason.UNTIL
        while len(followed) < MOST_FOLLOWED:
            if budget.spent:
                return followed, StopReason.TIME
            answer = self.ask_plan(moment)
            plan = None if answer is None else answer.plan
            if answer is None or (plan is not None and not plan.ticks):
                return followed, StopReason.DONE
            if plan is None:
                return followed, StopReason.NO_PLAN
            for tick in steps_of(plan):
                if budget.spent:
                    return followed, StopReason.TIME
                try:
                    moment = self.come_to_rest(self.step_on(moment, tick))
                except StepError:  # what happened by itself has changed what was planned for: it is planned again
                    break
                followed.append(moment)
                if until is not None and holds(until, moment.state):
                    return followed, StopReason.UNTIL
            else:
                if until is None:
                    return followed, StopReason.DONE
        return followed, StopReason.MOST

    def _set(self, state: State, sets: Mapping[str, Value | None]) -> State:
        for name, value in sets.items():
            declared = self.automaton.variables.get(name)
            if declared is None:
                raise StepError(message("step.no-variable", name=name))
            if declared.kind not in (Kind.MEASURED, Kind.ESTIMATED):
                raise StepError(message("step.not-set", name=name))
            if value is None and declared.kind is not Kind.MEASURED:
                raise StepError(message("step.always-known", name=name))
            if value is not None and not contains(declared.type, value):
                raise StepError(message("step.not-in-domain", name=name, range=str(declared.type)))
        return sense(state, sets) if sets else state

    def _of(self, names: Collection[str]) -> Sequence[Effect]:
        found = [self._effects.get(name) for name in names]
        if None in found:
            raise StepError(message("step.no-effect", name=next(each for each in names if each not in self._effects)))
        return [each for each in found if each is not None]

    def _runs(self, state: State, name: str) -> bool:
        return state[self.automaton.abilities[name].flag("executing")] is True


def steps_of(plan: Plan) -> Iterator[TickStep]:
    """Yield the ticks of a plan as steps."""
    return (TickStep(tick.effects, tick.starts) for tick in plan.ticks)
