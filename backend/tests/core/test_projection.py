"""Plans made of a part of the station are plans of the whole."""

from __future__ import annotations

from hypothesis import given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.types import BOOLEAN
from sequence_planner.planning.heuristic.projection import Projection
from sequence_planner.planning.heuristic.relaxed_plan import Relevance
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Circumstances, Contract, goals_of
from sequence_planner.process.budget import Budget
from support.automata import Does, automaton
from support.examples import examples

from .choices import made_by
from .random_problems import Problem, problem
from .test_bounded import open_goals, valid

EVERYTHING = Supervisor(StateSet((), ()), {})
OFF = (BOOLEAN, False)


@examples(250)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))))
def test_what_it_finds_is_a_plan(given_: Problem) -> None:
    if not (goals := open_goals(given_)):
        return
    task = PlanningTask(given_.state, goals, given_.circumstances, Contract.FAST, longest=12)
    finding = Projection(given_.automaton, given_.supervisor).solve(task, Budget.seconds(30))
    assert (finding.proof, finding.searched) == (None, 0)
    if finding.plan is not None:
        assert not finding.plan.minimal_ticks
        assert valid(given_, finding.plan)


def lamps(number: int) -> Automaton:
    """Lamps that each take a switch, a fuse that all of them need, and a lamp that goes out when the next is lit."""
    names = range(number)
    dims = {
        f"dim_{n}": Does(start=(), finish=f"lit_{n} and lit_{n + 1} and bright_{n}", finally_=(f"bright_{n} := false",))
        for n in names[:-1]
    }
    return automaton(
        {f"light_{n}": Does(start=(f"switch_{n} := true",), enabled=f"fuse and not switch_{n}") for n in names}
        | {"fit": Does(start=("fuse := true",), enabled="not fuse")}
        | dims,
        measured={f"lit_{n}": OFF for n in names},
        output={f"switch_{n}": OFF for n in names},
        estimated={"fuse": OFF} | {f"bright_{n}": (BOOLEAN, True) for n in names},
        effects={f"shines_{n}": (f"switch_{n} and not lit_{n}", (f"lit_{n} := true",)) for n in names},
        goals={"lit": "lit_3", "pair": "lit_3 and lit_4 and not bright_3", "bright": "lit_3 and lit_4 and bright_3"},
    )


def ask(station: Automaton, goal: str, contract: Contract = Contract.FAST) -> Finding:
    task = PlanningTask(initial_state(station), goals_of(station, (goal,)), Circumstances(), contract)
    return Projection(station, EVERYTHING).solve(task, Budget.seconds(20))


def test_only_what_matters_is_started() -> None:
    plan = ask(lamps(40), "lit").plan
    assert plan is not None
    assert [tick.starts for tick in plan.ticks] == [("fit", "light_3"), ()]


def test_what_finishes_by_itself_is_counted_on() -> None:
    plan = ask(lamps(40), "pair").plan
    assert plan is not None
    assert sorted(name for _, name in plan.starts) == ["fit", "light_3", "light_4"]


def test_what_is_frozen_but_would_change_is_let_loose() -> None:
    """Both lamps can be lit only so that the first goes out: no plan of a part that ignores this is believed."""
    assert ask(lamps(10), "bright").plan is None


def test_by_the_minimal_contract_it_proves_nothing_of_its_plan() -> None:
    plan = ask(lamps(5), "lit", Contract.MINIMAL).plan
    assert plan is not None
    assert not (plan.minimal_ticks or plan.minimal_starts)


def test_only_what_could_matter_is_looked_at() -> None:
    station = lamps(40)
    found = Relevance(station).towards([station.operations["lit"].goal], initial_state(station), Circumstances())
    assert [move.name for move in found] == ["shines_3", "light_3.start", "fit.start"]


def test_it_goes_on_where_the_budget_was_spent() -> None:
    station = lamps(40)
    task = PlanningTask(initial_state(station), goals_of(station, ("pair",)), Circumstances(), Contract.FAST)
    engine = Projection(station, EVERYTHING)
    called_off = Budget.seconds(20)
    called_off.call_off()
    assert engine.solve(task, called_off) == Finding()
    assert engine.solve(task, Budget.seconds(20)) == ask(station, "pair")


def test_what_keeps_others_from_starting_starts_after_them() -> None:
    """Each is declared before that which must start first, and still all start in one tick."""
    station = automaton(
        {
            "leave": Does(start=("gone := true",), enabled="loaded and not gone"),
            "load": Does(start=("loaded := true",), enabled="open and not gone and not loaded"),
            "unlock": Does(start=("open := true",), enabled="not open and not gone"),
        },
        measured={"away": OFF},
        output={"gone": OFF},
        estimated={"loaded": OFF, "open": OFF},
        effects={"goes": ("gone and not away", ("away := true",))},
        goals={"away": "away"},
    )
    plan = ask(station, "away").plan
    assert plan is not None
    assert [tick.starts for tick in plan.ticks] == [("unlock", "load", "leave"), ()]
