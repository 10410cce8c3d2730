"""Who can do what while devices are silent or something is out of service: told at once, before a plan is searched for.

It counts on what abilities do, and on what the model says people do by themselves; not on devices that are moved by
hand, which advice proposes.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Mapping

from sequence_planner.control.execution import Execution
from sequence_planner.control.production_commands import ServiceKind
from sequence_planner.control.who_can_view import AbsenceReason, AbsenceView, DoableView, NobodyView, WhoCanView
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.planning.relaxed.remaining import Absent, Remaining

# It is looked at in between ticks: at once when something else is absent, else so seldom that it takes a fiftieth.
_SHARE = 50.0
_AT_MOST_EVERY = 1.0  # seconds


class WhoCan:
    """Looks at `execution`. `found` is None while all that there is takes part."""

    def __init__(self, execution: Execution, clock: Callable[[], float] = time.perf_counter) -> None:
        self._execution = execution
        self._clock = clock
        self._absent = Absent()
        self._about: tuple[object, ...] = ()
        self.found: WhoCanView | None = None
        self.lacking: Mapping[str, frozenset[str]] = {}  # by operation that nobody can complete, what it lacks
        self._next = 0.0  # when it is looked at again, although nothing else is absent

    def look(self, untold: Collection[str], monotonic: float) -> None:
        """Find out. The silence of resources in `untold` is too young to be told."""
        conduct = self._execution.conduct
        resources = (conduct.silent - frozenset(untold)) | conduct.out_of(ServiceKind.RESOURCE)
        absent = Absent(resources, conduct.out_of(ServiceKind.ABILITY) & self._execution.automaton.abilities.keys())
        wanted = tuple(self._wanted())
        about = (wanted, self._execution.active, self._execution.revision)
        if absent == self._absent and (about == self._about or monotonic < self._next):
            return
        before = self._clock()
        self._absent, self._about = absent, about
        if absent.names:
            self.found = self._view(absent, wanted)
        else:
            self.found, self.lacking = None, {}
        self._next = monotonic + max(_AT_MOST_EVERY, _SHARE * (self._clock() - before))

    def _wanted(self) -> Iterator[str]:
        """The operations that are active, and those that are still to come: of jobs under way, or of no job at all."""
        execution, automaton = self._execution, self._execution.automaton
        conduct, jobs = execution.conduct, execution.conduct.jobs
        never = conduct.done | conduct.out_of(ServiceKind.OPERATION)
        for name, operation in automaton.operations.items():
            if name in execution.active:
                yield name
            elif name in never:
                continue
            elif jobs.by_order and name in automaton.job_operations:
                job = jobs.having(name, automaton)
                if job is not None and name not in job.completed:
                    yield name
            elif evaluate(operation.goal, execution.state) is not True:
                yield name

    def _view(self, absent: Absent, wanted: tuple[str, ...]) -> WhoCanView:
        automaton, active = self._execution.automaton, self._execution.active
        now = self._remaining(absent)
        beyond = [name for name in wanted if not self._may(now, name)]
        self.lacking = self._lacking(absent, beyond) if beyond else {}
        return WhoCanView(
            absent=list(self._absences(absent)),
            nobody=[
                NobodyView(
                    operation=name,
                    title=automaton.operations[name].title,
                    active=name in active,
                    lacks=[self._title(each) for each in sorted(needed)],
                )
                for name, needed in self.lacking.items()
            ],
            others=[self._doable(now, name) for name in wanted if name not in beyond],
        )

    def _lacking(self, absent: Absent, beyond: list[str]) -> dict[str, frozenset[str]]:
        """Of operations that nobody can complete: what has to be there again for each, whatever else is."""
        # What could not be done with everything there is not for the want of anything that is absent.
        whole = self._remaining(Absent())
        lacks: dict[str, set[str]] = {name: set() for name in beyond if self._may(whole, name)}
        for each in absent.names if lacks else ():
            alone = self._remaining(absent.only(each))
            for name, needed in lacks.items():
                if not self._may(alone, name):
                    needed.add(each)
        return {name: frozenset(needed or absent.names) for name, needed in lacks.items()}

    def _remaining(self, absent: Absent) -> Remaining:
        execution = self._execution
        return Remaining(execution.automaton, execution.state, absent, execution.conduct.silent & absent.resources)

    def _may(self, remaining: Remaining, name: str) -> bool:
        return remaining.may_complete(self._execution.automaton.operations[name], name in self._execution.active)

    def _doable(self, now: Remaining, name: str) -> DoableView:
        execution, automaton = self._execution, self._execution.automaton
        doing = now.doing(automaton.operations[name], name in execution.active)
        return DoableView(
            operation=name,
            title=automaton.operations[name].title,
            active=name in execution.active,
            by=[automaton.resources[each] for each in doing.by],
            once={each: value for each, value in doing.once if execution.state[each] != value},
        )

    def _absences(self, absent: Absent) -> Iterator[AbsenceView]:
        out = self._execution.conduct.out_of(ServiceKind.RESOURCE)
        for of, names in ((ServiceKind.RESOURCE, absent.resources), (ServiceKind.ABILITY, absent.abilities)):
            for name in sorted(names):
                away = of is ServiceKind.ABILITY or name in out
                why = AbsenceReason.OUT_OF_SERVICE if away else AbsenceReason.SILENT
                yield AbsenceView(of=of, name=name, title=self._title(name), why=why)

    def _title(self, name: str) -> str:
        automaton = self._execution.automaton
        return automaton.resources[name] if name in automaton.resources else automaton.abilities[name].title
