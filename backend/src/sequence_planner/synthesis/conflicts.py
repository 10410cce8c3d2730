"""Two finishes in one tick that would write different values to one variable, in a state that can be reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.reachability import Tracer, reachable
from sequence_planner.synthesis.traces import Trace
from sequence_planner.synthesis.transition_relation import NodeLimit, Plant, Reaction


@dataclass(frozen=True)
class Meeting:
    """The values that two finishes see when they meet: variables as just measured, flags as before.

    `trace` ends with the tick in which they do; None if that takes too long to find.
    """

    seen: State
    trace: Trace | None


def conflicting_finishes(
    automaton: Automaton, names: Sequence[str], abilities: tuple[str, str], variable: str, effort: NodeLimit
) -> Meeting | None:
    """Return where two abilities both finish in a reachable state and would write `variable` differently; None if
    nowhere.

    `names` is a cone of influence of both finishes. Of the supervisor no more is used than that it keeps the station
    out of what specifications over `names` forbid, and any operation may be active at any time, as nothing here decides
    that. Raises `TooMuchError` when more than `effort` is needed.
    """
    plant = Plant(automaton, names)
    diagrams = plant.diagrams
    allowed = diagrams.valid
    for specification in automaton.specifications.values():
        if plant.says((specification.forbidden,)):
            allowed &= ~plant.where(specification.forbidden)
    starts = plant.all_starts
    steps = effort.limited([*plant.uncontrollable, *starts])
    reached = reachable(diagrams, plant.initial & allowed, steps, allowed)
    reaction = plant.reaction(automaton.effects)
    one, other = (reaction.finishes[name] for name in abilities)
    meeting = reaction.sensed(reached) & reaction.disputes(one, other, variable)
    if not meeting.satisfiable():
        return None
    before = meeting.exists(diagrams.cube(bit for name in reaction.measured for bit in diagrams.bits_after[name]))
    trace = Tracer(plant, within=allowed).shortest(before)
    found = diagrams.pick_step(meeting if trace is None else _calmest(plant, reaction, meeting, trace.last))
    assert found is not None
    state, after = found
    measured = {name: after[name] for name in reaction.measured}
    if trace is None:
        return Meeting({**synchronise(automaton, {**automaton.initial_valuation, **state}), **measured}, None)
    return Meeting({**trace.last, **measured}, Tracer(plant).ticked(trace, {**state, **measured}))


def _calmest(plant: Plant, reaction: Reaction, meeting: Function, state: State) -> Function:
    """The steps of `meeting` from `state` in which little else is measured than before."""
    diagrams = plant.diagrams
    meeting &= diagrams.states(state)
    for name in reaction.measured:
        if (value := state[name]) is not None:
            same = meeting & diagrams.values_after(name)[value]
            meeting = same if same.satisfiable() else meeting
    return meeting
