"""What the advisor offers is what exhaustive search finds, on random stations small enough for that."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations, product

from hypothesis import assume, given

from core.choices import Choices, made_by
from core.exhaustive import can_reach
from core.random_problems import problem
from core.random_stations import state_of
from sequence_planner.automaton.automaton import Kind, State
from sequence_planner.automaton.tick import synchronise
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Circumstances
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.proposals import Advice, OfferKind, RecoveryProposal
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.planning.recovery_path import WaysBack
from sequence_planner.planning.sat.search import SearchTimeoutError
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget
from support.examples import examples

from .carrying_out import Stopped, carried_out

LONGEST = 6  # ticks of ways back: that there is no longer one either takes long to find out

Changes = frozenset[tuple[str, Value]]


def stopped(choices: Choices) -> Stopped:
    """A station that has stopped anywhere, be it outside its safe states; some of it may be missing."""
    given_ = problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))
    station, state = given_.automaton, given_.state
    if choices.chance(3):
        state = state_of(choices, station)
    preconditions = [each.predicate for each in given_.goals]
    operations = {
        name: replace(each, precondition=choices.pick(preconditions)) for name, each in station.operations.items()
    }
    barred = frozenset(choices.different(list(station.abilities), 0, 1)) if choices.chance(3) else frozenset[str]()
    circumstances = replace(given_.circumstances, restart=False, avoid=(), barred=barred)
    state = synchronise(station, state)
    station = replace(station, operations=operations)
    return Stopped(station, given_.supervisor, state, missing(given_.goals, state), circumstances)


def advised(given_: Stopped, longest: int = 60) -> Advice:
    """All offers there are."""
    advisor = Advisor(given_.automaton, given_.supervisor, most=1000)
    return advisor.advise(AdviceRequest(given_.state, given_.goals, given_.circumstances, deadline=60, longest=longest))


def possible(given_: Stopped, restart: bool = False) -> bool:
    """Whether there is a plan, be it that nothing is left to do, from a safe state."""
    if not given_.supervisor.safe.includes(given_.state):
        return False
    goals = missing(given_.goals, given_.state)
    circumstances = replace(given_.circumstances, restart=restart)
    return not goals or can_reach(given_.automaton, given_.supervisor, [given_.state], goals, circumstances)


def corrected(given_: Stopped, size: int, kind: Kind = Kind.ESTIMATED) -> Iterator[Changes]:
    """All changes of so many variables after which there is a plan."""
    station = given_.automaton
    known = [name for name in station.names(kind) if given_.state[name] is not None]
    mine = [name for name in known if station.variables[name].resource not in given_.circumstances.offline]
    for names in combinations(mine, size):
        for values in product(*(station.variables[name].type.domain for name in names)):
            changes = dict(zip(names, values, strict=True))
            if all(given_.state[name] != value for name, value in changes.items()):
                state: State = synchronise(station, {**given_.state, **changes})
                if possible(replace(given_, state=state)):
                    yield frozenset(changes.items())


def full(advice: Advice, kind: OfferKind) -> list[RecoveryProposal]:
    return [offer for offer in advice.offers if offer.kind is kind and not offer.left_out]


def made_by_corrections(offer: RecoveryProposal) -> Changes:
    return frozenset((change.name, change.new) for change in offer.corrections)


def check_corrections(given_: Stopped, advice: Advice) -> None:
    """All of the fewest corrections are there, and none of more where one helps by more than words."""
    found = {made_by_corrections(offer) for offer in full(advice, OfferKind.CORRECTION)}
    one = set(corrected(given_, 1))
    expected = one or set(corrected(given_, 2))
    assert {each for each in found if len(each) == (1 if one else 2)} == expected
    assert bool(found) == bool(expected)
    if any(len(each) > 1 for each in found) and one:
        assert all(o.only_if_checked for o in full(advice, OfferKind.CORRECTION) if o.effort.changes == 1)


def check_physical_changes(given_: Stopped, advice: Advice) -> None:
    """One is enough where changing one measured variable is."""
    if any(corrected(given_, 1, Kind.MEASURED)):
        offers = full(advice, OfferKind.PHYSICAL)
        assert any(offer.effort.physical + offer.effort.returns == 1 for offer in offers)


@examples(60)
@given(made_by(stopped))
def test_what_is_offered_is_what_exhaustive_search_finds(given_: Stopped) -> None:
    advice = advised(given_)
    assert advice.complete
    for offer in advice.offers:
        carried_out(given_, offer)
    ranks = [offer.rank for offer in advice.offers]
    assert ranks == sorted(ranks)
    goes_on = possible(given_)
    assert bool(full(advice, OfferKind.REPLAN)) == goes_on
    if not goes_on:
        check_corrections(given_, advice)
        check_physical_changes(given_, advice)
        if given_.supervisor.safe.includes(given_.state):
            assert bool(full(advice, OfferKind.RESTART)) == possible(given_, restart=True)


@examples(12)
@given(made_by(stopped))
def test_there_is_a_way_back_where_production_goes_on_after_the_shortest(given_: Stopped) -> None:
    assume(not given_.supervisor.safe.includes(given_.state))
    ways = WaysBack(given_.automaton, given_.supervisor.safe)
    try:
        way = ways.way(given_.state, given_.circumstances, LONGEST, Budget.seconds(60))
    except SearchTimeoutError:
        way = None
    advice = advised(given_, LONGEST)
    offers = [offer for offer in advice.offers if offer.kind is OfferKind.WAY_BACK]
    if way is None:
        assert not offers
    elif all(goal.local == TRUE for goal in given_.goals):  # else the way may fail a formula
        # One after which goals are given up is offered only where nothing reaches them all.
        assert offers or any(not offer.left_out for offer in advice.offers)
        assert all(offer.operator_plan is not None for offer in offers)


def test_a_station_with_nothing_to_do_goes_on() -> None:
    given_ = stopped(Choices(lambda _: 0))
    nothing = Stopped(given_.automaton, given_.supervisor, given_.state, (), Circumstances())
    (offer, *_) = advised(nothing).offers
    assert (offer.kind, offer.effort.cost) == (OfferKind.REPLAN, 0)
