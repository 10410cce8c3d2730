"""`plan`: how goals would be reached, without a running station."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Annotated

import typer

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.tick import record_activity, update_operations
from sequence_planner.cli.analysing import Limits, read_within, supervisor_of
from sequence_planner.cli.explaining import explained
from sequence_planner.cli.lanes import lanes
from sequence_planner.cli.moments import Moment, StateFile, moment, named
from sequence_planner.cli.options import FINDINGS, AnyModel, AsJson, print_json, refuse
from sequence_planner.cli.plan_answers import because, document, plain_document, said, said_of_plain, values_text
from sequence_planner.collection import collection_seldom
from sequence_planner.exporting.sequential import ExportError
from sequence_planner.exporting.ticks import sequential
from sequence_planner.exporting.unified import UnifiedPlanning, planners
from sequence_planner.expressions.parser import parse
from sequence_planner.expressions.resolution import Scope, resolve_predicate, suggestion
from sequence_planner.expressions.syntax import Expression, ExpressionError
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engines import Engines, Lane
from sequence_planner.planning.goals.monitor import monitor_of
from sequence_planner.planning.initial_states import initial_states
from sequence_planner.planning.plain import plan_transitions
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.plan import (
    Circumstances,
    Contract,
    Goal,
    PlanAnswer,
    PlanRequest,
    Verdict,
    goal_of,
)
from sequence_planner.planning.planner import InTurn, Planner, PlannerError
from sequence_planner.planning.reasons.initially import FromThese
from sequence_planner.synthesis.supervision import SynthesisError

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
    try:
        supervisor = supervisor_of(automaton, limits)
    except SynthesisError as error:
        refuse(str(error))
    circumstances = _circumstances(automaton, offline or [], restart, avoid or [], without or [])
    start, goals = _asked(automaton, before, operations or [], goal or [])
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
    """Why there is no plan at all, in the time that is left."""
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
    automaton: Automaton, before: Moment, operations: Sequence[str], texts: Sequence[str]
) -> tuple[State, tuple[Goal, ...]]:
    """The state to plan from, and the goals. What is planned for has just become active, as in step 4 of a tick."""
    chosen = frozenset(named(automaton.operations, name, "operation").name for name in operations)
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


def _active(automaton: Automaton, before: Moment) -> frozenset[str]:
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
        return resolve_predicate(parse(text), Scope(automaton.types))
    except ExpressionError as error:
        refuse(f"{option} {text!r}: {error.message}")
