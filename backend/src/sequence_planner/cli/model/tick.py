"""`tick`: execute one reference tick of a station, step by step, or one transition of a plain automaton."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, TypeVar

import typer

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Kind, State, target
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    finish,
    record_activity,
    reverts,
    sense,
    start,
    start_guard_holds,
    synchronise,
    update_operations,
    writes,
)
from sequence_planner.cli.analysing import supervisor_of
from sequence_planner.cli.initial_state import StartingPoint, StateFile, moment, named
from sequence_planner.cli.loading import usable_automaton
from sequence_planner.cli.options import FINDINGS, AnyModel, AsJson, print_json, refuse
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.printer import print_expression, print_value
from sequence_planner.language.syntax import Expression, ExpressionError, conjuncts
from sequence_planner.language.types import Value, contains
from sequence_planner.synthesis.supervisor import SynthesisError

# One reference tick, with an account of each of its six steps.

Changes = Mapping[str, Value | None]


@dataclass(frozen=True)
class TickRequest:
    """The events of a tick: measured values, effects, and the starts that are wanted, in their order."""

    measured: Mapping[str, Value | None] = field(default_factory=dict)
    effects: Sequence[Effect] = ()
    starts: Sequence[Ability] = ()
    restart_mode: bool = False


@dataclass(frozen=True)
class StartTried:
    """A start that was wanted; `waits_for` is empty if it was taken, and `changes` is what it did."""

    ability: str
    waits_for: tuple[str, ...]
    changes: Changes


@dataclass(frozen=True)
class TickTaken:
    """The result of each step of a tick. Changes are the new values."""

    sensed: Changes
    finished: tuple[str, ...]
    conflicts: tuple[tuple[str, str, str], ...]
    finish_changes: Changes
    flags: Changes
    activated: tuple[str, ...]
    completed: tuple[str, ...]
    starts: tuple[StartTried, ...]
    published: Changes
    after: StartingPoint


class EffectRefused(Exception):
    """An effect that cannot happen now; the text says why."""


def take_tick(
    automaton: Automaton, supervisor: Supervisor | None, before: StartingPoint, request: TickRequest
) -> TickTaken:
    """Take one tick from `before`, all of whose outputs have been published. Raises `EffectRefused`.

    Without a `supervisor` starts are kept from nothing but their own guards.
    """
    sensed = _sensed(before.state, request)
    finishing = finish(automaton, sensed)
    state = synchronise(automaton, finishing.state)
    flags = changes(finishing.state, state)
    active = update_operations(automaton, state, before.active)
    state = record_activity(automaton, state, active)
    starts: list[StartTried] = []
    for ability in request.starts:
        waits_for = tuple(_waits_for(automaton, supervisor, before.state, state, ability, request.restart_mode))
        after = state if waits_for else start(automaton, state, ability)
        assert after is not None
        starts.append(StartTried(ability.name, waits_for, changes(state, after)))
        state = after
    return TickTaken(
        sensed=changes(before.state, sensed),
        finished=finishing.finished,
        conflicts=finishing.conflicts,
        finish_changes=changes(sensed, finishing.state),
        flags=flags,
        activated=tuple(sorted(active - before.active)),
        completed=tuple(sorted(before.active - active)),
        starts=tuple(starts),
        published={n: v for n, v in changes(before.state, state).items() if n in automaton.outputs},
        after=StartingPoint(state, active),
    )


def changes(before: State, after: State) -> Changes:
    """The new values of what differs."""
    return {name: value for name, value in after.items() if before[name] != value}


def _sensed(state: State, request: TickRequest) -> State:
    for effect in request.effects:
        if not holds(effect.guard, state):
            raise EffectRefused(f"the effect `{effect.name}` is not enabled: {', '.join(lacking(effect.guard, state))}")
    sensed = apply_effects(state, request.effects)
    if sensed is None:
        raise EffectRefused("these effects cannot happen in one tick: they would write different values to a variable")
    return sense(sensed, request.measured)


def lacking(condition: Expression, state: State) -> Iterable[str]:
    """Say what of a condition does not hold, in words."""
    for part in conjuncts(condition):
        truth = evaluate(part, state)
        if truth is not True:
            yield f"`{print_expression(part)}` is {'unknown' if truth is None else 'false'}"


def _waits_for(
    automaton: Automaton,
    supervisor: Supervisor | None,
    published: State,
    state: State,
    ability: Ability,
    restart_mode: bool,
) -> Iterable[str]:
    if ability.restart and not restart_mode:
        yield "it is for restart mode only (--restart-mode)"
        return
    if not start_guard_holds(ability, state):
        yield from dict.fromkeys((*lacking(ability.enabled, state), *lacking(ability.start_guard, state)))
        return
    after = start(automaton, state, ability)
    if after is None:
        yield "what it would write depends on values that are unknown"
    elif taken := reverts(automaton, published, state, after):
        yield f"{', '.join(sorted(taken))} must be published first"
    elif supervisor is not None and not supervisor.allows(state, after):
        broken = [s.name for s in automaton.specifications.values() if holds(s.forbidden, after)]
        why = "after it a specification could be broken, or rest not be reached any more"
        if broken:
            why = f"specification {', '.join(broken)} forbids the state after it"
        if unknown := [name for name in supervisor.safe.names if state[name] is None]:
            why = f"{', '.join(unknown)} is unknown, and with some value of it a specification could be broken"
        elif not supervisor.safe.includes(state):
            why = "the state is not a safe one"
        yield why


# `tick`: one reference tick of a station, or one transition of a plain automaton.

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
    request = TickRequest(
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
            action = automaton.read_action(text)
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
