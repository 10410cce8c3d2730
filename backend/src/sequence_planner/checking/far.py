"""The same questions where the states that are reached are too many to be computed.

Instead of them two sets stand: `runs` that are known lead through fewer, and what is composed of parts has more
(`synthesis.approximation`). A state in the former is reached, one outside the latter is not; of any other it is found
out by going back from it, as far as to a known run, which is then continued, or until nothing leads there. From where a
goal can be brought about is computed within the latter, too. So answers are exact; but a run need not be the shortest.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial

from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.tick import initial_state
from sequence_planner.checking.evidence import Evidence
from sequence_planner.checking.far_inquiry import FarInquiry
from sequence_planner.checking.inquiry import Questions, bits
from sequence_planner.checking.possibility import UNKNOWN, Finding, Possibility, Subject
from sequence_planner.planning.plan import Contract, PlanRequest, PlanTick, goals_of
from sequence_planner.synthesis.effort import MOST_BITS, Effort, TooMuchError
from sequence_planner.synthesis.plant import orders

MOST_EFFORT = 300_000_000  # nodes for all questions, see `synthesis.effort`: half a minute
MOST_FOR_EACH = 60_000_000
_FIRST = 40_000_000  # of these, to begin
_PLANNING = 10.0  # seconds, for a plan that leads through the work of all operations


@dataclass
class FarAnswers:
    """What is not possible, or not known, and what that rests on, for the next time; None if nothing is known."""

    findings: list[Finding]
    evidence: Evidence | None


def from_afar(
    automaton: Automaton,
    subjects: Sequence[Subject],
    safe: StateSet,
    supervisor: Supervisor,
    planning: float = _PLANNING,
    known: Evidence | None = None,
) -> FarAnswers:
    """What is not possible of `subjects` under the `supervisor`, or not known, where too much is reached.

    No more than so many seconds are spent on `planning`: what is not known by a plan is found out otherwise. What is
    `known` of the model before an edit is proven again; where that leaves something open, all is found out anew.
    """
    asked = Questions(automaton, [each for subject in subjects for each in subject.expressions], safe)
    work = partial(_work, automaton, supervisor, planning)
    if known is not None:
        again = _answers(asked, subjects, supervisor, partial(_resumed, asked, work, known))
        if not any(each.kind == UNKNOWN for each in again.findings):
            return again
    return _answers(asked, subjects, supervisor, partial(_anew, asked, work))


def _answers(
    asked: Questions,
    subjects: Sequence[Subject],
    supervisor: Supervisor,
    begin: Callable[[Effort], FarInquiry | None],
) -> FarAnswers:
    whole = Effort(MOST_EFFORT)
    inquiry = begin(whole)
    if inquiry is None:
        return FarAnswers([Finding(UNKNOWN, subject, "") for subject in subjects], None)
    possibility = Possibility(asked.automaton, inquiry)
    found: list[Finding] = []
    for subject in subjects:
        inquiry.effort = Effort(MOST_FOR_EACH, whole=whole)
        try:
            found += list(possibility.findings(subject))
        except TooMuchError:
            found.append(Finding(UNKNOWN, subject, ""))
    return FarAnswers(found, inquiry.evidence(supervisor))


_Work = Callable[[], tuple[PlanTick, ...]]


def _anew(asked: Questions, work: _Work, whole: Effort) -> FarInquiry | None:
    inquiry = begun(asked, whole)
    if inquiry is not None:
        inquiry.know(work())
    return inquiry


def _resumed(asked: Questions, work: _Work, known: Evidence, whole: Effort) -> FarInquiry | None:
    """An inquiry that goes on from what was `known`; None where that is not soon proven again."""
    with suppress(TooMuchError):
        inquiry = FarInquiry(asked, whole, known.ordered(asked.bearing))
        if not inquiry.recall(known):
            inquiry.know(work())
        return inquiry
    return None


def begun(asked: Questions, whole: Effort) -> FarInquiry | None:
    """An inquiry in the first order of variables in which it soon begins, or begins at all."""
    automaton = asked.automaton
    names = sorted(asked.bearing, key=list(automaton.variables).index)
    if bits(automaton, names) > MOST_BITS:
        return None
    for most in (_FIRST, MOST_EFFORT):
        for order in orders(automaton, names):
            inquiry = FarInquiry(asked, Effort(most, whole=whole), order)
            with suppress(TooMuchError):
                inquiry.perhaps_reached()
                inquiry.whole = whole
                return inquiry
    return None


def _work(automaton: Automaton, supervisor: Supervisor, seconds: float) -> tuple[PlanTick, ...]:
    """A plan for the goals of all operations from the initial state, or of as many as one is soon found for."""
    if automaton.one_at_a_time or not automaton.operations:
        return ()
    from sequence_planner.planning.planner import Planner, PlannerError  # noqa: PLC0415 - few models need it

    goals = goals_of(automaton, automaton.operations)
    request = PlanRequest(initial_state(automaton), goals, seconds, contract=Contract.FAST)
    try:
        answer = Planner(automaton, supervisor).answer(request)
    except PlannerError:
        return ()
    return () if answer.plan is None else answer.plan.ticks
