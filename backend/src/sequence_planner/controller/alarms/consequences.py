"""What comes of the causes of alarms: which operations wait, and which other alarms follow from one."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.controller.alarms.kinds import LEFT_OUT, NO_PLAN, UNDECIDED, UNSAFE_STATE, Cause
from sequence_planner.controller.recovery.who_can import WhoCan
from sequence_planner.controller.views.wording import title_text
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, PlanStatus, Production
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import variables
from sequence_planner.planning.heuristic.relaxation import reachable
from sequence_planner.planning.problem import Circumstances
from sequence_planner.texts.grammar import folded
from sequence_planner.texts.message import Argument, Item, Message, message, quoted

# What comes of an alarm's cause: which of the active operations wait because of it, as far as that can be told.


class Consequences:
    """Sentences about `execution` as it is now."""

    def __init__(self, execution: Executor, who_can: WhoCan | None = None) -> None:
        self._execution = execution
        self._who_can = who_can
        self._about: tuple[object, ...] = ()
        self._held_up: dict[frozenset[str], frozenset[str]] = {}  # by idle resources, of one plan

    def standstill(self) -> Message:
        """Of what keeps everything from starting; where the mode does so too nothing is added to it."""
        execution = self._execution
        if execution.production is Production.STARTED and execution.mode in {Mode.HOLD, Mode.RESTART}:
            return message("wait.nothing")
        return message("wait.standstill", waiting=self.waiting(execution.active))

    def waiting(self, operations: Collection[str], resource: str | None = None) -> Message:
        """That those of the operations that are active wait, for the resource if there is one, or why none does just
        now.
        """
        execution = self._execution
        of = None if resource is None else execution.automaton.resources[resource]
        what: Argument = "" if of is None else message("wait.for", resource=of)
        if execution.production is not Production.STARTED:
            return message("wait.not-started")
        if execution.operator_plan is not None:
            title = title_text(execution.operator_plan.title)
            return message("wait.errand", title=message("quoted", title=title), what=what)
        if execution.mode is not Mode.AUTOMATIC:
            return message(f"wait.{execution.mode}")
        names = sorted(execution.active.intersection(operations))
        if not names:
            return message("wait.none")
        return message("wait.operations", operations=self._quoted(names), what=what)

    def waiting_for(self, resource: str) -> Message:
        """That those of the active operations wait for a resource which cannot be completed without it."""
        return self.waiting(self.held_up({resource}), resource)

    def without(self, resources: Collection[str]) -> Message:
        """Of resources that cannot be used: what the plan without them leaves out."""
        execution = self._execution
        begun = execution.production is Production.STARTED
        if not begun or not execution.conduct.executes_operations:
            return self.waiting(())
        if not execution.active:
            return self._open(resources) or self.waiting(())
        plan, count = execution.plan, len(resources)
        if plan.status is PlanStatus.NONE:
            return message("wait.no-plan", count=count, rest=self._nobody(resources))
        if plan.status is not PlanStatus.FOLLOWED or plan.answer is None:
            return message("wait.looking", count=count, rest=self._nobody(resources))
        waiting = self.held_up(resources) | execution.active.intersection(plan.answer.left_out)
        return self.waiting(waiting) if waiting else message("wait.goes-on", count=count)

    def _nobody(self, resources: Collection[str]) -> Message:
        """That nobody can do some operations without these, as far as that is known without a plan; others wait."""
        active, lacking = self._execution.active, {} if self._who_can is None else self._who_can.lacking
        beyond = [name for name in sorted(active) if lacking.get(name, frozenset()).intersection(resources)]
        if not beyond:
            return self.waiting(active)
        nobody = message("wait.nobody", operations=self._quoted(beyond), count=len(resources))
        rest = active.difference(beyond)
        return message("sentences", first=nobody, second=self.waiting(rest)) if rest else nobody

    def _quoted(self, names: Iterable[str]) -> list[Item]:
        return quoted(folded(self._execution.automaton.operations[name].title for name in names))

    def _open(self, resources: Collection[str]) -> Message | None:
        """That it is not known whether operations can begin, since values of these resources are not."""
        execution, automaton = self._execution, self._execution.automaton
        unknown = {
            name
            for name, declared in automaton.variables.items()
            if declared.resource in resources and execution.state[name] is None
        }
        idle = execution.conduct.idle_operations(automaton)
        titles = [
            operation.title
            for name, operation in automaton.operations.items()
            if name not in idle
            and evaluate(operation.precondition, execution.state) is None
            and unknown.intersection(_read(automaton, variables(operation.precondition)))
        ]
        return message("wait.open", operations=quoted(folded(titles))) if titles else None

    def held_up(self, resources: Collection[str]) -> frozenset[str]:
        """The active operations that cannot be completed while these resources do nothing.

        Of those in the plan what is left of it counts, of those it leaves out all that could be done; without a plan
        all wait. A relaxation says it, so of one that waits for something more subtle it is not said.
        """
        execution = self._execution
        order = execution.plan.order
        if execution.plan.status is not PlanStatus.FOLLOWED:
            return execution.active
        about = (order.names, len(order.running), execution.active)
        if about != self._about:
            self._about, self._held_up = about, {}
        idle = frozenset(resources)
        if idle not in self._held_up:
            planned, active = order.goals & execution.active, execution.active
            barred = frozenset(execution.automaton.abilities) - set(order.names)
            self._held_up[idle] = self._beyond(idle, planned, barred) | self._beyond(idle, active - planned)
        return self._held_up[idle]

    def _beyond(
        self, idle: frozenset[str], names: Collection[str], barred: frozenset[str] = frozenset()
    ) -> frozenset[str]:
        """Those of the operations whose goals cannot come true without these resources and abilities."""
        execution = self._execution
        if not names:
            return frozenset()
        circumstances = Circumstances(offline=idle, restart=True, barred=barred)
        relaxed = reachable(execution.automaton, execution.state, circumstances)
        return frozenset(name for name in names if not relaxed.may(execution.automaton.operations[name].goal))

    def of_values(self, names: Collection[str]) -> Message:
        """Of values that are wrong or not known: which operations are decided by them."""
        execution = self._execution
        deciding = read_by(execution.automaton, names)
        if not execution.active & deciding:
            return message("wait.undecided")
        return message("wait.decided", operations=self._quoted(sorted(execution.active & deciding)))


def read_by(automaton: Automaton, names: Collection[str]) -> frozenset[str]:
    """The operations whose goals depend on one of the variables."""
    wanted = set(names)
    return frozenset(
        name
        for name, operation in automaton.operations.items()
        if wanted.intersection(_read(automaton, variables(operation.goal)))
    )


def _read(automaton: Automaton, names: Iterable[str]) -> set[str]:
    """The variables, and those that flags among them depend on."""
    found: set[str] = set()
    to_see = list(names)
    while to_see:
        name = to_see.pop()
        if name not in found:
            found.add(name)
            predicate = automaton.flag_predicates.get(name)
            to_see += [] if predicate is None else variables(predicate)
    return found


# What follows from what: a device that fails keeps others from finishing, and leads to states nobody wants.
#
# Which alarm is a part of which is said by the alarms' own causes where they know; this adds what only the model tells:
# what an effect waits for, what a specification speaks of, and which operations need a resource.

_PLANS = (NO_PLAN, LEFT_OUT, UNDECIDED)


class ConsequenceGraph:
    """Of one automaton; `touched` are the variables for which the state is unsafe, if it is."""

    def __init__(self, automaton: Automaton, touched: Callable[[], Collection[str]]) -> None:
        self._automaton = automaton
        self._touched = touched
        self._awaits = _awaits(automaton)

    def trace(self, causes: Iterable[Cause]) -> list[Cause]:
        """The causes, each with all that it follows from."""
        every = list(causes)
        failures = [cause for cause in every if cause.of]
        unsafe = any(cause.kind is UNSAFE_STATE for cause in every)
        return [self._traced(cause, failures, unsafe) for cause in every] if failures or unsafe else every

    def _traced(self, cause: Cause, failures: Iterable[Cause], unsafe: bool) -> Cause:
        others = [failure for failure in failures if failure.key != cause.key]
        if cause.kind is UNSAFE_STATE:
            about = self._resources(self._touched())
            found = [each.key for each in others if each.of & about]
        elif cause.about:
            found = [UNSAFE_STATE.key()] if unsafe and not cause.about.isdisjoint(self._touched()) else []
        elif cause.kind in _PLANS:
            found = [each.key for each in others] + ([UNSAFE_STATE.key()] if unsafe else [])
        elif cause.waits:
            awaited = frozenset[str]().union(*(self._awaits.get(name, frozenset()) for name in cause.of))
            found = [each.key for each in others if each.of & awaited]
        else:
            return cause
        return replace(cause, follows=(*cause.follows, *found)) if found else cause

    def _resources(self, names: Iterable[str]) -> frozenset[str]:
        """Those of the variables, and of what flags among them depend on."""
        found: set[str] = set()
        seen: set[str] = set()
        to_see = list(names)
        while to_see:
            name = to_see.pop()
            if name in seen:
                continue
            seen.add(name)
            if (predicate := self._automaton.flag_predicates.get(name)) is not None:
                to_see += variables(predicate)
            elif (resource := self._automaton.variables[name].resource) is not None:
                found.add(resource)
        return frozenset(found)


def _awaits(automaton: Automaton) -> dict[str, frozenset[str]]:
    """For each resource those of others whose measured values its own effects wait for."""
    found: dict[str, set[str]] = {}
    for effect in automaton.effects:
        if not effect.fault:
            declared = (automaton.variables.get(name) for name in variables(effect.guard))
            of = {each.resource for each in declared if each is not None and each.resource is not None}
            found.setdefault(effect.resource, set()).update(of - {effect.resource})
    return {name: frozenset(others) for name, others in found.items()}
