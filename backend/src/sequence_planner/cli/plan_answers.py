"""The planner's answers, for programs and for people."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from sequence_planner.automaton.structure import State
from sequence_planner.expressions.printing import print_value
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.plan import Clause, Goal, PlanAnswer, Proof, Verdict
from sequence_planner.planning.reasons.diagnosis import Diagnosis, correction_text, member_text
from sequence_planner.planning.reasons.initially import FromThese

_STATUS = {
    Verdict.FOUND: "plan",
    Verdict.NONE_AT_ALL: "none",
    Verdict.NONE_UP_TO: "none_up_to",
    Verdict.LATE: "deadline",
}


def document(answer: PlanAnswer, reasons: Sequence[FromThese]) -> dict[str, Any]:
    """An answer about a station as one JSON document."""
    plan = answer.plan
    ticks = () if plan is None else plan.ticks
    minimal = plan is not None and plan.minimal_ticks and plan.minimal_starts
    return {
        "status": _STATUS[answer.verdict],
        "contract": None if plan is None else "minimal" if minimal else "fast",
        "goals": answer.goals,
        "left_out": answer.left_out,
        "undecided": answer.undecided,
        "begin": None,
        "starts": [] if plan is None else [name for _, name in plan.starts],
        "ticks": len(ticks),
        "schedule": [{"effects": tick.effects, "starts": tick.starts} for tick in ticks],
        "searched": answer.searched,
        "proof": _proof(answer.proof),
        **_whys(reasons),
        "engine": answer.engine,
        "seconds": answer.seconds,
    }


def plain_document(answer: PlainAnswer, goals: Iterable[Goal], reasons: Sequence[FromThese]) -> dict[str, Any]:
    """An answer about a plain automaton as one JSON document."""
    found = answer.verdict is Verdict.FOUND
    return {
        "status": _STATUS[answer.verdict],
        "contract": None if not found else "minimal" if answer.minimal else "fast",
        "goals": [goal.name for goal in goals],
        "begin": answer.begin,
        "starts": answer.events,
        "transitions": answer.transitions,
        "ticks": len(answer.transitions),
        "searched": answer.searched,
        "proof": _proof(answer.proof),
        **_whys(reasons),
        "engine": answer.engine,
        "seconds": answer.seconds,
    }


def because(reasons: Sequence[FromThese]) -> Iterator[str]:
    """Why there is no plan at all, line by line; where not for the same reason from all states, of which from which."""
    number = sum(len(each.states) for each in reasons)
    telling = _differing([state for each in reasons for state in each.states])
    for each in reasons:
        if len(reasons) > 1:
            which = values_text({name: each.states[0][name] for name in telling})
            more = "" if len(each.states) == 1 else f" and {len(each.states) - 1} more"
            yield f"of the {number} initial states, from that with {which}{more}:"
        yield from _because(each.diagnosis)


def _because(diagnosis: Diagnosis) -> Iterator[str]:
    reason = diagnosis.reason
    if reason is None:
        yield "why could not be found in time: allow more with --deadline"
        return
    yield "as long as all of these stay as they are"
    yield from (f"      {member_text(member)}" for member in reason.members)
    if not reason.minimal:
        yield "some of them may be needless: which was not found out in time; allow more with --deadline"
    if diagnosis.corrections:
        yield "there would be a plan again with"
        yield from (f"      {correction_text(correction)}" for correction in diagnosis.corrections)


def values_text(state: State) -> str:
    """The values that are known in a state."""
    return ", ".join(f"{name} == {print_value(value)}" for name, value in state.items() if value is not None)


def _differing(states: Sequence[State]) -> list[str]:
    """The variables that do not have the same value in all of them."""
    return [name for name in states[0] if any(state[name] != states[0][name] for state in states)] if states else []


def said(answer: PlanAnswer) -> str:
    """An answer about a station in one line."""
    if answer.plan is None:
        return _none(answer, answer.left_out, "ticks")
    plan = answer.plan
    if not plan.ticks:
        return f"{', '.join(answer.goals)}: nothing to do, all of it holds already{_left_out(answer)}"
    ticks, starts = _number(len(plan.ticks), "tick"), _number(len(plan.starts), "start")
    if plan.minimal_ticks and plan.minimal_starts:
        kind = "the fewest ticks, then the fewest starts"
    elif plan.minimal_ticks:
        kind = "the fewest ticks"
    else:
        kind = f"no plan has fewer than {_number(answer.searched, 'tick')}" if answer.searched > 1 else "found fast"
    return (
        f"{', '.join(answer.goals)}: {ticks} and {starts}, {kind} "
        f"({answer.engine}, {answer.seconds:.2f} s){_left_out(answer)}"
    )


def _left_out(answer: PlanAnswer) -> str:
    if not answer.left_out:
        return ""
    undecided = [name for name in answer.left_out if name in answer.undecided]
    excluded = [name for name in answer.left_out if name not in answer.undecided]
    ruled_out = f"; left out: {', '.join(excluded)}" if excluded else ""
    return f"{ruled_out}; no plan found in time that reaches {', '.join(undecided)} too" if undecided else ruled_out


def said_of_plain(answer: PlainAnswer, goals: Iterable[Goal]) -> str:
    """An answer about a plain automaton in one line."""
    names = [goal.name for goal in goals]
    if answer.verdict is not Verdict.FOUND:
        return _none(answer, names, "transitions")
    if not answer.transitions:
        return f"{', '.join(names)}: nothing to do, all of it holds already"
    if answer.minimal:
        kind = "the fewest"
    else:
        kind = f"no plan has fewer than {answer.searched}" if answer.searched > 1 else "found fast"
    number = _number(len(answer.transitions), "transition")
    return f"{', '.join(names)}: {number}, {kind} ({answer.engine}, {answer.seconds:.2f} s)"


def _none(answer: PlanAnswer | PlainAnswer, goals: Iterable[str], unit: str) -> str:
    names = ", ".join(goals)
    match answer.verdict:
        case Verdict.NONE_AT_ALL:
            return f"no plan at all, proven: {names} ({answer.engine}, {answer.seconds:.2f} s)"
        case Verdict.NONE_UP_TO:
            return f"no plan of up to {answer.searched} {unit}: {names} ({answer.seconds:.2f} s)"
        case _:
            known = f", and no plan of up to {answer.searched} {unit}" if answer.searched > 0 else ""
            return f"no answer in time{known}: {names} ({answer.seconds:.2f} s)"


def _whys(reasons: Sequence[FromThese]) -> dict[str, Any]:
    several = sum(len(each.states) for each in reasons) > 1
    return {
        "why": _why(reasons[0].diagnosis) if reasons else None,
        "initially": [{"states": e.states, "why": _why(e.diagnosis)} for e in reasons] if several else [],
    }


def _why(diagnosis: Diagnosis) -> dict[str, Any]:
    reason = diagnosis.reason
    members = () if reason is None else reason.members
    return {
        "members": [{"part": each.part.value, "name": each.name, "value": each.value} for each in members],
        "minimal": reason is not None and reason.minimal,
        "corrections": [
            [{"name": change.name, "value": change.value} for change in correction.changes]
            for correction in diagnosis.corrections
        ],
    }


def _proof(proof: Proof | None) -> dict[str, Any] | None:
    return None if proof is None else {"by": proof.by, "invariant": [_clause(clause) for clause in proof.invariant]}


def _clause(clause: Clause) -> str:
    """One of these holds in every state."""
    texts = [f"{each.name} {'==' if each.equal else '!='} {print_value(each.value)}" for each in clause]
    return " or ".join(texts) or "false"


def _number(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
