"""Two finishes in one tick that would write different values to one variable, in a state that can be reached."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.synthesis.plant import Plant
from sequence_planner.synthesis.saturation import reachable


def conflicting_finishes(
    automaton: Automaton, names: Sequence[str], abilities: tuple[str, str], variable: str
) -> State | None:
    """What two abilities see when both finish in a reachable state and would write `variable` differently.

    Variables are as just measured, flags as before. `names` is a cone of influence of both finishes. Of the supervisor
    no more is used than that it keeps the station out of what specifications over `names` forbid, and any operation may
    be active at any time, as nothing here decides that.
    """
    plant = Plant(automaton, names)
    diagrams = plant.diagrams
    allowed = diagrams.valid
    for specification in automaton.specifications.values():
        if plant.says((specification.forbidden,)):
            allowed &= ~plant.where(specification.forbidden)
    starts = [step for steps in plant.starts.values() for step in steps]
    reached = reachable(diagrams, plant.initial & allowed, [*plant.uncontrollable, *starts], allowed)
    reaction = plant.reaction(automaton.effects)
    one, other = (reaction.finishes[name] for name in abilities)
    meeting = reaction.sensed(reached) & reaction.disputes(one, other, variable)
    found = diagrams.pick_step(meeting)
    if found is None:
        return None
    before, after = found
    measured = {name: after[name] for name in reaction.measured}
    seen: dict[str, bool | int | str | None] = dict(before)
    for flag in automaton.flags:
        if plant.says((flag.predicate,)):
            seen[flag.name] = evaluate(flag.predicate, seen)
    return {**seen, **measured}
