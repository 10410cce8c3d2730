"""`tick`: one reference tick of a station, or one transition of a plain automaton."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, TypeVar

import typer

from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, Kind, State, target
from sequence_planner.automaton.tick import writes
from sequence_planner.cli.analysing import supervisor_of
from sequence_planner.cli.loading import usable_automaton
from sequence_planner.cli.moments import StateFile, moment, named
from sequence_planner.cli.options import FINDINGS, AnyModel, AsJson, print_json, refuse
from sequence_planner.cli.ticking import Changes, EffectRefused, Request, TickTaken, changes, lacking, take_tick
from sequence_planner.expressions.parser import parse_assignment
from sequence_planner.expressions.printing import print_value
from sequence_planner.expressions.resolution import Scope, resolve_assignment, suggestion
from sequence_planner.expressions.syntax import ExpressionError
from sequence_planner.expressions.types import Value, contains
from sequence_planner.synthesis.supervision import SynthesisError

T = TypeVar("T")
Sets = Annotated[
    list[str] | None, typer.Option("--set", help='A measured value, such as "robot.pose := home". Repeatable.')
]
Unknowns = Annotated[
    list[str] | None, typer.Option("--unknown", help="A measured variable whose topic has gone silent. Repeatable.")
]
Effects = Annotated[list[str] | None, typer.Option("--effect", help="An expected effect that happens. Repeatable.")]
Starts = Annotated[
    list[str] | None,
    typer.Option("--start", help="An ability to start, in this order; the event of a plain automaton. Repeatable."),
]
RestartMode = Annotated[bool, typer.Option("--restart-mode", help="Restart abilities may start, too.")]
Unsupervised = Annotated[bool, typer.Option("--unsupervised", help="Start also what the supervisor forbids.")]


def tick(
    model: AnyModel,
    state: StateFile = None,
    sets: Sets = None,
    unknown: Unknowns = None,
    effects: Effects = None,
    starts: Starts = None,
    restart_mode: RestartMode = False,
    unsupervised: Unsupervised = False,
    json: AsJson = False,
) -> None:
    """Take one tick of the reference interpreter, and say what each of its steps did.

    It begins in the initial state, or in that of --state: what --json prints, so that ticks can be piped into each
    other. There a value that is unknown is null, and variables that are left out have their initial value. The exit
    code is 1 when a start that was asked for was not taken, or finishes are in conflict.
    """
    automaton = usable_automaton(model)
    before = moment(automaton, state)
    if automaton.one_at_a_time:
        if sets or unknown or effects or len(starts or ()) != 1:
            refuse("a plain automaton takes one transition at a time: give one event with --start, and nothing else")
        _plain(automaton, before.state, (starts or [""])[0], unsupervised, json)
        return
    request = Request(
        {**_measured(automaton, before.state, sets or ()), **_forgotten(automaton, unknown or ())},
        [named({effect.name: effect for effect in automaton.effects}, name, "effect") for name in effects or ()],
        [named(automaton.abilities, name, "ability") for name in starts or ()],
        restart_mode,
    )
    try:
        taken = take_tick(automaton, _supervisor(automaton, bool(starts) and not unsupervised), before, request)
    except EffectRefused as error:
        refuse(str(error))
    if json:
        print_json(_document(taken))
    else:
        _say(taken)
    if taken.conflicts or any(tried.waits_for for tried in taken.starts):
        raise typer.Exit(FINDINGS)


def _supervisor(automaton: Automaton, needed: bool) -> Supervisor | None:
    try:
        return supervisor_of(automaton) if needed else None
    except SynthesisError as error:
        typer.echo(f"starts are not supervised here: {error}", err=True)
        return None


def _measured(automaton: Automaton, state: State, texts: Iterable[str]) -> dict[str, Value | None]:
    measured: dict[str, Value | None] = {}
    for text in texts:
        try:
            action = resolve_assignment(parse_assignment(text), Scope(automaton.types))
        except ExpressionError as error:
            refuse(f"--set {text!r}: {error.message}")
        name = target(action)
        _require_measured(automaton, name)
        value = (writes([action], state) or {}).get(name)
        if value is None or not contains(automaton.types[name], value):
            refuse(f"--set {text!r} gives `{name}` no value of {automaton.types[name]} here")
        measured[name] = value
    return measured


def _forgotten(automaton: Automaton, names: Iterable[str]) -> dict[str, Value | None]:
    for name in names:
        _require_measured(automaton, name)
    return dict.fromkeys(names)


def _require_measured(automaton: Automaton, name: str) -> None:
    measured = automaton.names(Kind.MEASURED)
    if name not in measured:
        kind = automaton.variables[name].kind.value if name in automaton.variables else "no"
        refuse(f"messages set measured variables, and `{name}` is {kind} variable{suggestion(name, measured)}")


def _plain(automaton: Automaton, state: State, event: str, unsupervised: bool, json: bool) -> None:
    """Take the first transition of an event that is enabled, and that the supervisor allows."""
    known = plain_transitions(automaton)
    transitions = [t for name, t in known.items() if event in (name, event_of(name))]
    if not transitions:
        refuse(f"there is no event `{event}`{suggestion(event, map(event_of, known))}")
    enabled = [(t, s) for t in transitions if (s := step(state, t)) is not None]
    controlled = any(t.controllable for t, _ in enabled)
    supervisor = _supervisor(automaton, controlled and not unsupervised)
    allowed = [(t, s) for t, s in enabled if not t.controllable or supervisor is None or supervisor.allows(state, s)]
    taken, after = allowed[0] if allowed else (None, state)
    waits_for = [] if enabled else [reason for t in transitions for reason in lacking(t.guard, state)]
    if enabled and not allowed:
        waits_for = ["it leads out of the safe states, and the supervisor forbids that (--unsupervised takes it)"]
    changed = changes(state, after)
    if json:
        name = None if taken is None else taken.name
        print_json({"transition": name, "waits_for": waits_for, "changes": changed, "state": dict(after)})
    else:
        refused = f"{event} {'waits' if enabled else 'is not enabled'}: {', '.join(waits_for)}"
        typer.echo(f"{event}: {_changes(changed)}" if taken else refused)
    if taken is None:
        raise typer.Exit(FINDINGS)


def _document(taken: TickTaken) -> dict[str, Any]:
    return {
        "sensed": taken.sensed,
        "finished": {
            "abilities": taken.finished,
            "conflicts": [{"abilities": [one, other], "variable": name} for one, other, name in taken.conflicts],
            "changes": taken.finish_changes,
        },
        "flags": taken.flags,
        "operations": {"activated": taken.activated, "completed": taken.completed},
        "starts": [
            {"ability": each.ability, "taken": not each.waits_for, "waits_for": each.waits_for, "changes": each.changes}
            for each in taken.starts
        ],
        "published": taken.published,
        "state": dict(taken.after.state),
        "active": sorted(taken.after.active),
    }


def _say(taken: TickTaken) -> None:
    typer.echo(f"1 sense        {_changes(taken.sensed)}")
    finished = f"{', '.join(taken.finished)}: {_changes(taken.finish_changes)}" if taken.finished else "none"
    typer.echo(f"2 finish       {finished}")
    for one, other, name in taken.conflicts:
        typer.echo(f"               {one} and {other} would write different values to {name}: neither is applied")
    typer.echo(f"3 synchronise  {_changes(taken.flags)}")
    operations = [*(f"{name} active" for name in taken.activated), *(f"{name} completed" for name in taken.completed)]
    typer.echo(f"4 operations   {', '.join(operations) or 'no change'}")
    typer.echo(f"5 start        {'' if taken.starts else 'none'}".rstrip())
    for tried in taken.starts:
        outcome = f"waits, as {' and '.join(tried.waits_for)}" if tried.waits_for else _changes(tried.changes)
        typer.echo(f"               {tried.ability}: {outcome}")
    typer.echo(f"6 act          {_changes(taken.published)}")


def _changes(changed: Changes) -> str:
    texts = [f"{name} := {'?' if value is None else print_value(value)}" for name, value in changed.items()]
    return ", ".join(texts) or "no change"
