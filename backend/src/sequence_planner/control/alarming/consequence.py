"""What comes of an alarm's cause: which of the active operations wait because of it, as far as that can be told."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.execution import Execution
from sequence_planner.control.vocabulary import Mode, PlanStatus, Production
from sequence_planner.control.who_can import WhoCan
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import variables
from sequence_planner.planning.plan import Circumstances
from sequence_planner.planning.relaxed.relaxation import reachable

_NAMED = 3  # so many are named, and the others counted


class Consequences:
    """Sentences about `execution` as it is now."""

    def __init__(self, execution: Execution, who_can: WhoCan | None = None) -> None:
        self._execution = execution
        self._who_can = who_can
        self._about: tuple[object, ...] = ()
        self._held_up: dict[frozenset[str], frozenset[str]] = {}  # by idle resources, of one plan

    def standstill(self) -> str:
        """Of what keeps everything from starting."""
        return f"Nothing is started. {self.waiting(self._execution.active)}"

    def waiting(self, operations: Collection[str], until: str = "") -> str:
        """That those of the operations that are active wait, or why none does just now."""
        execution = self._execution
        if execution.production is not Production.STARTED:
            return "Production is not started, so nothing waits for it."
        if execution.errand is not None:
            return f"“{execution.errand.title}” waits{until}."
        if execution.mode is not Mode.AUTOMATIC:
            return f"Nothing waits for it as long as the mode is {execution.mode}."
        names = sorted(execution.active.intersection(operations))
        if not names:
            return "No active operation waits for it."
        return f"{listed(self._quoted(names))} {'waits' if len(names) == 1 else 'wait'}{until}."

    def without(self, resources: Collection[str]) -> str:
        """Of resources that cannot be used: what the plan without them leaves out."""
        execution = self._execution
        begun = execution.production is Production.STARTED
        if not begun or not execution.conduct.executes_operations:
            return self.waiting(())
        if not execution.active:
            return self._open(resources) or self.waiting(())
        plan, them = execution.plan, "it" if len(resources) == 1 else "them"
        if plan.status is PlanStatus.NONE:
            return f"There is no plan without {them}. {self._nobody(resources, them)}"
        if plan.status is not PlanStatus.FOLLOWED or plan.answer is None:
            return f"A plan without {them} is being looked for. {self._nobody(resources, them)}"
        waiting = self.held_up(resources) | execution.active.intersection(plan.answer.left_out)
        return self.waiting(waiting) if waiting else f"The work goes on without {them}."

    def _nobody(self, resources: Collection[str], them: str) -> str:
        """That nobody can do some operations without these, as far as that is known without a plan; others wait."""
        active, lacking = self._execution.active, {} if self._who_can is None else self._who_can.lacking
        beyond = [name for name in sorted(active) if lacking.get(name, frozenset()).intersection(resources)]
        if not beyond:
            return self.waiting(active)
        nobody = f"Nobody can do {listed(self._quoted(beyond))} without {them}."
        rest = active.difference(beyond)
        return f"{nobody} {self.waiting(rest)}" if rest else nobody

    def _quoted(self, names: Iterable[str]) -> list[str]:
        return [f"“{self._execution.automaton.operations[name].title}”" for name in names]

    def _open(self, resources: Collection[str]) -> str:
        """That it is not known whether operations can begin, since values of these resources are not."""
        execution, automaton = self._execution, self._execution.automaton
        unknown = {
            name
            for name, declared in automaton.variables.items()
            if declared.resource in resources and execution.state[name] is None
        }
        idle = execution.conduct.idle_operations(automaton)
        titles = [
            f"“{operation.title}”"
            for name, operation in automaton.operations.items()
            if name not in idle
            and evaluate(operation.precondition, execution.state) is None
            and unknown.intersection(_read(automaton, variables(operation.precondition)))
        ]
        return f"Whether {listed(titles)} can begin is not known." if titles else ""

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

    def of_values(self, names: Collection[str]) -> str:
        """Of values that are wrong or not known: which operations are decided by them."""
        execution = self._execution
        deciding = read_by(execution.automaton, names)
        if not execution.active & deciding:
            return "No active operation is decided by it, but plans may be wrong."
        titles = [execution.automaton.operations[name].title for name in sorted(execution.active & deciding)]
        return f"Plans may be wrong, and so may be whether {listed([f'“{title}”' for title in titles])} is reached."


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


def listed(titles: Iterable[str]) -> str:
    """As in `a, b and c`, or with how many others there are."""
    every = list(titles)
    if len(every) > _NAMED + 1:
        every = [*every[:_NAMED], f"{len(every) - _NAMED} more"]
    return " and ".join([", ".join(every[:-1]), every[-1]] if len(every) > 1 else every)
