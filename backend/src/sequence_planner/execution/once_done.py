"""What comes of it once a person has done a task: people are told before they say that it is done.

What the plan starts then is found by taking it on in thought, once with the task done and once without; what it starts
without moves anyhow, and is not said of the task. Nothing that other people are asked for is done meanwhile. Of an
operation that becomes active by it there is no plan yet: a relaxed plan tells which devices may move for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from sequence_planner.automaton.automaton import Ability, Automaton
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.tick import Writes
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.language.evaluator import holds
from sequence_planner.planning.heuristic.relaxation import counted_on
from sequence_planner.planning.heuristic.relaxed_plan import RelaxedPlan

_TICKS = 200  # that are taken in thought at most
# Until a job's next operation is active: one tick completes the one before.
_ROUNDS = 3


class OnceDone(Immutable):
    """What comes of a task that is done: the abilities that the plan starts then and that move something, in order, the
    operations that become active by it, and the resources that may move for them, by their names.
    """

    moves: tuple[str, ...] = ()
    begins: tuple[str, ...] = ()
    may_move: tuple[str, ...] = ()


class TaskOutlook:
    """Tells of tasks what comes of them; what has been found counts as long as nothing has happened."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution
        self._at: object = None
        self._known: dict[str, OnceDone] = {}

    def once_done(self, task: str, now: Timestamp) -> OnceDone:
        """Return what comes of it once what the ability `task` asks for is done."""
        execution = self._execution
        at = execution.revision, execution.plan.status, execution.plan.order.names, execution.conduct, execution.active
        if at != self._at:
            self._at = at
            self._known.clear()
        if task not in self._known:
            self._known[task] = _once_done(execution, task, now)
        return self._known[task]


def _once_done(execution: Executor, task: str, now: Timestamp) -> OnceDone:
    """Return what comes of it once what the ability `task` asks for is done."""
    automaton = execution.automaton
    human = automaton.abilities[task].human
    assert human is not None
    run = execution.simulated()
    run.sense({human.acknowledgement: True})
    run.finish()
    run.synchronise()
    active = _active(execution, run, now)
    begins = active - execution.active
    # Where no plan is followed there will be one, for all that is active then.
    followed = execution.plan.status is PlanStatus.FOLLOWED
    asked = begins if followed else active
    after = _started(execution, run.fork())
    without = set(_started(execution, execution.simulated())) if after else set()
    moves = tuple(name for name in after if name not in without and _moves(automaton.abilities[name]))
    known = {automaton.abilities[name].resource for name in moves}
    may = (resource for resource in _may_move(execution, run, asked) if resource not in known)
    in_order = (name for name in automaton.operations if name in begins)
    return OnceDone(moves, tuple(in_order), tuple(may))


def _moves(ability: Ability) -> bool:
    return ability.moves and ability.human is None


def _active(execution: Executor, run: CompiledRun, now: Timestamp) -> frozenset[str]:
    """The operations that are active once `run` has gone on, also those that are next for a job."""
    automaton, conduct, active = execution.automaton, execution.conduct, execution.active

    def is_at_goal(name: str) -> bool:
        return holds(automaton.operations[name].goal, run.values)

    for _ in range(_ROUNDS):
        found = run.update_operations(active)
        branches = frozenset(name for name in automaton.branching_operations if is_at_goal(name))
        active = found - conduct.idle_operations(automaton, found, branches)
        conduct = replace(conduct, jobs=conduct.jobs.advanced(automaton, active, is_at_goal, now))
        run.record_activity(active)
    return active


def _started(execution: Executor, run: CompiledRun) -> list[str]:
    """The steps of the plan that start from where `run` stands: devices do what they should, and people nothing."""
    automaton, circumstances = execution.automaton, execution.circumstances
    acknowledgements = _acknowledgements(automaton)
    effects = [each.name for each in automaton.effects if not each.fault and each.resource not in circumstances.offline]
    ahead, started = list(execution.plan.order.names), list[str]()
    for _ in range(_TICKS):
        begun = set[str]()
        for name in list(ahead):
            if name not in begun and run.may_start(name) and run.start(name):
                ahead.remove(name)
                begun.add(name)
                started.append(name)
        if not ahead:
            break
        sensed = _together(effects, run.effect, acknowledgements)
        sensed = {name: value for name, value in sensed.items() if run.values[name] != value}
        run.sense(sensed)
        finished = run.finish().finished
        run.synchronise()
        if not sensed and not finished and not begun:
            break
    return started


def _together(effects: Sequence[str], of: Callable[[str], Writes | None], never: frozenset[str]) -> Writes:
    """What happens at once; no one says of anything in `never` that it is done."""
    together: Writes = {}
    for name in effects:
        writes = of(name)
        if writes and not any(each in never and value is True for each, value in writes.items()):
            together |= {each: value for each, value in writes.items() if each not in together}
    return together


def _acknowledgements(automaton: Automaton) -> frozenset[str]:
    return frozenset(a.human.acknowledgement for a in automaton.abilities.values() if a.human is not None)


def _may_move(execution: Executor, run: CompiledRun, operations: Iterable[str]) -> tuple[str, ...]:
    """The resources that move in a relaxed plan for each of these operations."""
    automaton = execution.automaton
    moving: Mapping[str, str] = {
        f"{name}.start": ability.resource for name, ability in automaton.abilities.items() if _moves(ability)
    }
    transitions = counted_on(automaton, execution.circumstances)
    found: set[str] = set()
    for name in operations:
        way = RelaxedPlan(automaton, run.state, transitions).towards([automaton.operations[name].goal])
        found |= {moving[each.name] for each in way or () if each.name in moving}
    return tuple(name for name in automaton.resources if name in found)
