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


@dataclass(frozen=True)
class Unmeetable:
    """A statement of what is wrong and what to do, and lines that tell the `trace`, if one was found in reasonable
    time.
    """

    message: str
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
        return Unmeetable(f"specification {names} cannot be met: the devices alone can break it", (), None)
    last = plant.diagrams.states(trace.last)
    names = ", ".join(name for name, where in forbidden.items() if (where & last).satisfiable())
    lines = [step.line(number, names=False) for number, step in enumerate(trace.steps, start=1)]
    if not trace.steps:
        which = "an initial state" if plant.automaton.initial is not None else "the initial state"
        text = f"specification {names} cannot be met: {which} breaks it, with {_values(plant, trace.last)}"
        return Unmeetable(f"{text}. Begin in another state, or forbid less", (), trace)
    return Unmeetable(
        f"specification {names} cannot be met: no start could prevent this from the initial state on",
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
        return Unmeetable(f"{_headline(plant, bool(trace.steps))}. {_what_to_do(plant)}", tuple(trace.lines()), trace)
    further = Tracer(plant, faults=False).onward(trace, plant.rest)
    if further is None:
        return Unmeetable(_headline(plant, bool(trace.steps)), tuple(trace.lines()), trace)
    text = (
        f"{_headline(plant, bool(trace.steps))} safely: {_barred(plant, forbidden, unsafe, len(trace.steps), further)}"
    )
    return Unmeetable(text, tuple(further.lines()), further)


def _headline(plant: Plant, moved: bool) -> str:
    place = "from where the devices alone can lead" if moved else "from the initial state"
    if plant.automaton.one_at_a_time:
        place = "from where uncontrollable transitions can lead" if moved else "from the initial state"
        return f"{place} no state described by `marked` can be reached"
    return f"{place} no state described by `rest` in station.yaml can be reached"


def _what_to_do(plant: Plant) -> str:
    if plant.automaton.one_at_a_time:
        return "So it is also without `forbidden`: check `marked`, and the transitions that should lead there"
    return (
        "So it is also without any specification: check `rest`, and the abilities and effects that should lead there "
        "(neither faults nor restart abilities are counted on)"
    )


def _barred(plant: Plant, forbidden: Mapping[str, Function], unsafe: Function, begin: int, trace: Trace) -> str:
    """Return where a way to rest, of which the first `begin` steps cannot be prevented, comes to what is not safe."""
    diagrams = plant.diagrams
    rest = "a marked state" if plant.automaton.one_at_a_time else "rest"
    for number, step in enumerate(trace.steps[begin:], start=begin + 1):
        state = diagrams.states(step.state)
        if not (state & unsafe).satisfiable():
            continue
        if step.forbidden_by:
            what = f"breaks {_names(step.forbidden_by)} in step {number}"
        elif names := [n for n, where in forbidden.items() if (state & _doomed(plant, where)).satisfiable()]:
            what = f"leaves it to chance, from step {number} on, whether {_names(names)} is broken"
        else:
            what = f"may end, from step {number} on, where {rest} cannot be reached any more"
        return (
            f"the shortest way there {what}. Let another way lead to {rest}, or forbid less; perhaps something "
            "uncontrollable should be left to an ability"
        )
    raise AssertionError("a way to rest that is safe")


def _doomed(plant: Plant, where: Function) -> Function:
    return reaching(plant.diagrams, where, plant.uncontrollable)


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _values(plant: Plant, state: State) -> str:
    names = [name for name in plant.automaton.variables if name in plant.diagrams.bits]
    return ", ".join(f"{name} = {print_value(value)}" for name in names if (value := state[name]) is not None)
