"""Plans of other planners are plans of ours, and the other way round: the exported texts against the reference tick."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from hypothesis import assume, given, reject

from sequence_planner.automaton.automaton import Automaton, Effect, Kind, VariableDeclaration
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.export.pddl import PddlText, pddl_text
from sequence_planner.export.sequential import ExportError, sequential
from sequence_planner.language.syntax import FALSE, TRUE, Not, Variable
from sequence_planner.language.types import BOOLEAN
from sequence_planner.model.efa_document import read_plain
from sequence_planner.model.source import ModelError
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import Circumstances, Goal, goals_of
from sequence_planner.planning.single.derived import for_planning
from sequence_planner.planning.validation.replay import Replay
from support.automata import Does, automaton
from support.examples import examples

from .breadth_first import shortest
from .choices import Choices, made_by
from .pddl_reader import PddlProblem
from .random_expressions import actions, guard
from .random_plain import document
from .random_problems import Problem, problem

TICK = "finishing"
OFF = (BOOLEAN, False)
EVERYTHING = StateSet((), ())
FREE = Supervisor(EVERYTHING, {})


def compare(asked: Problem, goals: Goals) -> None:
    """The fewest ticks are the same, and what the other planner found is read back as a plan that replays."""
    station, supervisor, state = asked.automaton, asked.supervisor, asked.state
    assume(supervisor.safe.includes(state))
    text = pddl_text(sequential(station, supervisor, state, goals, asked.circumstances))
    found = PddlProblem(text.domain, text.problem).cheapest(TICK)
    best = shortest(station, supervisor, state, goals, 1000, asked.circumstances)
    assert (found is None) == (best is None)
    if found is None or best is None:
        return
    ticks, written = found
    plan = text.plan(written)
    assert Replay(station, supervisor, asked.circumstances).exactly(state, state, goals, (), plan.ticks)
    if text.timed:
        assert ticks == best.ticks
        assert len(plan.ticks) == best.ticks


def contended(choices: Choices) -> Problem:
    """A problem with three more effects, which read and write what each other does, in circles."""
    given_ = problem(choices)
    more = {name: VariableDeclaration(name, BOOLEAN, Kind.MEASURED, False, None) for name in ("mx", "my")}
    declared = {**given_.automaton.variables, **more}
    seen = [Variable(n, v.type) for n, v in declared.items() if v.kind in (Kind.MEASURED, Kind.OUTPUT)]
    measured = [variable for variable in seen if declared[variable.name].kind is Kind.MEASURED]
    effects = tuple(
        Effect(f"x{i}", "station", "executing", guard(choices, seen), actions(choices, measured, seen, least=1))
        for i in range(3)
    )
    station = replace(given_.automaton, variables=declared, effects=(*given_.automaton.effects, *effects))
    state = synchronise(station, {**given_.state, "mx": False, "my": choices.chance(2)})
    return Problem(station, FREE, state, Circumstances(restart=choices.chance(4)))


@examples(120)
@given(made_by(problem))
def test_the_exported_question_has_the_same_shortest_plans(asked: Problem) -> None:
    compare(asked, asked.goals)


@examples(120)
@given(made_by(contended))
def test_effects_that_read_what_others_write_still_see_the_state_before_the_tick(asked: Problem) -> None:
    compare(asked, asked.goals)


@examples(60)
@given(made_by(lambda choices: problem(choices, demanding=True)))
def test_offline_resources_barred_abilities_and_states_to_avoid_are_part_of_the_question(asked: Problem) -> None:
    if not asked.supervisor.safe.everything:
        asked = replace(asked, circumstances=replace(asked.circumstances, restart=False))
    compare(asked, tuple(replace(goal, local=TRUE, at=0) for goal in asked.goals))


@examples(100)
@given(made_by(document))
def test_a_plain_automaton_has_an_action_for_each_transition(written: dict[str, object]) -> None:
    try:
        plain = plain_automaton(read_plain(json.dumps(written), "random.efa.json"))
    except ModelError:
        reject()
    station = for_planning(plain)
    state = synchronise(station, {**dict.fromkeys(station.types), **plain.initial_valuation})
    compare(Problem(station, FREE, state, Circumstances()), goals_of(plain, plain.operations))


def two_lamps() -> Automaton:
    return automaton(
        {
            "Left": Does(start=("left := true",), enabled="not left"),
            "left": Does(start=("right := true", "left := false"), enabled="left and lit"),
        },
        measured={"lit": OFF},
        output={"left": OFF, "right": OFF},
        effects={"light": ("left and not lit", ("lit := true",))},
        goals={"both": "right"},
    )


def exported(station: Automaton) -> PddlText:
    return pddl_text(sequential(station, FREE, initial_state(station), goals_of(station, station.operations)))


def test_a_written_plan_is_read_back_tick_by_tick() -> None:
    text = exported(two_lamps())
    assert text.moves["start-left_2"][1] == "left"  # case tells nothing apart in PDDL
    written = (
        "; a comment\n(finishing)\n(settled)\n(start-left)\n(begin)\n(effect-light)\n(finishing)\n(settled )\n"
        "(start-left_2)\n(begin)\n(finishing)\n(settled)\n(reach-both)\n; cost = 11 (unit cost)\n"
    )
    plan = text.plan(written)
    assert [(tick.effects, tick.starts) for tick in plan.ticks] == [((), ("Left",)), (("light",), ("left",)), ((), ())]
    assert text.plan("0: (FINISHING)\n0.1: (settled) [1.0]").ticks[0].starts == ()
    with pytest.raises(ExportError, match="`fly`"):
        text.plan("(fly)")


def test_what_has_no_counterpart_is_refused_with_what_to_do() -> None:
    station = two_lamps()
    state, goals = initial_state(station), goals_of(station, station.operations)
    with pytest.raises(ExportError, match="`lit` has no value"):
        sequential(station, FREE, {**state, "lit": None}, goals)
    with pytest.raises(ExportError, match="`g` has a `local` formula"):
        sequential(station, FREE, state, (Goal("g", TRUE, local=Not(Variable("lit", BOOLEAN))),))
    with pytest.raises(ExportError, match="between ticks"):
        sequential(station, FREE, {**state, "Left.enabled": False}, goals)
    nothing = Supervisor(replace(EVERYTHING, root=0), {})
    with pytest.raises(ExportError, match="not safe"):
        sequential(station, nothing, state, goals)


def test_goals_that_hold_already_need_nothing() -> None:
    station = two_lamps()
    state = initial_state(station)
    text = pddl_text(sequential(station, FREE, state, (Goal("always", TRUE),)))
    assert PddlProblem(text.domain, text.problem).cheapest(TICK) == (0, "")
    text = pddl_text(sequential(station, FREE, state, (Goal("never", FALSE),)))
    assert PddlProblem(text.domain, text.problem).cheapest(TICK) is None
