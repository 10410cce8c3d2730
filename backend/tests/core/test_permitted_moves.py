"""What a supervisor may allow where variables have gathered values, beside every state that they make up."""

from __future__ import annotations

from collections.abc import Mapping, Set
from itertools import product

from hypothesis import given

from sequence_planner.automaton.automaton import target
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.language.syntax import TRUE, Assignment, Constant, Variable
from sequence_planner.language.types import BOOLEAN, Value
from sequence_planner.planning.heuristic.relaxation import Permission
from support.examples import examples

from .choices import Choices, made_by
from .test_state_set import Domains, Member, a_set, diagram

Possible = dict[str, set[Value | None]]
Asked = list[tuple[Possible, Transition]]


def growing(choices: Choices) -> tuple[Domains, set[Member], Asked]:
    """A set of states, and moves that are asked about while more and more values are possible; one may be unknown."""
    domains, members = a_set(choices)
    names = list(domains)
    unknown = {name for name in names if choices.chance(5)}
    possible: Possible = {n: {None} if n in unknown else {choices.pick(domain)} for n, domain in domains.items()}
    asked: Asked = []
    for _ in range(choices.number(1, 6)):
        written = {name: choices.pick(domains[name]) for name in choices.different(names, 0, 2)}
        actions = tuple(Assignment(Variable(name, BOOLEAN), Constant(value)) for name, value in written.items())
        asked.append(({n: set(values) for n, values in possible.items()}, Transition("m", Phase.START, TRUE, actions)))
        for name in choices.different(sorted(set(names) - unknown), 0, 2):
            possible[name].add(choices.pick(domains[name]))
    return domains, members, asked


@examples(300)
@given(made_by(growing))
def test_a_move_is_permitted_where_a_safe_state_may_lead_to_one(given_: tuple[Domains, set[Member], Asked]) -> None:
    domains, members, asked = given_
    supervisor = Supervisor(diagram(domains, members), {})
    permission = Permission(supervisor)
    for possible, move in asked:
        allowed = permission.may(move, possible)
        assert allowed == Permission(supervisor).may(move, possible)
        if all(None not in values for values in possible.values()):
            written = {target(a): {a.value.value} for a in move.actions if isinstance(a.value, Constant)}
            assert allowed == (_met(supervisor.safe, possible) and _met(supervisor.safe, {**possible, **written}))


def _met(safe: StateSet, possible: Mapping[str, Set[Value | None]]) -> bool:
    combinations = product(*(possible[name] for name in safe.names))
    return any(safe.includes(dict(zip(safe.names, values, strict=True))) for values in combinations)
