"""Tasks for people, their acknowledgements as measured variables, and what keeps people from doing them.

A task is open as long as a human ability is executing. An acknowledgement names the task and its revision, so a late or
repeated one never completes another task, be it one of a controller that has been started again since. It makes the
ability's variable true until the ability has finished. A problem is told of a task in the same way; it changes nothing
but that people are told of it, until the task is over or somebody says that it is solved.
"""

from __future__ import annotations

import secrets
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

from sequence_planner.automaton.automaton import Ability, Automaton, Instruction, State
from sequence_planner.controller.alarms.kinds import PROBLEM, Cause
from sequence_planner.controller.commands.command import CommandRefused, handles
from sequence_planner.controller.commands.tasks import (
    AcknowledgeTask,
    ReportProblem,
    SolveProblem,
    TaskCommand,
    TaskProblem,
    WaitingTask,
)
from sequence_planner.controller.views.station import InstructionView, NextMovesView, TaskProblemView, TaskView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.once_done import OnceDone, TaskOutlook
from sequence_planner.language.types import Value
from sequence_planner.texts.message import Argument, Message, message

_NEXT_MOVES = 2  # that are named of each resource that moves once a task is done


class TaskHandler:
    """The open tasks of a station; `fed` are the variables that topics feed, such as those of a real watch."""

    def __init__(self, automaton: Automaton, fed: Collection[str] = ()) -> None:
        self._humans = {a.name: a for a in automaton.abilities.values() if a.human is not None}
        variables = {a.human.acknowledgement for a in self._humans.values() if a.human is not None}
        self._own = sorted(variables.difference(fed))
        self._given: dict[str, str] = {}  # acknowledged variable: the ability whose task it was
        self._life = secrets.token_hex(4)
        self._numbers = 0
        self.open: dict[str, WaitingTask] = {}
        self.problems: dict[str, TaskProblem] = {}  # by task

    def measured(self) -> dict[str, Value | None]:
        """The acknowledgement variables; of those that topics feed, the ones that were acknowledged here."""
        return {**dict.fromkeys(self._own, False), **dict.fromkeys(self._given, True)}

    def update(self, state: State, finished: Iterable[str], ended: Iterable[str], now: float) -> None:
        """After a tick: open and close tasks, and let go of acknowledgements that have done their work.

        `finished` are the abilities that took their finish actions, `ended` those of them that had been running.
        """
        done, over = set(finished), set(ended)
        self._given = {variable: ability for variable, ability in self._given.items() if ability not in done}
        executing = {name for name, ability in self._humans.items() if state[ability.flag("executing")] is True}
        # An ability that ended and was started again in the same tick is another task.
        self.open = {id_: task for id_, task in self.open.items() if task.ability in executing - over}
        for name in sorted(executing - {task.ability for task in self.open.values()}):
            human = self._humans[name].human
            assert human is not None
            self._numbers += 1
            id_ = f"{self._life}-{self._numbers}"
            self.open[id_] = WaitingTask(id_, 1, name, self._humans[name].title, human.text, now)
        self.problems = {id_: problem for id_, problem in self.problems.items() if id_ in self.open}

    @handles(AcknowledgeTask)
    def acknowledge(self, command: AcknowledgeTask, moment: Timestamp) -> None:
        """A person says that the task is done."""
        ability = self._find(command).ability
        human = self._humans[ability].human
        assert human is not None
        self._given[human.acknowledgement] = ability

    @handles(ReportProblem)
    def report(self, command: ReportProblem, moment: Timestamp) -> None:
        """A person cannot do the task. Of a problem that is known already, what was said last is told."""
        task, known = self._find(command), self.problems.get(command.task)
        since = moment.epoch if known is None else known.since
        self.problems[task.id] = TaskProblem(command.actor.name, since, command.reason or "", command.what)

    @handles(SolveProblem)
    def solve(self, command: SolveProblem, moment: Timestamp) -> None:
        """The task can be done after all."""
        self.problems.pop(self._find(command).id, None)

    def _find(self, command: TaskCommand) -> WaitingTask:
        """The task as it was seen. Raises `CommandRefused` when it is not open in that revision."""
        id_, revision = command.task, command.revision
        task = self.open.get(id_)
        if task is None:
            raise CommandRefused("task-gone", message("refused.task-gone.id", task=id_))
        if task.revision != revision:
            raise CommandRefused(
                "task-changed",
                message("refused.task-changed.revision", task=id_, revision=task.revision, seen=revision),
            )
        return task


class OpenTasks:
    """Those of `tasks` that are open at `execution`, and the alarms of those that somebody cannot do.

    `goes_on` says whether anything starts by itself, and `waiting` what waits for a resource.
    """

    def __init__(
        self,
        execution: Executor,
        tasks: TaskHandler,
        goes_on: Callable[[], bool],
        waiting: Callable[[str], Message],
    ) -> None:
        self._execution, self._tasks = execution, tasks
        self._goes_on, self._waiting = goes_on, waiting
        self._outlook = TaskOutlook(execution)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        if not self._tasks.open:
            return {"tasks": {}}
        automaton = self._execution.automaton
        abilities, goes_on = automaton.abilities, self._goes_on()
        views = {}
        for id_, task in self._tasks.open.items():
            then = self._outlook.once_done(task.ability, moment) if goes_on else OnceDone()
            movers = _movers([abilities[name] for name in then.moves], then.may_move, automaton.resources)
            views[id_] = TaskView(
                revision=task.revision,
                resource=abilities[task.ability].resource,
                ability=task.ability,
                title=task.title,
                text=task.text,
                created=task.created,
                next_moves=[title for mover in movers for title in mover.moves],
                movers=movers,
                begins=[automaton.operations[name].title for name in then.begins],
                problem=_problem(self._tasks.problems.get(id_)),
                instruction=_instruction(abilities[task.ability].instruction),
            )
        return {"tasks": views}

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """One cause of an alarm for each."""
        for task, problem in self._tasks.problems.items():
            ability = self._execution.automaton.abilities[self._tasks.open[task].ability]
            what = None if problem.what is None else message(f"problem.{problem.what}")
            said: Argument = message("problem-both", what=what, why=problem.why) if what and problem.why else ""
            said = said or what or problem.why
            yield PROBLEM.cause(
                task,
                {
                    "by": problem.by,
                    "ability": message("quoted", title=ability.title),
                    "what": message("problem-said", said=said) if said else "",
                    "waiting": self._waiting(ability.resource),
                },
                resources=[ability.resource],
            )


def _movers(moves: Sequence[Ability], may: Iterable[str], titles: Mapping[str, str]) -> list[NextMovesView]:
    """Who moves, of each the first of what it does, and who may."""
    sure = [
        NextMovesView(
            name=name, title=titles[name], moves=[each.title for each in moves if each.resource == name][:_NEXT_MOVES]
        )
        for name in dict.fromkeys(each.resource for each in moves)
    ]
    return [*sure, *(NextMovesView(name=name, title=titles[name], moves=[]) for name in may)]


def _instruction(instruction: Instruction | None) -> InstructionView | None:
    if instruction is None:
        return None
    return InstructionView(text=dict(instruction.text), image=instruction.image, video=instruction.video)


def _problem(problem: TaskProblem | None) -> TaskProblemView | None:
    return None if problem is None else TaskProblemView.model_validate(problem, from_attributes=True)
