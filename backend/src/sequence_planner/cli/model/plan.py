"""`plan`: compute a plan for goals offline, and print it as lanes or JSON, or the reason for its absence."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Annotated, Any

import typer

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import record_activity, update_operations
from sequence_planner.cli.analysing import Limits, read_within, supervisor_of
from sequence_planner.cli.initial_state import StartingPoint, StateFile, moment, named, named_operation
from sequence_planner.cli.options import FINDINGS, AnyModel, AsJson, print_json, refuse
from sequence_planner.export.sequential import ExportError, sequential
from sequence_planner.export.unified import UnifiedPlanning, planners
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.printer import print_value
from sequence_planner.language.syntax import Expression, ExpressionError
from sequence_planner.planning.diagnosis import (
    Diagnosis,
    DiagnosisRequest,
    FromThese,
    correction_text,
    diagnose,
    member_text,
    why_from_each,
)
from sequence_planner.planning.efa_planner import initial_states, plan_transitions
from sequence_planner.planning.goals.monitor import monitor_of
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.planner import InTurn, Planner, PlannerError
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.portfolio.engines import Engines, Lane
from sequence_planner.planning.problem import (
    Circumstances,
    Clause,
    Contract,
    Goal,
    PlanAnswer,
    PlanRequest,
    PlanTick,
    Proof,
    Verdict,
    goal_of,
)
from sequence_planner.planning.single.derived import as_station
from sequence_planner.planning.validation.acceptance import Activity, timeline
from sequence_planner.process.budget import Budget
from sequence_planner.process.gc_tuning import collection_seldom
from sequence_planner.synthesis.supervisor import FewerSpecifications, SynthesisError

# Why there is no plan at all, found out in a process of its own: what it computes with sets cannot be interrupted.

_SHARE = 0.9  # of the time, for the process: it says what it has found before nobody listens any more


def explained(
    automaton: Automaton,
    supervisor: Supervisor,
    states: Sequence[State],
    goals: Goals,
    circumstances: Circumstances,
    limits: Limits,
) -> tuple[FromThese, ...]:
    """Explain why none of `states` leads to `goals`, as far as it is found within `limits`."""
    from sequence_planner.analysis.worker import told  # noqa: PLC0415
    from sequence_planner.process.task import WorkerError  # noqa: PLC0415

    found: list[FromThese] = []
    seconds = limits.left
    try:
        question = (automaton, supervisor, states, goals, circumstances, _SHARE * seconds)
        found.extend(told(limits.memory, seconds, _explaining, *question))
    except (TimeoutError, WorkerError):
        known = [state for each in found for state in each.states]
        if left := tuple(state for state in states if state not in known):
            found.append(FromThese(left, Diagnosis(None, ())))
    return tuple(found)


def _explaining(
    automaton: Automaton,
    supervisor: Supervisor,
    states: Sequence[State],
    goals: Goals,
    circumstances: Circumstances,
    seconds: float,
) -> Iterator[FromThese]:
    fewer = FewerSpecifications(automaton, supervisor)

    def asked(state: State) -> tuple[Automaton, PlanningTask]:
        if automaton.one_at_a_time:
            return as_station(automaton, state, goals)
        return automaton, DiagnosisRequest(state, goals, circumstances).task

    def diagnosed(state: State, budget: Budget) -> Diagnosis:
        model, task = asked(state)
        return diagnose(model, supervisor, fewer, task, budget)

    yield from why_from_each(states, goals, diagnosed, Budget.seconds(seconds))


# Plans for people: time runs down, and each resource has a lane.

_RUNS, _DONE, _EXPECTED = "│", "└ done", "~ "
_GAP = "  "


def lanes(automaton: Automaton, state: State, ticks: Sequence[PlanTick], effects: bool, width: int) -> Iterator[str]:
    """The lines of a plan: in each tick what starts, runs and is done, and with `effects` what is expected before.

    Lanes that do not fit beside each other into `width` columns become one, with the resource before each ability.
    """
    activities = timeline(automaton, state, ticks)
    resource = {name: ability.resource for name, ability in automaton.abilities.items()}
    resource |= {effect.name: effect.resource for effect in automaton.effects}
    cells = [_cells(number, tick, activities, resource, effects) for number, tick in enumerate(ticks, start=1)]
    used = [name for name in automaton.resources if any(name in row for row in cells)]
    rows = [[_short(row.get(name, []), name) for name in used] for row in cells]
    widths = [max(len(name), *(len(text) for row in rows for text in row[lane])) for lane, name in enumerate(used)]
    if sum(widths) + len(_GAP) * len(widths) + 4 > width:
        yield from _one_lane(ticks, activities, effects)
        return
    yield _line("tick", used, widths)
    for number, row in enumerate(rows, start=1):
        for place in range(max(1, *(len(texts) for texts in row)) if row else 1):
            texts = [texts[place] if place < len(texts) else "" for texts in row]
            yield _line("" if place else str(number), texts, widths)


Cells = Mapping[str, list[str]]  # what is written of each resource in one tick


def _cells(
    number: int, tick: PlanTick, activities: Sequence[Activity], resource: Mapping[str, str], effects: bool
) -> Cells:
    cells: dict[str, list[str]] = {}
    for name in tick.effects if effects else ():
        cells.setdefault(resource[name], []).append(f"{_EXPECTED}{name}")
    for each in activities:
        lane = cells.setdefault(resource[each.ability], [])
        if each.started < number and (each.finished is None or number < each.finished):
            lane.append(_RUNS)
        elif each.started < number and each.finished == number:
            lane.append(_DONE)
    for name in tick.starts:
        cells[resource[name]].append(name)
    return {name: texts for name, texts in cells.items() if texts}


def _short(texts: Sequence[str], resource: str) -> list[str]:
    """Without the resource's name, which stands above."""
    return [text.replace(f"{resource}.", "", 1) for text in texts]


def _line(tick: str, texts: Sequence[str], widths: Sequence[int]) -> str:
    padded = (f"{text:<{wide}}" for text, wide in zip(texts, widths, strict=True))
    return _GAP.join((f"{tick:>4}", *padded)).rstrip()


def _one_lane(ticks: Sequence[PlanTick], activities: Sequence[Activity], effects: bool) -> Iterator[str]:
    for number, tick in enumerate(ticks, start=1):
        texts = [f"{_EXPECTED}{name}" for name in tick.effects] if effects else []
        texts += [f"{_DONE} {each.ability}" for each in activities if each.started < number == each.finished]
        texts += tick.starts
        for place, text in enumerate(texts or [_RUNS]):
            yield f"{'' if place else number:>4}{_GAP}{text}"


# The planner's answers, for programs and for people.

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
    """Say why there is no plan at all, line by line; where not for the same reason from all states, of which from
    which.
    """
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
    if proof is None:
        return None
    told: dict[str, Any] = {"by": proof.by, "invariant": [_clause(clause) for clause in proof.invariant]}
    if (conserved := proof.conserved) is not None:
        weights = {
            name: {print_value(value): weight for value, weight in each.items()}
            for name, each in conserved.weights.items()
        }
        told["sum"] = {"weights": weights, "total": conserved.total, "modulus": conserved.modulus or None}
    return told


def _clause(clause: Clause) -> str:
    """One of these holds in every state."""
    texts = [f"{each.name} {'==' if each.equal else '!='} {print_value(each.value)}" for each in clause]
    return " or ".join(texts) or "false"


def _number(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


# `plan`: how goals would be reached, without a running station.

Operations = Annotated[
    list[str] | None,
    typer.Argument(metavar="[OPERATION]...", help="Whose goals to reach; without any goal, those active then."),
]
GoalTexts = Annotated[
    list[str] | None, typer.Option("--goal", metavar="EXPR", help="A predicate to reach as well. Repeatable.")
]
Wanted = Annotated[Contract, typer.Option("--contract", help="The fewest ticks and starts, proven; or a plan soon.")]
Deadline = Annotated[
    float, typer.Option(min=0.01, max=86_400, help="Seconds that it may take, from reading the model on.")
]
Restart = Annotated[bool, typer.Option("--restart", help="Restart abilities may start, too.")]
Offline = Annotated[
    list[str] | None, typer.Option("--offline", metavar="RESOURCE", help="A resource that does nothing. Repeatable.")
]
Without = Annotated[
    list[str] | None, typer.Option("--without", metavar="ABILITY", help="An ability that does not start. Repeatable.")
]
Avoid = Annotated[
    list[str] | None, typer.Option("--avoid", metavar="EXPR", help="What must not hold on the way. Repeatable.")
]
With = Annotated[
    str | None,
    typer.Option("--with", metavar="PLANNER", help="Ask a planner of unified-planning, such as fast-downward."),
]
Expected = Annotated[bool, typer.Option("--expected", help="Show what devices and people are expected to do, too.")]


@collection_seldom()
def plan(
    model: AnyModel,
    operations: Operations = None,
    goal: GoalTexts = None,
    state: StateFile = None,
    contract: Wanted = Contract.MINIMAL,
    deadline: Deadline = 10.0,
    restart: Restart = False,
    offline: Offline = None,
    without: Without = None,
    avoid: Avoid = None,
    expected: Expected = False,
    other: With = None,
    json: AsJson = False,
) -> None:
    """Plan the goals of operations from the initial state, or from that of --state: what `tick --json` prints.

    Time runs down, and each resource has a lane. The goals of a plain automaton are goal_1, goal_2 and so on, or else
    all of them. The exit code is 1 when there is no plan for all of the goals.
    """
    limits = Limits(deadline)
    automaton = read_within(model, limits)
    before = moment(automaton, state)
    circumstances = _circumstances(automaton, offline or [], restart, avoid or [], without or [])
    start, goals = _asked(automaton, before, operations or [], goal or [])
    try:
        supervisor = supervisor_of(automaton, limits)
    except SynthesisError as error:
        refuse(str(error))
    wanted = contract if other is None else Contract.FAST
    request = PlanRequest(start, goals, limits.left, contract=wanted, circumstances=circumstances)
    if not automaton.one_at_a_time:
        found = _of_station(automaton, supervisor, request, other, expected, json, limits)
    elif other is None:
        found = _of_plain(automaton, supervisor, request, state is not None, json, limits)
    else:
        refuse("--with is for stations: have a plain automaton planned elsewhere with `export --to pddl`")
    if not found:
        raise typer.Exit(FINDINGS)


def _of_station(
    automaton: Automaton,
    supervisor: Supervisor,
    request: PlanRequest,
    other: str | None,
    expected: bool,
    json: bool,
    limits: Limits,
) -> bool:
    try:
        if other is not None:
            sequential(automaton, supervisor, request.state, request.goals, request.circumstances)
        answer = _planner(automaton, supervisor, other).answer(request)
    except (PlannerError, ExportError) as error:
        refuse(str(error))
    reasons = _reasons(automaton, supervisor, [request.state], request, answer, limits)
    if json:
        print_json(document(answer, reasons))
        return answer.plan is not None and not answer.left_out
    if answer.plan is not None and answer.plan.ticks:
        width = shutil.get_terminal_size().columns
        for line in lanes(automaton, request.state, answer.plan.ticks, expected, width):
            typer.echo(line)
    typer.echo(said(answer))
    for line in because(reasons):
        typer.echo(line)
    return answer.plan is not None and not answer.left_out


def _planner(automaton: Automaton, supervisor: Supervisor, other: str | None) -> Planner:
    """Our own engines in turn, or the `other` planner alone."""
    if other is None:
        return Planner(automaton, supervisor)
    if not (known := planners()):
        refuse(f"{other} needs the libraries of the extra `pddl`: run `pip install .[pddl]` in `backend`")
    if other not in known:
        refuse(f"there is no planner `{other}`{suggestion(other, known)}; there are {', '.join(known)}")
    lane = Lane(other, dict.fromkeys(Contract, (other,)))
    engines = Engines(automaton, supervisor, lane, {other: partial(UnifiedPlanning, name=other)})
    return Planner(automaton, supervisor, InTurn(engines))


def _of_plain(
    automaton: Automaton, supervisor: Supervisor, request: PlanRequest, begins: bool, json: bool, limits: Limits
) -> bool:
    """Plan from the state of the request where it `begins` there, or else from the best initial state."""
    if request.circumstances != Circumstances():
        what = "--offline, --without, --restart and --avoid"
        refuse(f"a plain automaton has no resources, modes or ticks: {what} are for stations")
    budget = Budget.seconds(request.deadline)
    try:
        start = request.state if begins else None
        answer = plan_transitions(automaton, supervisor, request.goals, start, request.contract, budget=budget)
    except ValueError as error:
        refuse(str(error))
    states = [request.state] if begins else initial_states(automaton)
    reasons = _reasons(automaton, supervisor, states, request, answer, limits)
    if json:
        print_json(plain_document(answer, request.goals, reasons))
        return answer.verdict is Verdict.FOUND
    if answer.begin is not None:
        typer.echo(f"      begins with {values_text(answer.begin)}")
    for number, name in enumerate(answer.transitions, 1):
        typer.echo(f"{number:>4}  {name}")
    for line in (said_of_plain(answer, request.goals), *because(reasons)):
        typer.echo(line)
    return answer.verdict is Verdict.FOUND


def _reasons(
    automaton: Automaton,
    supervisor: Supervisor,
    states: Sequence[State],
    request: PlanRequest,
    answer: PlanAnswer | PlainAnswer,
    limits: Limits,
) -> tuple[FromThese, ...]:
    """Find why there is no plan at all, in the time that is left."""
    if answer.verdict is not Verdict.NONE_AT_ALL:
        return ()
    return explained(automaton, supervisor, states, request.goals, request.circumstances, limits)


def _circumstances(
    automaton: Automaton, offline: Sequence[str], restart: bool, avoid: Sequence[str], without: Sequence[str]
) -> Circumstances:
    for name in offline:
        named(automaton.resources, name, "resource")
    for name in without:
        named(automaton.abilities, name, "ability")
    conditions = tuple(_predicate(automaton, text, "--avoid") for text in avoid)
    return Circumstances(frozenset(offline), restart, conditions, frozenset(without))


def _asked(
    automaton: Automaton, before: StartingPoint, operations: Sequence[str], texts: Sequence[str]
) -> tuple[State, tuple[Goal, ...]]:
    """The state to plan from, and the goals. What is planned for has just become active, as in step 4 of a tick."""
    chosen = frozenset(named_operation(automaton, name) for name in operations)
    if not chosen and not texts:
        chosen = _active(automaton, before)
    state = record_activity(automaton, before.state, before.active | chosen)
    goals: list[Goal] = []
    for name in sorted(chosen):
        goal = goal_of(automaton.operations[name])
        # The state at its activation is the first position of its formula.
        goals.append(replace(goal, at=monitor_of(goal.local).step(goal.at, state)))
    goals += (Goal(text, _predicate(automaton, text, "--goal")) for text in texts)
    return state, tuple(goals)


def _active(automaton: Automaton, before: StartingPoint) -> frozenset[str]:
    if automaton.one_at_a_time:
        if not automaton.operations:
            refuse("no goal of it has the form `F p`: give a --goal")
        return frozenset(automaton.operations)
    wanted = update_operations(automaton, before.state, before.active)
    if not wanted:
        refuse("no operation is active in this state: name one whose goal to plan, or give a --goal")
    return wanted


def _predicate(automaton: Automaton, text: str, option: str) -> Expression:
    try:
        return automaton.read_condition(text)
    except ExpressionError as error:
        refuse(f"{option} {text!r}: {error.message}")
