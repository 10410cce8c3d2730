"""Trial run of a single ability, and the comparison of device reactions with expected effects."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from sequence_planner.automaton.automaton import Ability, Effect, State
from sequence_planner.automaton.dependencies import reactions
from sequence_planner.automaton.tick import effect_writes
from sequence_planner.controller.commands.command import CommandRefused, answers, handles
from sequence_planner.controller.commands.queries import AskDefinition
from sequence_planner.controller.commands.recovery import TryAbility
from sequence_planner.controller.recovery.explain import ConditionContext, obstacles, of_ability
from sequence_planner.controller.views.automaton_diagram import Drawing
from sequence_planner.controller.views.details import AbilityDefinitionView, TrialView, TriedReactionView
from sequence_planner.controller.views.wording import plan_running
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import Heard, OperatorPlanStarted, Ticked, TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import LastOperatorPlan, OperatorPlan
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.texts.message import Message, joined, message

# What has come of the last trial of an ability: its run from the start to the end, and the reactions of its device.


@dataclass
class ExpectedEffect:
    """An effect that may come: `lacking` are the values that it has still to bring since it has been `due`."""

    effect: Effect
    due: Timestamp | None = None
    came: Timestamp | None = None
    lacking: State = field(default_factory=dict)

    def look(self, state: State, now: Timestamp) -> None:
        """Take note of a state; what comes one variable after the other is one reaction."""
        if self.due is None:
            written = effect_writes(self.effect, state) or {}
            self.lacking = {name: value for name, value in written.items() if state[name] != value}
            self.due = now if self.lacking else None
        elif self.came is None:
            self.lacking = {name: value for name, value in self.lacking.items() if state[name] != value}
            self.came = None if self.lacking else now


@dataclass
class AbilityTrial:
    """The course of a trial; `end` says how it ended."""

    operator_plan: OperatorPlan
    ability: Ability
    reactions: list[ExpectedEffect]
    started: Timestamp | None = None
    executing: Timestamp | None = None
    end: LastOperatorPlan | None = None


class TrialWatch:
    """Listens to an execution for trials. What a device still does after one counts, until something else starts."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution
        self.last: AbilityTrial | None = None
        self._looks = False
        execution.listeners.append(self._hear)

    def _hear(self, heard: Heard) -> None:
        match heard.happening:
            case OperatorPlanStarted(operator_plan):
                self._end()
                self._looks = False
                if operator_plan.ability is not None:
                    self._begin(operator_plan, operator_plan.ability)
            case Ticked(now=now) if heard.outcome is not None:
                self._note(heard.outcome, heard.after, now)
                self._end()
            case _:
                self._end()

    def _begin(self, operator_plan: OperatorPlan, name: str) -> None:
        automaton = self._execution.automaton
        self.last = AbilityTrial(
            operator_plan, automaton.abilities[name], [ExpectedEffect(each) for each in reactions(automaton, name)]
        )
        self._looks = True

    def _end(self) -> None:
        trial, execution = self.last, self._execution
        if trial is not None and trial.end is None and execution.operator_plan is not trial.operator_plan:
            trial.end = execution.conduct.last_operator_plan

    def _note(self, outcome: TickOutcome, state: State, now: Timestamp) -> None:
        trial = self.last
        if trial is None or not self._looks:
            return
        if trial.started is None:
            if trial.ability.name not in outcome.started:
                return
            trial.started = now
        elif outcome.started:
            self._looks = False  # what comes from now on may have another cause
            return
        if trial.executing is None and state[trial.ability.flag("executing")] is True:
            trial.executing = now
        for reaction in trial.reactions:
            reaction.look(state, now)


# Trying an ability: one run of it alone, under the same conditions as ever.
#
# It is an operator plan, so operations wait for it, and the guards and the supervisor are as strict as in production.
# What may start starts at once; what may not is refused, with all that is in its way.


class Trials:
    """Has abilities of `execution` tried. `real_devices` names what speaks against these being emulated ones."""

    def __init__(
        self, execution: Executor, surroundings: ConditionContext, real_devices: Callable[[], Sequence[str]]
    ) -> None:
        self._execution = execution
        self._around = surroundings
        self._watch = TrialWatch(execution)
        self.real_devices = real_devices

    @handles(TryAbility)
    def begin(self, command: TryAbility, moment: Timestamp) -> None:
        """Have it started in the next tick."""
        ability = self._find(command.ability)
        if (refusal := self.refusal(ability)) is not None:
            raise refusal
        if not command.real_devices and (there := self.real_devices()):
            raise CommandRefused("real-devices", message("refused.real-devices.confirm", devices=joined(there)))
        title = message("offer.try", ability=ability.title)
        trial = OperatorPlan.trial(ability, title, command.actor.name, command.reason or "", moment)
        self._execution.start_operator_plan(trial, moment)

    @answers(AskDefinition)
    def definition(self, query: AskDefinition) -> AbilityDefinitionView:
        """How an ability is defined, what of that holds now, and how its last trial went. Raises `CommandRefused`."""
        execution, ability = self._execution, self._find(query.ability)
        refusal, trial = self.refusal(ability), self._watch.last
        drawing = Drawing(execution.automaton, execution.state, self._around.guards(), execution.supervisor)
        return AbilityDefinitionView(
            **dict(drawing.of(ability)),
            revision=execution.revision,
            obstacle=None if refusal is None else refusal.detail,
            obstacle_message=None if refusal is None else refusal.detail,
            real_devices=list(self.real_devices()),
            trial=None if trial is None or trial.ability is not ability else _trial(trial),
        )

    def _find(self, name: str) -> Ability:
        ability = self._execution.automaton.abilities.get(name)
        if ability is None:
            raise CommandRefused("unknown-ability", message("refused.unknown-ability.those", name=name), 404)
        return ability

    def refusal(self, ability: Ability) -> CommandRefused | None:
        """Return why it cannot be tried now; None when it can."""
        execution = self._execution
        if execution.operator_plan is not None:
            return plan_running(execution.operator_plan.title)
        if execution.production is not Production.STARTED:
            return CommandRefused("production-not-started", message("refused.production-not-started.try"))
        if execution.mode is not Mode.PAUSED:
            return CommandRefused(
                "wrong-mode", message("refused.wrong-mode.try", mode=message(f"mode.{execution.mode}"))
            )
        if lacking := list(dict.fromkeys(self._lacking(ability))):
            return CommandRefused(
                "not-startable",
                message("refused.not-startable.waits", ability=ability.title, conditions=joined(lacking)),
            )
        return None

    def _lacking(self, ability: Ability) -> Iterator[Message]:
        execution = self._execution
        if execution.conduct.stepping and not execution.conduct.steps:
            yield message("waits.step")
        yield from obstacles(execution)
        guard = self._around.guards().get(ability.name)
        yield from (each.text for each in of_ability(execution, ability, self._around.feeds, guard))


def _trial(trial: AbilityTrial) -> TrialView:
    operator_plan, end = trial.operator_plan, trial.end
    return TrialView(
        by=operator_plan.by,
        reason=operator_plan.why,
        accepted=operator_plan.taken.epoch,
        started=_epoch(trial.started),
        executing=_epoch(trial.executing),
        ended=None if end is None else end.ended.epoch,
        done=end is not None and end.done,
        why="" if end is None else end.why,
        reactions=[
            TriedReactionView(name=each.effect.name, due=_epoch(each.due), came=_epoch(each.came))
            for each in trial.reactions
        ],
    )


def _epoch(moment: Timestamp | None) -> float | None:
    return None if moment is None else moment.epoch
