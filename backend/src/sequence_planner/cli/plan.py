"""`plan`: how the goals of operations would be reached, without a running station."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import typer

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.tick import record_activity, update_operations
from sequence_planner.cli.analysing import supervisor_of
from sequence_planner.cli.loading import usable_model
from sequence_planner.cli.moments import Moment, StateFile, moment, named
from sequence_planner.cli.options import FINDINGS, AnyModel, AsJson, print_json, refuse
from sequence_planner.model.source import ModelError
from sequence_planner.planning.plain import PlainAnswer, plan_transitions
from sequence_planner.planning.plan import PlanAnswer, PlanRequest, Verdict
from sequence_planner.planning.planner import Planner
from sequence_planner.station import require_runnable
from sequence_planner.synthesis.supervision import SynthesisError

Goals = Annotated[
    list[str] | None,
    typer.Argument(metavar="[OPERATION]...", help="Whose goals to reach; else those that are active then."),
]
Deadline = Annotated[
    float, typer.Option(min=0.01, max=86_400, help="Seconds to look for the safe states, and for a plan.")
]


def plan(
    model: AnyModel, goals: Goals = None, state: StateFile = None, deadline: Deadline = 10.0, json: AsJson = False
) -> None:
    """Plan the goals of operations from the initial state, or from that of --state: what `tick --json` prints.

    Of a plan, each tick shows the effects that are expected and the starts. The goals of a plain automaton are goal_1,
    goal_2 and so on; one of them is planned. The exit code is 1 when there is no plan for all of the goals.
    """
    found_model = usable_model(model)
    automaton = found_model.automaton
    before = moment(automaton, state)
    try:
        if found_model.station is not None:
            require_runnable(found_model.station)
        supervisor = supervisor_of(automaton, deadline)
    except (SynthesisError, ModelError) as error:
        refuse(str(error))
    if automaton.one_at_a_time:
        found = _of_plain(automaton, supervisor, before, goals or list(automaton.operations)[:1], deadline, json)
    else:
        found = _of_station(automaton, supervisor, before, goals or [], deadline, json)
    if not found:
        raise typer.Exit(FINDINGS)


def _of_station(
    automaton: Automaton, supervisor: Supervisor, before: Moment, goals: Sequence[str], deadline: float, json: bool
) -> bool:
    chosen = frozenset(named(automaton.operations, goal, "operation").name for goal in goals)
    wanted = chosen or update_operations(automaton, before.state, before.active)
    if not wanted:
        refuse("no operation is active in this state: name one whose goal to plan")
    # What has just become active is, as in step 4 of a tick.
    state = record_activity(automaton, before.state, before.active | wanted)
    request = PlanRequest(state, tuple(sorted(wanted)), deadline)
    answer = Planner(automaton, supervisor).answer(request)
    ticks = () if answer.plan is None else answer.plan.ticks
    if json:
        print_json(
            {
                "verdict": answer.verdict.value,
                "goals": answer.goals,
                "left_out": answer.left_out,
                "ticks": [{"effects": tick.effects, "starts": tick.starts} for tick in ticks],
                "seconds": answer.seconds,
            }
        )
    else:
        for number, tick in enumerate(ticks, 1):
            lines = [*(f"expected  {name}" for name in tick.effects), *(f"start     {name}" for name in tick.starts)]
            for place, line in enumerate(lines or ["nothing"]):
                typer.echo(f"{'' if place else number:>3}  {line}")
        typer.echo(_said(answer))
    return answer.plan is not None and not answer.left_out


def _of_plain(
    automaton: Automaton, supervisor: Supervisor, before: Moment, goals: Sequence[str], deadline: float, json: bool
) -> bool:
    if len(goals) != 1:
        refuse("name one goal of the form `F p`, such as goal_1" if goals else "no goal of it has the form `F p`")
    goal = named(automaton.operations, goals[0], "goal").name
    try:
        answer = plan_transitions(automaton, supervisor, goal, before.state, deadline=deadline)
    except ValueError as error:
        refuse(str(error))
    if json:
        document = {"verdict": answer.verdict.value, "goal": goal, "transitions": answer.transitions}
        print_json({**document, "seconds": answer.seconds})
    else:
        for number, name in enumerate(answer.transitions, 1):
            typer.echo(f"{number:>3}  {name}")
        typer.echo(_verdict(answer, goal, "transitions"))
    return answer.verdict is Verdict.FOUND


def _said(answer: PlanAnswer) -> str:
    said = _verdict(answer, ", ".join(answer.goals or answer.left_out), "ticks")
    return f"{said}; left out: {', '.join(answer.left_out)}" if answer.goals and answer.left_out else said


def _verdict(answer: PlanAnswer | PlainAnswer, goals: str, unit: str) -> str:
    match answer.verdict:
        case Verdict.FOUND:
            return f"planned in {answer.seconds:.2f} s: {goals}"
        case Verdict.NONE_AT_ALL:
            return f"no plan at all, proven: {goals}"
        case Verdict.NONE_UP_TO:
            return f"no plan of up to {answer.searched} {unit}: {goals}"
