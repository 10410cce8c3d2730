"""The reasons why there is no supervisor: what devices can do from an initial state on, or why rest cannot be
reached.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.automaton.automaton import State
from sequence_planner.language.printer import print_value
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.reachability import Tracer, reaching
from sequence_planner.synthesis.traces import Trace
from sequence_planner.synthesis.transition_relation import Plant
from sequence_planner.texts.message import Message, message


@dataclass(frozen=True)
class Unmeetable:
    """A statement of what is wrong and what to do, and lines that tell the `trace`, if one was found in reasonable
    time.
    """

    message: Message
    lines: tuple[str, ...]
    trace: Trace | None


def why_unmeetable(plant: Plant, forbidden: Mapping[str, Function]) -> Unmeetable:
    """Return why not all initial states of `plant` are safe, given what each specification forbids.

    First a way into a forbidden state without any start is looked for. If there is none, rest cannot be reached.
    """
    broken = plant.diagrams.disjunction(forbidden.values())
    doomed = reaching(plant.diagrams, broken, plant.uncontrollable)
    if (plant.initial & doomed).satisfiable():
        return _into_the_forbidden(plant, forbidden, broken)
    return _without_rest(plant, forbidden, doomed)


def _into_the_forbidden(plant: Plant, forbidden: Mapping[str, Function], broken: Function) -> Unmeetable:
    trace = Tracer(plant, starts=False).shortest(broken)
    if trace is None:
        names = ", ".join(name for name, where in forbidden.items() if _may_come_about(plant, where))
        return Unmeetable(message("found.unmet.devices", specifications=names), (), None)
    last = plant.diagrams.states(trace.last)
    names = ", ".join(name for name, where in forbidden.items() if (where & last).satisfiable())
    lines = [step.line(number, names=False) for number, step in enumerate(trace.steps, start=1)]
    if not trace.steps:
        which = "found.unmet.initial" if plant.automaton.initial is None else "found.unmet.an-initial"
        return Unmeetable(message(which, specifications=names, values=_values(plant, trace.last)), (), trace)
    return Unmeetable(
        message("found.unmet.no-start", specifications=names),
        (*lines, f"violated with {_values(plant, trace.last)}"),
        trace,
    )


def _may_come_about(plant: Plant, where: Function) -> bool:
    return (plant.initial & reaching(plant.diagrams, where, plant.uncontrollable)).satisfiable()


def _without_rest(plant: Plant, forbidden: Mapping[str, Function], unsafe: Function) -> Unmeetable:
    """The way that the devices can go to where rest is out of reach, and how rest could be reached from there."""
    diagrams = plant.diagrams
    counted_on = [*plant.helpful, *plant.all_starts]
    while True:
        inside = diagrams.valid & ~unsafe
        stuck = inside & ~reaching(diagrams, plant.rest & inside, counted_on, inside)
        following = reaching(diagrams, unsafe | stuck, plant.uncontrollable)
        if (plant.initial & following).satisfiable():
            break
        unsafe = following
    trace = Tracer(plant, starts=False).shortest(stuck)
    if trace is None:
        return Unmeetable(_headline(plant, False), (), None)
    anyhow = reaching(diagrams, plant.rest, counted_on)
    if not (diagrams.states(trace.last) & anyhow).satisfiable():
        id_ = "found.rest.anyhow-plain" if plant.automaton.one_at_a_time else "found.rest.anyhow"
        return Unmeetable(message(id_, what=_headline(plant, bool(trace.steps))), tuple(trace.lines()), trace)
    further = Tracer(plant, faults=False).onward(trace, plant.rest)
    if further is None:
        return Unmeetable(_headline(plant, bool(trace.steps)), tuple(trace.lines()), trace)
    rest = message("found.rest.marked" if plant.automaton.one_at_a_time else "found.rest.rest")
    barred = _barred(plant, forbidden, unsafe, len(trace.steps), further, rest)
    text = message("found.rest.barred", what=_headline(plant, bool(trace.steps)), barred=barred, rest=rest)
    return Unmeetable(text, tuple(further.lines()), further)


def _headline(plant: Plant, moved: bool) -> Message:
    plain = "-plain" if plant.automaton.one_at_a_time else ""
    return message(f"found.rest.{'led' if moved else 'initial'}{plain}")


def _barred(
    plant: Plant, forbidden: Mapping[str, Function], unsafe: Function, begin: int, trace: Trace, rest: Message
) -> Message:
    """Return where a way to rest, of which the first `begin` steps cannot be prevented, comes to what is not safe."""
    diagrams = plant.diagrams
    for number, step in enumerate(trace.steps[begin:], start=begin + 1):
        state = diagrams.states(step.state)
        if not (state & unsafe).satisfiable():
            continue
        if step.forbidden_by:
            return message("found.rest.breaks", specifications=_names(step.forbidden_by), step=number)
        if names := [n for n, where in forbidden.items() if (state & _doomed(plant, where)).satisfiable()]:
            return message("found.rest.chance", step=number, specifications=_names(names))
        return message("found.rest.may-end", step=number, rest=rest)
    raise AssertionError("a way to rest that is safe")


def _doomed(plant: Plant, where: Function) -> Function:
    return reaching(plant.diagrams, where, plant.uncontrollable)


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _values(plant: Plant, state: State) -> str:
    names = [name for name in plant.automaton.variables if name in plant.diagrams.bits]
    return ", ".join(f"{name} = {print_value(value)}" for name in names if (value := state[name]) is not None)
