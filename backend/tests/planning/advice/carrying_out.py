"""Offers carried out as they are written, step by step on the reference tick, and by everything they claim."""

from __future__ import annotations

from dataclasses import dataclass

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import apply_effects, finish, supervised_start, synchronise
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import TRUE
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.problem import Circumstances
from sequence_planner.planning.recovery.proposals import OfferKind, RecoveryProposal
from sequence_planner.planning.validation.replay import Replay, missing

ANYTHING = Supervisor(StateSet((), ()), {})


@dataclass(frozen=True)
class Stopped:
    """A station that has stopped in a synchronised `state`; `circumstances` are those of production."""

    automaton: Automaton
    supervisor: Supervisor
    state: State
    goals: Goals
    circumstances: Circumstances


def changed(stopped: Stopped, offer: RecoveryProposal) -> tuple[State, Circumstances]:
    """The station after what a person does, each change of which is one that makes sense."""
    automaton, state = stopped.automaton, dict(stopped.state)
    for change in (*offer.corrections, *offer.physical, *offer.assumed):
        declared = automaton.variables[change.name]
        assert state[change.name] == change.old != change.new
        assert change.new in declared.type.domain
        state[change.name] = change.new
    assert all(automaton.variables[c.name].kind is Kind.ESTIMATED and c.old is not None for c in offer.corrections)
    circumstances = stopped.circumstances
    for change in offer.physical:
        declared = automaton.variables[change.name]
        assert (declared.kind, change.old is None) == (Kind.MEASURED, False)
        assert declared.resource not in circumstances.offline
    for change in offer.assumed:
        assert change.old is None
        assert automaton.variables[change.name].resource in offer.online
    circumstances = replace(
        circumstances,
        offline=circumstances.offline - set(offer.online),
        barred=circumstances.barred - set(offer.in_service),
    )
    return synchronise(automaton, state), circumstances


def carried_out(stopped: Stopped, offer: RecoveryProposal) -> None:
    """AssertionError where the offer does not keep what it says."""
    automaton, supervisor = stopped.automaton, stopped.supervisor
    state, circumstances = changed(stopped, offer)
    goals = missing(stopped.goals, state)
    inside = supervisor.safe.includes(state)
    if offer.kind is OfferKind.PHYSICAL:  # the tick that hears of it takes in at once what has finished
        inside = inside or supervisor.safe.includes(synchronise(automaton, finish(automaton, state).state))
    if offer.operator_plan is None:
        assert offer.kind in (OfferKind.REPLAN, OfferKind.CORRECTION, OfferKind.PHYSICAL, OfferKind.COMBINED)
        assert (offer.goal, offer.unsupervised, offer.restart, offer.breaks) == (TRUE, False, False, ())
    else:
        begun = [replace(goal, at=0) for goal in goals if goal.name == offer.operation]
        goals = tuple(goal for goal in goals if goal.name != offer.operation)
        effects = {e.name: e for e in automaton.effects if not e.fault and e.resource not in circumstances.offline}
        unsupervised = False
        for tick in offer.operator_plan.ticks:
            published = state
            sensed = apply_effects(state, [effects[name] for name in tick.effects])
            assert sensed is not None
            state = synchronise(automaton, finish(automaton, sensed).state)
            left = settled(goals, state)
            assert left is not None
            goals, inside = left, inside or supervisor.safe.includes(state)
            for name in tick.starts:
                ability = automaton.abilities[name]
                assert not replace(circumstances, restart=True).bars(ability)
                unsupervised = unsupervised or not inside
                after = supervised_start(automaton, supervisor if inside else ANYTHING, published, state, ability)
                assert after is not None
                left = moved(goals, after)
                assert left is not None
                state, goals, inside = after, left, inside or supervisor.safe.includes(after)
        assert offer.unsupervised == unsupervised
        assert holds(offer.goal, state)
        goals = missing((*goals, *begun), state)
    assert inside
    assert dict(offer.end) == dict(state)
    assert offer.then is not None
    wanted = tuple(goal for goal in goals if goal.name not in offer.left_out)
    replay = Replay(automaton, supervisor, replace(circumstances, restart=False))
    assert replay.exactly(state, state, wanted, (), offer.then.ticks)
    assert {*offer.goals, *offer.left_out} == {goal.name for goal in missing(stopped.goals, stopped.state)}
