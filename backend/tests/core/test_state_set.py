"""Sets of states as diagrams: what they say of a state with unknown values, of fewer variables and of what is near."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product

from hypothesis import given

from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, Builder, StateSet
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from sequence_planner.synthesis.bdd import Diagrams
from support.examples import examples

from .choices import Choices, made_by

TYPES: tuple[Type, ...] = (BOOLEAN, EnumerationType(("p", "q", "r")), IntegerRange(0, 1), IntegerRange(-1, 1))
Values = dict[str, Value | None]
Domains = Mapping[str, Sequence[Value]]
Member = tuple[Value, ...]


def a_set(choices: Choices) -> tuple[Domains, set[Member]]:
    """Up to four variables, and some of their states."""
    domains = {f"x{number}": choices.pick(TYPES).domain for number in range(choices.number(0, 4))}
    density = choices.pick((2, 1, 5))
    return domains, {member for member in product(*domains.values()) if choices.chance(density)}


def diagram(domains: Domains, members: set[Member]) -> StateSet:
    builder = Builder()

    def reference(begin: Member) -> int:
        axis = len(begin)
        if axis == len(domains):
            return EVERYTHING if begin in members else NOTHING
        return builder.node(axis, tuple(reference((*begin, value)) for value in list(domains.values())[axis]))

    return builder.built(tuple(domains), tuple(map(tuple, domains.values())), reference(()))


def a_set_and_a_state(choices: Choices) -> tuple[Domains, set[Member], Values]:
    domains, members = a_set(choices)
    return domains, members, {name: choices.pick((None, *domain)) for name, domain in domains.items()}


def completions(domains: Domains, values: Values) -> set[Member]:
    """Every state that `values` could be."""
    return set(product(*(domain if (v := values[name]) is None else (v,) for name, domain in domains.items())))


@examples(300)
@given(made_by(a_set))
def test_a_diagram_has_the_members_that_it_was_made_of(given_: tuple[Domains, set[Member]]) -> None:
    domains, members = given_
    states = diagram(domains, members)
    assert {tuple(member.values()) for member in states.members()} == members
    assert states.count == len(members)
    assert states.everything == (len(members) == len(set(product(*domains.values()))))
    assert (states.root == NOTHING) == (not members)


@examples(300)
@given(made_by(a_set_and_a_state))
def test_a_state_with_unknowns_is_included_when_all_that_it_could_be_is(
    given_: tuple[Domains, set[Member], Values],
) -> None:
    domains, members, values = given_
    assert diagram(domains, members).includes({**values, "elsewhere": None}) == (
        completions(domains, values) <= members
    )


@examples(300)
@given(made_by(a_set_and_a_state))
def test_for_all_says_the_same_without_the_unknown_variables(given_: tuple[Domains, set[Member], Values]) -> None:
    domains, members, values = given_
    unknown = frozenset(name for name in domains if values[name] is None)
    without = diagram(domains, members).for_all(unknown)
    assert set(without.names) == set(domains) - unknown
    expected = {
        rest
        for rest in product(*(domains[name] for name in without.names))
        if completions(domains, {**values, **dict(zip(without.names, rest, strict=True))}) <= members
    }
    assert {tuple(member.values()) for member in without.members()} == expected
    assert without == diagram({name: domains[name] for name in without.names}, expected)


@examples(300)
@given(made_by(a_set_and_a_state))
def test_the_nearest_member_differs_in_the_fewest_variables(given_: tuple[Domains, set[Member], Values]) -> None:
    domains, members, values = given_
    changes = diagram(domains, members).nearest(values)
    if not members:
        assert changes is None
        return
    assert changes is not None
    assert completions(domains, {**values, **changes}) & members
    assert not any(values[name] in (None, value) for name, value in changes.items())
    distances = [
        sum(value not in (None, other) for value, other in zip(values.values(), member, strict=True))
        for member in members
    ]
    assert len(changes) == min(distances)


@examples(200)
@given(made_by(a_set))
def test_sets_come_back_from_the_diagrams_of_the_synthesis(given_: tuple[Domains, set[Member]]) -> None:
    domains, members = given_
    states = diagram(domains, members)
    diagrams = Diagrams(domains)
    imported = diagrams.imported(states) & diagrams.valid
    assert diagrams.exported(imported, domains) == states
    assert diagrams.count(imported) == len(members)
    narrow = diagrams.exported(imported)
    assert all(
        narrow.includes(dict(zip(domains, each, strict=True))) == (each in members)
        for each in product(*domains.values())
    )


def test_a_set_over_no_variables_is_everything_or_nothing() -> None:
    for root in (NOTHING, EVERYTHING):
        states = StateSet((), (), (), root)
        assert states.includes({"x": None}) is (root == EVERYTHING)
        assert states.count == len(list(states.members())) == root
