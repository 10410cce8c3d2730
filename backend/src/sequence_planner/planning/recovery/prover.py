"""Plans, and proofs that there are none, for one question after the other about a station that has just stopped.

The questions are alike: neighbours of one state, with and without restart abilities. So what was learnt from one is
looked at first: a plan that only needs repair, or a proof whose invariant holds in the next state too.
"""

from __future__ import annotations

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import finish, initial_state, synchronise, update_operations
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.planning.heuristic.relaxation import reachable, unreached
from sequence_planner.planning.pdr.proof_clauses import asserted, satisfies
from sequence_planner.planning.plan_cache import PlanCache
from sequence_planner.planning.planner import PlanningAttempt
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.portfolio.engines import EngineReport, Engines, Lane
from sequence_planner.planning.problem import ORDINARY, Contract, Plan, Proof, goals_of
from sequence_planner.planning.repair import NAME as REPAIR
from sequence_planner.planning.repair import Repair
from sequence_planner.planning.validation.acceptance import Acceptance, tightened
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget

# On stations the search is the fastest by far: 0.02 s for most plans of the truck engine station.
_ENGINES = ("search", "projection", "pdr", "goal by goal", "bmc")
_TURN = 0.15  # seconds at most for an engine before the next has its turn; in each further round twice as many
LANE = Lane("advice", {Contract.FAST: _ENGINES}, first_turns=dict.fromkeys(_ENGINES, _TURN))

_PREPARING = 5.0  # seconds
_MORE = 0.5  # of the time, for the plan that may be one here too
_MOST_PROOFS = 30
_NOTHING_TO_DO = Plan((), minimal_ticks=True, minimal_starts=True)


class ProofFinding(Immutable):
    """An accepted plan, or that there is none at all, or neither."""

    plan: Plan | None = None
    refuted: bool = False

    @property
    def decided(self) -> bool:
        """True if there is nothing more to find out."""
        return self.plan is not None or self.refuted


class _Refuted(Immutable):
    task: PlanningTask
    unknown: frozenset[str]
    proof: Proof


class Prover:
    """Answers questions about one automaton under one supervisor; no engine works longer than its budget."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, more: Prover | None = None) -> None:
        """`more` answers about the same station, with effects that may not happen here, and is warm already."""
        self.automaton = automaton
        self.supervisor = supervisor
        self._more = more
        self._engines = Engines(automaton, supervisor, LANE)
        self._acceptance = Acceptance.of(automaton, supervisor)
        self._recollection = PlanCache(automaton)
        self._repair = Repair(automaton, self._acceptance, self._recollection)
        self._refuted: list[_Refuted] = []

    @property
    def counting(self) -> Prover:
        """The one that counts on all effects."""
        return self if self._more is None else self._more

    def prepare(self) -> None:
        """Make the engines before there is a question."""
        self._engines.prepare()
        state = initial_state(self.automaton)
        active = update_operations(self.automaton, state, frozenset())
        goals = missing(goals_of(self.automaton, sorted(active)), state)
        if self.is_safe(state):
            self.find(PlanningTask(state, goals, ORDINARY, Contract.FAST), Budget.seconds(_PREPARING))

    def is_safe(self, state: State) -> bool:
        """Return whether the state is certainly in the safe set."""
        return self.supervisor.safe.includes(state)

    def is_safe_when_seen(self, state: State) -> bool:
        """Return the same of a state in which devices say something new: the tick that hears it takes in at once what
        has finished by that.
        """
        if self.is_safe(state):
            return True
        finishing = finish(self.automaton, state)
        return bool(finishing.finished) and self.is_safe(synchronise(self.automaton, finishing.state))

    def is_refuted(self, task: PlanningTask) -> bool:
        """Return whether what is known already says that there is no plan."""
        unknown = _unknown(task.state)
        return any(each.unknown == unknown and _covers(each, task) for each in self._refuted)

    def find(self, task: PlanningTask, budget: Budget) -> ProofFinding:
        """A fast plan for a task whose state is safe and synchronised, or that there is none."""
        if not task.goals:
            return ProofFinding(_NOTHING_TO_DO)
        if self.is_refuted(task):
            return ProofFinding(refuted=True)
        attempt = PlanningAttempt(task, lambda plan: self.accepts(task, plan), budget)
        if (known := self._recollection.plan(task)) is not None:
            return ProofFinding(known)
        if self._more is not None:
            found = self._more.find(task, budget.part(_MORE))
            if found.refuted or (found.plan is not None and self.accepts(task, found.plan)):
                return found
        if (repaired := self._repair.finding(task)) is not None:
            attempt.take(EngineReport(REPAIR, repaired))
        if not attempt.answered and not self._relaxes(task):
            return ProofFinding(refuted=True)
        if not attempt.answered:
            for report in self._engines.work(task, budget, lambda: attempt.patience):
                attempt.take(report)
                if attempt.answered or budget.spent:
                    break
        if attempt.proof is not None:
            self._keep(task, attempt.proof)
        return ProofFinding(attempt.plan, attempt.plan is None and attempt.proof is not None)

    def _relaxes(self, task: PlanningTask) -> bool:
        """Return whether the delete relaxation leaves the goals possible; else it is a proof, which is kept.

        Mostly there is a plan as long as nothing is missing, and that is found sooner.
        """
        circumstances = task.circumstances
        hindered = circumstances.offline or circumstances.barred or _unknown(task.state)
        if not hindered and not self._refuted and self._more is None:
            return True
        relaxed = reachable(self.automaton, task.state, circumstances, self.supervisor)
        if all(relaxed.may(goal.predicate) for goal in task.goals):
            return True
        self._keep(task, unreached(self.automaton, relaxed))
        return False

    def tightened(self, task: PlanningTask, plan: Plan, budget: Budget) -> Plan:
        """The plan with its starts as early as there is time for."""
        course = tightened(self._acceptance, task, plan, budget)
        return plan if course is None else course.plan

    def accepts(self, task: PlanningTask, plan: Plan) -> bool:
        """Return whether a plan replays on the reference tick; one that does is known from now on."""
        course = self._acceptance.course(task, plan)
        if course is None:
            return False
        self._recollection.keep_plan(task, course.plan, course.ends)
        self._repair.keep(task, course)
        return True

    def _keep(self, task: PlanningTask, proof: Proof) -> None:
        self._refuted.insert(0, _Refuted(task, _unknown(task.state), proof))
        del self._refuted[_MOST_PROOFS:]


def _covers(refuted: _Refuted, task: PlanningTask) -> bool:
    """Return whether a proof is one for `task` too: it asks for no less, no more may happen, and the invariant holds at
    first.

    The proof says nothing of where the automata of formulas are, but by its clauses.
    """
    done, wanted = refuted.task, {replace(goal, at=0): goal for goal in task.goals}
    same = [wanted.get(replace(goal, at=0)) for goal in done.goals]
    then, now = done.circumstances, task.circumstances
    return (
        None not in same
        and then.avoid == now.avoid
        and (then.restart or not now.restart)
        and then.offline <= now.offline
        and then.barred <= now.barred
        and satisfies(asserted(task.state, tuple(goal for goal in same if goal is not None)), refuted.proof)
    )


def _unknown(state: State) -> frozenset[str]:
    return frozenset(name for name, value in state.items() if value is None)
