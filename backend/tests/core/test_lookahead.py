"""The look ahead beside the reference replay: the same plans reach their goals, whatever the circumstances."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from hypothesis import given

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.tick import apply_effects, finish, supervised_start, synchronise
from sequence_planner.planning.problem import PlanTick
from sequence_planner.planning.validation.lookahead import Lookahead
from sequence_planner.planning.validation.replay import Replay
from support.examples import examples

from .choices import Choices, made_by
from .random_problems import Problem, problem
from .random_stations import state_of


@dataclass(frozen=True)
class Followed:
    """A plan that need not be one, in circumstances that need not allow it, looked at from several states."""

    problem: Problem
    states: tuple[State, ...]
    ticks: tuple[PlanTick, ...]


def followed(choices: Choices) -> Followed:
    """Any such case."""
    given_ = problem(choices, unknown=choices.chance(4), demanding=True)
    states = (given_.state, *(state_of(choices, given_.automaton, unknown=False) for _ in range(2)))
    return Followed(given_, states, tuple(_ticks(choices, given_)))


def _ticks(choices: Choices, given_: Problem) -> Iterator[PlanTick]:
    """Ticks that happen one after the other, but for one or the other start or effect that may be out of place."""
    station, before = given_.automaton, given_.state
    names = [ability.name for ability in station.abilities.values()]
    effects = [effect for effect in station.effects if not effect.fault]
    for _ in range(choices.number(0, 4)):
        happening = [effect for effect in choices.different(effects, 0, 3) if apply_effects(before, [effect])]
        sensed = apply_effects(before, happening)
        if sensed is None or choices.chance(20):
            happening, sensed = [effect for effect in effects if choices.chance(5)], before
        after = synchronise(station, finish(station, sensed).state)
        starts: list[str] = []
        for name in choices.different(names, 0, 3):
            started = supervised_start(station, given_.supervisor, before, after, station.abilities[name])
            if started is not None or choices.chance(20):
                starts.append(name)
                after = started or after
        yield PlanTick(tuple(effect.name for effect in happening), tuple(starts))
        before = after


@examples(120)
@given(made_by(followed))
def test_the_look_ahead_sees_what_the_reference_replay_sees(case: Followed) -> None:
    station, supervisor, circumstances = case.problem.automaton, case.problem.supervisor, case.problem.circumstances
    replay = Replay(station, supervisor, circumstances)
    compiled = CompiledTick(station)
    lookahead = Lookahead(compiled, supervisor)
    lookahead.face(circumstances)
    order = tuple(name for tick in case.ticks for name in tick.starts)
    for state in case.states:
        run = CompiledRun(compiled, state)
        for published in case.states:
            for goals in (case.problem.goals, case.problem.goals[:1], ()):
                eagerly = replay.eagerly(state, published, goals, order)
                assert (lookahead.length(run, published, goals, order) is not None) == eagerly
                exactly = replay.exactly(state, published, goals, (), case.ticks)
                assert lookahead.exactly(run, published, goals, (), case.ticks) == exactly
                still = replay.still_reaches(state, published, goals, order, case.ticks)
                assert (lookahead.remaining(run, published, goals, order, case.ticks) is not None) == still
        assert run.state == state
