"""Query handler of the controller: dispatch of queries, definitions of abilities, contents of jobs."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Ability, Automaton, WorkMaster, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import (
    AboutFlows,
    AboutPipelines,
    AboutWorkMasters,
    Ask,
    AskAdvice,
    AskCorrection,
    AskDefinition,
    AskFigures,
    AskGoal,
    AskRecord,
    AskReset,
    AskWhyNot,
)
from sequence_planner.controller.recovery.corrections import Corrections
from sequence_planner.controller.recovery.explain import ConditionContext
from sequence_planner.controller.recovery.proposals import Offers
from sequence_planner.controller.recovery.trials import AbilityTrial, Trials, TrialWatch, reactions
from sequence_planner.controller.recovery.why_not import WhyNot
from sequence_planner.controller.views.automaton_diagram import Drawing
from sequence_planner.controller.views.details import (
    AbilityDefinitionView,
    TrialView,
    TriedReactionView,
    WorkAbilityView,
    WorkMastersView,
    WorkMasterView,
    WorkOperationView,
)
from sequence_planner.controller.views.metrics import FiguresView
from sequence_planner.controller.views.part import View
from sequence_planner.controller.views.pipelines import FlowsView, PipelinesView, RecordView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.language.printer import print_assignment

# Tells how an ability is defined, what of it holds now, and how its last trial went.


class Definitions:
    """Answers about the abilities of `execution`. Used from one event loop."""

    def __init__(self, execution: Executor, surroundings: ConditionContext, trials: Trials) -> None:
        self._execution = execution
        self._around = surroundings
        self._trials = trials
        self._watch = TrialWatch(execution)

    def of(self, name: str) -> AbilityDefinitionView:
        """The definition of a ground ability. Raises `CommandRefused` for one that the station does not have."""
        execution = self._execution
        ability = execution.automaton.abilities.get(name)
        if ability is None:
            detail = f"The station has no ability `{name}`. Look at those it has."
            raise CommandRefused("unknown-ability", "There is no such ability", detail, 404)
        refusal, trial = self._trials.refusal(ability), self._watch.last
        drawing = Drawing(execution.automaton, execution.state, self._around.guards(), execution.supervisor)
        return AbilityDefinitionView(
            **dict(drawing.of(ability)),
            revision=execution.revision,
            obstacle=None if refusal is None else refusal.detail,
            real_devices=list(self._trials.real_devices()),
            trial=None if trial is None or trial.ability.name != name else _trial(trial),
        )


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


# Who answers what the controller is asked: each ask has its place.


@dataclass(frozen=True)
class QueryHandler:
    """Answers asks. The event loop is never held up: what takes long is awaited, and done in another process."""

    pipelines: Callable[[], PipelinesView]
    flows: Callable[[Container[str] | None], FlowsView]
    record: Callable[[str], RecordView]
    work_masters: Callable[[], WorkMastersView]
    figures: Callable[[], FiguresView]
    corrections: Corrections
    offers: Offers
    why_not: WhyNot
    definitions: Definitions

    async def answer(self, ask: Ask) -> View:
        """The document that answers it. Raises `CommandRefused`."""
        match ask:
            case AboutPipelines():
                return self.pipelines()
            case AboutFlows(among=among):
                return self.flows(among)
            case AskRecord(pipeline=pipeline):
                return self.record(pipeline)
            case AboutWorkMasters():
                return self.work_masters()
            case AskFigures():
                return self.figures()
            case AskCorrection(values=values):
                return await self.corrections.preview(values)
            case AskAdvice():
                return await self.offers.advice()
            case AskGoal(predicate=predicate):
                return await self.offers.goal(predicate)
            case AskReset(operation=operation):
                return await self.offers.reset(operation)
            case AskWhyNot():
                return await self.why_not.answer(ask)
            case AskDefinition(ability=ability):
                return self.definitions.of(ability)


# Tells what jobs of a station consist of.


def work_masters_view(automaton: Automaton) -> WorkMastersView:
    """All work masters of a station, and what its abilities write."""
    return WorkMastersView(
        work_masters={name: _master(automaton, master) for name, master in automaton.work_masters.items()},
        abilities={name: _ability(automaton, ability) for name, ability in automaton.abilities.items()},
    )


def _master(automaton: Automaton, master: WorkMaster) -> WorkMasterView:
    return WorkMasterView(
        title=master.title,
        brings=[print_assignment(action) for action in master.brings],
        brought=sorted({target(action) for action in master.brings}),
        operations={name: _operation(automaton, name, after) for name, after in master.operations.items()},
        alternatives=[[sorted(branch) for branch in branches] for branches in master.alternatives],
        arbitrary=[[sorted(branch) for branch in branches] for branches in master.arbitrary],
    )


def _operation(automaton: Automaton, name: str, after: frozenset[str]) -> WorkOperationView:
    operation = automaton.operations[name]
    read = read_variables(automaton, (operation.goal,))
    return WorkOperationView(title=operation.title, after=sorted(after), goal_reads=sorted(read))


def _ability(automaton: Automaton, ability: Ability) -> WorkAbilityView:
    actions = [*ability.start_actions, *ability.finish_actions, *ability.cancel_actions]
    for effect in reactions(automaton, ability.name):
        actions += effect.actions
    written = sorted({target(action) for action in actions})
    return WorkAbilityView(title=ability.title, writes=written, instant=ability.finish_guard is None)
