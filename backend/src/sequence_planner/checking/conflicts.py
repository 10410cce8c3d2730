"""Two finishes in one tick that would write different values to one variable: neither would be applied.

First a solver looks for any values with which that happens after a state that no specification forbids, and
`abstraction` tries to prove that they never come about. Then it is computed over what matters which states the station
can reach, so that the state reported is a reachable one. Where there are too many of them, it is said that it is not
shown to be unreachable.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import combinations, islice

from sequence_planner.automaton.cone import cone_of_influence
from sequence_planner.automaton.structure import Ability, Automaton, State, target
from sequence_planner.checking.abstraction import cannot_be
from sequence_planner.checking.inquiry import bits
from sequence_planner.checking.satisfiability import Question, UndecidedError, can_be_asked
from sequence_planner.checking.warning import ModelWarning, described, place
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.syntax import Assignment, Variable, variables
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.synthesis.conflicts import conflicting_finishes
from sequence_planner.synthesis.effort import MOST_BITS, Effort, TooMuchError

MOST_EFFORT = 5_000_000  # nodes for each pair, see `synthesis.effort`
MOST_REPORTED = 3  # pairs for each variable
MOST_TRIED = 50  # pairs for each variable: beyond them, conflicts of many finishes over one variable are not looked for


def check_conflicts(automaton: Automaton) -> Iterator[ModelWarning]:
    """The pairs of abilities whose finishes conflict, with a state in which they do."""
    writers: dict[str, list[tuple[Ability, Assignment]]] = defaultdict(list)
    for ability in automaton.abilities.values():
        for action in ability.finish_actions if ability.finish_guard is not None else ():
            writers[target(action)].append((ability, action))
    seen: set[tuple[str, str]] = set()
    for variable, written in writers.items():
        if len(written) < 2 or _one_value([action for _, action in written]):
            continue
        reported = 0
        for one, other, witness in islice(_possible(automaton, variable, written), MOST_TRIED):
            warning = None
            if (one.name, other.name) not in seen:
                warning = _confirmed(automaton, variable, one, other, witness)
            if warning is not None:
                seen.add((one.name, other.name))
                reported += 1
                yield warning
            if reported == MOST_REPORTED:
                break


def _one_value(actions: Sequence[Assignment]) -> bool:
    """Whether all write the same, whatever the state that all of them read."""
    return all(action.value == actions[0].value for action in actions)


def _possible(
    automaton: Automaton, variable: str, written: Sequence[tuple[Ability, Assignment]]
) -> Iterator[tuple[Ability, Ability, State]]:
    """Pairs that conflict over `variable` with some values, each with what they see then."""
    question = Question(automaton)
    circuit, reading = question.circuit, question.reading
    before = question.state()
    state = question.sensed(before)
    for specification in automaton.specifications.values():
        if can_be_asked(automaton, specification.forbidden):
            circuit.require(-reading.truth(specification.forbidden, before).yes)
    values: dict[object, list[int]] = defaultdict(list)
    chosen: dict[str, int] = {}  # of which writers we speak, so that one pair after the other can be ruled out
    for ability, action in written:
        assert ability.finish_guard is not None
        conditions = [ability.finish_guard, *(() if action.condition is None else (action.condition,))]
        if not can_be_asked(automaton, *conditions, action.value):
            continue
        chosen[ability.name] = circuit.fresh()
        for condition in conditions:
            circuit.require(-chosen[ability.name], reading.truth(condition, state).yes)
        for value, literal in reading.symbol(action.value, state).literals.items():
            values[value].append(circuit.conjunction((chosen[ability.name], literal)))
    two, before_it = [], Circuit.FALSE  # a value is written, and one of those before it as well
    for literals in values.values():
        written_now = circuit.disjunction(literals)
        two.append(circuit.conjunction((written_now, before_it)))
        before_it = circuit.disjunction((written_now, before_it))
    circuit.require(*two)
    by_name = {ability.name: (ability, action) for ability, action in written}
    while (model := _decided(question)) is not None:
        seen = state.valuation(model)
        values_now = {name: evaluate(by_name[name][1].value, seen) for name in chosen if chosen[name] in model}
        one, other = next((a, b) for a, b in combinations(values_now, 2) if values_now[a] != values_now[b])
        yield by_name[one][0], by_name[other][0], seen
        circuit.require(-chosen[one], -chosen[other])


def _decided(question: Question) -> frozenset[int] | None:
    """A solution; None if there is none, or none is found with reasonable effort."""
    try:
        return question.model()
    except UndecidedError:
        return None


def _confirmed(
    automaton: Automaton, variable: str, one: Ability, other: Ability, witness: State
) -> ModelWarning | None:
    """The warning, with a reachable state if there are few enough to look at; none if no such state is reachable."""
    actions = [next(a for a in ability.finish_actions if target(a) == variable) for ability in (one, other)]
    conditions = [
        each
        for ability, action in zip((one, other), actions, strict=True)
        for each in (ability.finish_guard, action.condition)
        if each is not None
    ]
    if cannot_be(automaton, conditions):
        return None
    own = [*conditions, *(action.value for action in actions)]
    read = dict.fromkeys(name for each in own for name in variables(each))
    cone = cone_of_influence(automaton, [*own, Variable(variable, automaton.variables[variable].type)])
    trace = None
    try:
        if bits(automaton, cone) > MOST_BITS:
            raise TooMuchError
        found = conflicting_finishes(automaton, cone, (one.name, other.name), variable, Effort(MOST_EFFORT))
        if found is None:
            return None
        how, seen, trace = "meet in a reachable state", found.seen, found.trace
    except TooMuchError:
        how, seen = "might meet (there are too many states to say whether such a one can be reached)", witness
    message = (
        f"the finishes of `{one.name}` and `{other.name}` would write different values to `{variable}`, and then "
        f"neither is applied. They {how}: {described(seen, read)}. Let their finish guards exclude each other"
    )
    return ModelWarning(place(automaton, f"{other.name}.finish", other.name), "write-conflict", message, trace)
