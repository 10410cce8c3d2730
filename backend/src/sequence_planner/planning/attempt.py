"""One attempt at a task: what the engines have found so far, and whether it is worth while to wait for more."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import inf

from sequence_planner.immutable import replace
from sequence_planner.planning import troubles
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.engines import Report
from sequence_planner.planning.plan import Contract, Plan, Proof

# For a shorter plan a fast one waits this share of the time it took, in seconds at least and at most.
_SHARE, _LEAST_GRACE, _MOST_GRACE = 0.2, 0.002, 0.1
_PROOF_GRACE = 0.5  # seconds, or as long as it took, for a proof, when it is known that no plan is short enough


class Attempt:
    """Collects reports on `task`; `accepts` says whether a plan is one. Plans that are none are their engines' errors.

    When `share` is spent and there is no plan, the time that is left belongs to fewer goals.
    """

    def __init__(self, task: Task, accepts: Callable[[Plan], bool], share: Budget) -> None:
        self.task = task
        self.share = share
        self.engine = ""  # that has found the plan or the proof
        self.proof: Proof | None = None
        self.exhausted = False  # all that can be reached has been looked at, and there is no plan
        self.troubles: list[str] = []
        self.heard = False  # of an engine that has not failed
        self._accepts = accepts
        self._began = time.monotonic()
        self._grace_ends = inf
        self._plan: Plan | None = None
        self._searched = 0

    @property
    def took(self) -> float:
        """The seconds since it has begun."""
        return time.monotonic() - self._began

    @property
    def plan(self) -> Plan | None:
        """The best plan so far; what is proven of it may have been proven by another engine."""
        plan = self._plan
        if plan is None or plan.minimal_ticks or len(plan.ticks) > self._fewest:
            return plan
        return replace(plan, minimal_ticks=True, minimal_starts=not plan.starts)

    @property
    def searched(self) -> int:
        """The ticks up to which it is proven that there is no plan; with a plan, none has fewer."""
        return self._searched if self._plan is None else min(self._fewest, len(self._plan.ticks))

    @property
    def answered(self) -> bool:
        """Whether what the contract asks for has been found."""
        plan = self.plan
        if plan is None:
            return self.impossible
        return self.task.contract is Contract.FAST or (plan.minimal_ticks and plan.minimal_starts)

    @property
    def impossible(self) -> bool:
        """Whether there is no plan at all."""
        return self.proof is not None or self.exhausted

    @property
    def patience(self) -> float:
        """The seconds for which it is still worth while to wait for another report."""
        plan = self.plan
        if self.impossible or (plan is not None and plan.minimal_ticks and plan.minimal_starts):
            return 0.0
        grace = max(self._grace_ends - time.monotonic(), 0.0)
        return grace if plan is not None else min(grace, self.share.remaining)

    @property
    def _fewest(self) -> int:
        """No plan has fewer ticks than that."""
        return self._searched + 1

    def take(self, report: Report) -> None:
        """Take note of a report."""
        finding = report.finding
        if report.trouble:
            self.troubles.append(f"{report.engine}: {report.trouble}")
        elif finding.plan is not None and not self._accepts(finding.plan):
            troubles.log("the plan %s by %s for %s does not replay", finding.plan, report.engine, self.task)
            self.troubles.append(f"{report.engine}: its plan does not replay on the reference tick")
        elif finding.plan is not None:
            self.heard = True
            self._take_plan(report.engine, finding.plan)
            self._searched = max(self._searched, finding.searched - 1)
        else:
            self.heard = True
            self._searched = max(self._searched, finding.searched)
            if finding.decided and self._plan is None and not self.impossible:
                self.proof, self.exhausted, self.engine = finding.proof, finding.exhausted, report.engine
        self._wait()

    def _take_plan(self, engine: str, plan: Plan) -> None:
        if self.impossible:
            troubles.log("%s has a plan for %s, which %s has proven to have none", engine, self.task, self.engine)
            self.proof, self.exhausted = None, False
        if self._plan is None or _rank(plan) < _rank(self._plan):
            self._plan, self.engine = plan, engine

    def _wait(self) -> None:
        """Say how long what is known now is worth waiting to be bettered."""
        now, took = time.monotonic(), self.took
        if self._grace_ends != inf:
            return
        if self._plan is not None and self.task.contract is Contract.FAST:
            self._grace_ends = now + min(max(_SHARE * took, _LEAST_GRACE), _MOST_GRACE)
        elif self._plan is None and self._searched >= self.task.longest:
            self._grace_ends = now + max(_PROOF_GRACE, took)


def _rank(plan: Plan) -> tuple[int, int, bool, bool]:
    """Fewer ticks are better, then fewer starts, then more that is proven."""
    return len(plan.ticks), len(plan.starts), not plan.minimal_ticks, not plan.minimal_starts
