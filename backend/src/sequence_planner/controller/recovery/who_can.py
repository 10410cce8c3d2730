"""The view of who can do what while devices are silent or something is out of service: told at once, before a plan is
searched for.

It counts on what abilities do, and on what the model says people do by themselves; not on devices that are moved by
hand, which advice proposes.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import partial

import structlog

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.views.station import AbsenceReason, AbsenceView, DoableView, NobodyView, WhoCanView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import ServiceKind
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.types import Value
from sequence_planner.planning.heuristic.still_possible import Absent, Remaining
from sequence_planner.texts.message import Message, message

# It is looked at at once when something else is absent or active, else so seldom that it takes a twentieth of a core.
_SHARE = 20.0
_AT_MOST_EVERY = 1.0  # seconds

LOG = structlog.get_logger(__name__)

Found = tuple[WhoCanView, Mapping[str, frozenset[str]]]
Work = Callable[[], tuple[Found, float]]
Take = Callable[[tuple[Found, float] | None], None]
Run = Callable[[Work, Take], None]


def at_once(work: Work, take: Take) -> None:
    """Wait for it."""
    take(work())


def in_thread(work: Work, take: Take) -> None:
    """In a thread of the running event loop, which goes on meanwhile."""

    async def done() -> None:
        try:
            take(await asyncio.to_thread(work))
        except Exception:
            LOG.exception("who can do what was not found out")
            take(None)

    _RUNNING.add(task := asyncio.get_running_loop().create_task(done()))
    task.add_done_callback(_RUNNING.discard)


_RUNNING: set[asyncio.Task[None]] = set()  # an event loop itself does not keep its tasks


@dataclass(frozen=True)
class _Look:
    """All that an answer depends on, none of which ever changes; `wanted` are the operations that it is about."""

    automaton: Automaton
    state: State
    active: frozenset[str]
    wanted: tuple[str, ...]
    absent: Absent
    silent: frozenset[str]

    def found(self) -> Found:
        """The answer."""
        now = self._remaining(self.absent)
        beyond = [name for name in self.wanted if not self._may(now, name)]
        lacking = self._lacking(beyond) if beyond else {}
        others = [self._doable(now, name) for name in self.wanted if name not in beyond]
        nobody = [
            NobodyView(
                operation=name,
                title=self.automaton.operations[name].title,
                active=name in self.active,
                lacks=[self._title(each) for each in sorted(needed)],
            )
            for name, needed in lacking.items()
        ]
        return WhoCanView(absent=list(self._absences()), nobody=nobody, others=others), lacking

    def _lacking(self, beyond: list[str]) -> dict[str, frozenset[str]]:
        """Of operations that nobody can complete: what has to be there again for each, whatever else is."""
        # What could not be done with everything there is not for the want of anything that is absent.
        whole = self._remaining(Absent())
        lacks: dict[str, set[str]] = {name: set() for name in beyond if self._may(whole, name)}
        for each in self.absent.names if lacks else ():
            alone = self._remaining(self.absent.only(each))
            for name, needed in lacks.items():
                if not self._may(alone, name):
                    needed.add(each)
        return {name: frozenset(needed or self.absent.names) for name, needed in lacks.items()}

    def _remaining(self, absent: Absent) -> Remaining:
        return Remaining(self.automaton, self.state, absent, self.silent & absent.resources)

    def _may(self, remaining: Remaining, name: str) -> bool:
        return remaining.may_complete(self.automaton.operations[name], name in self.active)

    def _doable(self, now: Remaining, name: str) -> DoableView:
        doing = now.doing(self.automaton.operations[name], name in self.active)
        once = {each: value for each, value in doing.once if self.state[each] != value}
        return DoableView(
            operation=name,
            title=self.automaton.operations[name].title,
            active=name in self.active,
            by=[self.automaton.resources[each] for each in doing.by],
            once=once,
            once_message=self._said(once) if once else None,
        )

    def _said(self, values: Mapping[str, Value]) -> Message:
        """That variables have these values, in words."""
        said = sentences_of(self.automaton)
        written = " and ".join(said.write_value(each, value) for each, value in values.items())
        return message("waits.condition", condition=said.tell_values(values.items(), written))

    def _absences(self) -> Iterator[AbsenceView]:
        for of, names in (("resource", self.absent.resources), ("ability", self.absent.abilities)):
            for name in sorted(names):
                why = AbsenceReason.SILENT if name in self.silent else AbsenceReason.OUT_OF_SERVICE
                yield AbsenceView(of=of, name=name, title=self._title(name), why=why)

    def _title(self, name: str) -> str:
        automaton = self.automaton
        return automaton.resources[name] if name in automaton.resources else automaton.abilities[name].title


class WhoCan:
    """Looks at `execution`, with `run` in the place where that may take time; `found` is None while all take part."""

    def __init__(self, execution: Executor, run: Run = at_once, clock: Callable[[], float] = time.thread_time) -> None:
        self._execution = execution
        self._run = run
        self._clock = clock
        self._absent = Absent()
        self._active: frozenset[str] = frozenset()
        self._revision: int | None = None  # of the state that was looked at last
        self._runs = False
        self._next = 0.0  # when it is looked at again, although nothing else is absent or active
        self._took = 0.0  # seconds
        self.found: WhoCanView | None = None
        self.lacking: Mapping[str, frozenset[str]] = {}  # by operation that nobody can complete, what it lacks

    def look(self, untold: Collection[str], monotonic: float) -> None:
        """Find out. The silence of resources in `untold` is too young to be told."""
        execution, conduct = self._execution, self._execution.conduct
        silent = conduct.silent - frozenset(untold)
        abilities = conduct.out_of(ServiceKind.ABILITY) & execution.automaton.abilities.keys()
        absent = Absent(silent | conduct.out_of(ServiceKind.RESOURCE), abilities)
        if not absent.names:
            self._absent, self.found, self.lacking = absent, None, {}
            return
        same = absent == self._absent and execution.active == self._active
        if self._runs or (same and (monotonic < self._next or execution.revision == self._revision)):
            return
        self._absent, self._active, self._revision, self._runs = absent, execution.active, execution.revision, True
        look = _Look(execution.automaton, execution.state, execution.active, tuple(self._wanted()), absent, silent)
        self._run(partial(self._timed, look), partial(self._take, absent))
        self._next = monotonic + max(_AT_MOST_EVERY, _SHARE * self._took)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"who_can": self.found}

    def _timed(self, look: _Look) -> tuple[Found, float]:
        before = self._clock()
        found = look.found()
        return found, self._clock() - before

    def _take(self, absent: Absent, answer: tuple[Found, float] | None) -> None:
        """None where it failed: then it is looked at again."""
        self._runs = False
        if answer is None:
            self._revision = None
        elif absent == self._absent:
            (self.found, self.lacking), self._took = answer

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
                if job is not None and name not in job.completed and name not in job.skipped(automaton):
                    yield name
            elif evaluate(operation.goal, execution.state) is not True:
                yield name
