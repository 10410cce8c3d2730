"""What a plan may count on, by example: one rule of the semantics each."""

from __future__ import annotations

import pytest

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.tick import initial_state, sense, synchronise
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Value
from sequence_planner.planning.heuristic.relaxation import reachable
from sequence_planner.planning.planner import InTurn, Planner, PlanningAttempt
from sequence_planner.planning.portfolio.engines import ALONE, Engines
from sequence_planner.planning.problem import Circumstances, PlanAnswer, PlanRequest, Verdict, goals_of
from sequence_planner.planning.sat.start_order import sweep_order
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton

LONGEST = 7
NONE = (Verdict.NONE_UP_TO, Verdict.NONE_AT_ALL)  # no plan, whether or not that is proven in time
OFF = (BOOLEAN, False)


def ask(station: Automaton, state: State, *goals: str) -> PlanAnswer:
    """The planner's answer for these operations, or for all."""
    wanted = goals_of(station, goals or station.operations)
    return Planner(station, synthesise(station)).answer(PlanRequest(state, wanted, deadline=60, longest=LONGEST))


def starts(answer: PlanAnswer) -> list[tuple[str, ...]]:
    """The starts of each tick of a plan that was found."""
    assert answer.verdict is Verdict.FOUND
    assert answer.plan is not None
    return [tick.starts for tick in answer.plan.ticks]


def test_goals_that_are_met_need_no_plan_even_if_they_cannot_be_met_again() -> None:
    station = automaton(
        {
            "on": Does(start=("lamp := true",)),
            "rises": Does(start=(), finish="lamp or dark", finally_=("dark := false",)),
        },
        output={"lamp": OFF},
        estimated={"dark": (BOOLEAN, True)},
        goals={"dark": "dark", "lit": "lamp"},
    )
    state = initial_state(station)
    met = ask(station, state, "dark")
    assert (met.verdict, met.plan and met.plan.ticks) == (Verdict.FOUND, ())
    both = ask(station, state)
    assert set(both.goals) == {"dark", "lit"}
    assert both.plan is not None
    assert [name for _, name in both.plan.starts] == ["on"]


def test_different_abilities_start_in_one_tick_in_the_order_that_works_and_one_ability_once() -> None:
    station = automaton(
        {
            "second": Does(start=("b := true",), when="a"),
            "first": Does(start=("a := true",)),
            "count": Does(start=("ones := true if not ones", "twos := true if ones")),
        },
        output={"a": OFF, "b": OFF},
        estimated={"ones": OFF, "twos": OFF},
        goals={"ordered": "b", "counted": "twos"},
    )
    ordered = ask(station, initial_state(station), "ordered").plan
    assert ordered is not None
    assert [tick.starts for tick in ordered.ticks] == [("first", "second"), ()]
    counted = ask(station, initial_state(station), "counted").plan
    assert counted is not None
    assert [tick.starts for tick in counted.ticks] == [("count",), ("count",), ()]


@pytest.mark.parametrize(("goal", "order"), [("x == 1", ["two", "one"]), ("x == 2", ["one", "two"])])
def test_starts_of_which_each_undoes_the_other_are_planned_in_either_order(goal: str, order: list[str]) -> None:
    station = automaton(
        {
            "one": Does(start=("x := 1", "was_one := true")),
            "two": Does(start=("x := 2", "was_two := true")),
            "other": Does(start=("y := true",), when="was_one and was_two"),
        },
        output={"y": OFF},
        estimated={"x": (IntegerRange(0, 2), 0), "was_one": OFF, "was_two": OFF},
        goals={"reach": f"{goal} and y"},
    )
    plan = ask(station, initial_state(station)).plan
    assert plan is not None
    assert len(plan.ticks) == 2
    assert [name for name in plan.ticks[0].starts if name != "other"] == order


def test_an_output_is_set_back_in_the_next_tick_so_that_its_device_sees_it() -> None:
    station = automaton(
        {
            "on": Does(start=("pulse := true", "seen := true")),
            "off": Does(start=("pulse := false",)),
        },
        output={"pulse": OFF},
        estimated={"seen": OFF},
        goals={"reach": "seen and not pulse"},
    )
    plan = ask(station, initial_state(station)).plan
    assert plan is not None
    assert [tick.starts for tick in plan.ticks] == [("on",), ("off",), ()]


def test_an_action_that_reads_a_flag_stands_in_the_right_order_with_what_sets_the_flag() -> None:
    station = automaton(
        {
            "copy": Does(start=("seen := move.executing",)),
            "move": Does(start=("target := true",), enabled="not target", executing="target"),
        },
        output={"target": OFF},
        estimated={"seen": OFF},
        goals={"reach": "seen"},
    )
    order = [ability.name for ability in sweep_order(station, synthesise(station))]
    assert "copy" in order[order.index("move") :]
    assert starts(ask(station, initial_state(station))) == [("move", "copy"), ()]


def test_a_start_is_not_planned_on_a_flag_that_is_older_than_an_unknown_value() -> None:
    """`watch` was not executing when `hot` was last known; since then, opening may have become forbidden."""
    station = automaton(
        {
            "watch": Does(start=(), executing="hot"),
            "open": Does(start=("valve := true",), when="not watch.executing"),
        },
        measured={"hot": OFF},
        output={"valve": OFF},
        forbidden={"no_hot_valve": "valve and hot"},
        goals={"reach": "valve"},
    )
    cold = initial_state(station)
    assert ask(station, cold).verdict is Verdict.FOUND
    unknown = synchronise(station, sense(cold, {"hot": None}))
    assert unknown["watch.executing"] is False
    assert ask(station, unknown).verdict in NONE


def test_the_goal_of_lowest_priority_is_left_out_first() -> None:
    station = automaton(
        {name: Does(start=(f"x := {number}",), when="x == 0") for number, name in enumerate(("one", "two"), start=1)},
        estimated={"x": (IntegerRange(0, 2), 0)},
        goals={"low": "x == 1", "high": "x == 2", "never": "x == 1 and x == 2"},
        priorities={"high": 1},
    )
    answer = ask(station, initial_state(station))
    assert (answer.verdict, answer.goals, set(answer.left_out)) == (Verdict.FOUND, ("high",), {"low", "never"})
    assert "never" not in answer.undecided


def test_what_is_left_out_without_a_proof_is_told_apart() -> None:
    """Counting to `far` takes more ticks than are looked at, and `dead` can never be."""
    station = automaton(
        {"count": Does(start=("n := n + 1",), when="n < 12"), "on": Does(start=("lamp := true",))},
        estimated={"n": (IntegerRange(0, 12), 0), "dead": OFF},
        output={"lamp": OFF},
        goals={"lit": "lamp", "far": "n == 12", "dead": "dead"},
        priorities={"lit": 1},
    )
    answer = ask(station, initial_state(station))
    assert (answer.verdict, answer.goals) == (Verdict.FOUND, ("lit",))
    assert (set(answer.left_out), answer.undecided) == ({"far", "dead"}, ("far",))
    alone = ask(station, initial_state(station), "far")
    assert (alone.verdict, alone.undecided) == (Verdict.NONE_UP_TO, ("far",))
    assert ask(station, initial_state(station), "dead").undecided == ()


def test_none_at_all_is_said_only_with_a_proof() -> None:
    """`a` and `b` each can be, and never together, which takes more to prove than the relaxation."""
    station = automaton(
        {
            "a": Does(start=("a := true", "b := false")),
            "b": Does(start=("a := false", "b := true")),
            "broken": Does(start=("c := true",), when="false"),
        },
        estimated={"a": OFF, "b": OFF, "c": OFF},
        goals={"both": "a and b", "dead": "c"},
    )
    assert ask(station, initial_state(station), "dead").verdict is Verdict.NONE_AT_ALL
    none = ask(station, initial_state(station), "both")
    assert none.verdict in NONE
    assert (none.verdict is Verdict.NONE_AT_ALL) is (none.proof is not None)
    assert none.searched == LONGEST


def test_a_value_computed_from_many_values_is_not_called_unreachable() -> None:
    """The sum of two variables of 100 values each has more combinations than the relaxation looks at."""
    wide = IntegerRange(0, 99)
    values: dict[str, tuple[IntegerRange, Value]] = {"x": (wide, 0), "y": (wide, 0), "sum": (IntegerRange(0, 198), 0)}
    does = {f"{name}_{n}": Does(start=(f"{name} := {n}",)) for name in ("x", "y") for n in range(1, 100)}
    does["add"] = Does(start=("sum := x + y",))
    station = automaton(does, estimated=values, goals={"reach": "sum == 197"})
    relaxed = reachable(station, initial_state(station), Circumstances())
    assert relaxed.may(station.operations["reach"].goal)


def test_a_goal_that_negates_a_conjunction_is_not_called_unreachable() -> None:
    station = automaton(
        {"stop": Does(start=("b := false",))},
        estimated={"a": (BOOLEAN, True), "b": (BOOLEAN, True)},
        goals={"reach": "not (a and b)"},
    )
    assert starts(ask(station, initial_state(station))) == [("stop",), ()]


def test_a_question_that_needs_more_starts_than_the_one_before_is_answered_too() -> None:
    """A kept solver counts starts up to a bound, which grows."""
    names = ("a", "b", "c", "d")
    station = automaton(
        {f"do_{name}": Does(start=(f"{name} := true",), when="ready") for name in names}
        | {"do_a": Does(start=("a := true",))},
        measured={"ready": OFF},
        output=dict.fromkeys(names, OFF),
        goals={"one": "a", "all": "a and b and c and d"},
    )
    planner = Planner(station, synthesise(station))
    for goal, count in (("one", 1), ("all", 4), ("one", 1), ("all", 4)):
        state = synchronise(station, sense(initial_state(station), {"ready": goal == "all"}))
        plan = planner.answer(PlanRequest(state, goals_of(station, (goal,)), deadline=60, longest=LONGEST)).plan
        assert plan is not None
        assert (len(plan.ticks), len(plan.starts), plan.minimal_starts) == (2, count, True)


def test_an_ability_starts_once_in_a_tick_also_where_the_order_of_starts_is_open() -> None:
    """`one` and `two` undo each other, so that each has several places in the order that a tick tries."""
    station = automaton(
        {
            "one": Does(start=("x := 1", "once := true", "again := true if once and x == 2")),
            "two": Does(start=("x := 2",)),
        },
        estimated={"x": (IntegerRange(0, 2), 0), "once": OFF, "again": OFF},
        goals={"reach": "again"},
    )
    ticks = starts(ask(station, initial_state(station)))
    assert len(ticks) == 3
    assert sorted(name for tick in ticks for name in tick) == ["one", "one", "two"]
    assert all(len(set(tick)) == len(tick) for tick in ticks)


def test_a_fault_is_not_counted_on() -> None:
    station = automaton(
        {"turn": Does(start=("on := true",))},
        measured={"light": OFF},
        output={"on": OFF},
        effects={"shines": ("on", ("light := true",)), "sparks": ("not light", ("light := true",))},
        faults=("sparks",),
        goals={"reach": "light"},
    )
    assert starts(ask(station, initial_state(station))) == [("turn",), ()]


def test_a_restart_ability_is_not_planned_outside_restart_mode() -> None:
    station = automaton(
        {"recover": Does(start=("on := true",), restart=True)}, output={"on": OFF}, goals={"reach": "on"}
    )
    assert ask(station, initial_state(station)).verdict is Verdict.NONE_AT_ALL


def test_effects_that_write_different_values_do_not_happen_together() -> None:
    """`left` and `right` each drop what the other needs."""
    sides = EnumerationType(("none", "left", "right"))
    station = automaton(
        {},
        measured={"side": (sides, "none"), "a": OFF, "b": OFF},
        effects={
            "left": ("side == none", ("side := left", "a := true")),
            "right": ("side == none", ("side := right", "b := true")),
        },
        goals={"reach": "a and b"},
    )
    assert ask(station, initial_state(station)).verdict in NONE


def test_of_two_conflicting_finishes_none_is_counted_on() -> None:
    station = automaton(
        {
            "one": Does(start=(), finish="done", finally_=("x := 1",)),
            "two": Does(start=(), finish="done", finally_=("x := 2",)),
        },
        measured={"done": OFF},
        estimated={"x": (IntegerRange(0, 2), 0)},
        effects={"ends": ("not done", ("done := true",))},
        goals={"reach": "x != 0"},
    )
    assert ask(station, initial_state(station)).verdict in NONE


def test_from_outside_the_safe_set_nothing_is_started() -> None:
    station = automaton(
        {"close": Does(start=("valve := false",)), "lamp": Does(start=("lit := true",))},
        output={"valve": OFF, "lit": OFF},
        forbidden={"closed": "valve"},
        goals={"reach": "lit"},
    )
    state = initial_state(station)
    assert starts(ask(station, state)) == [("lamp",), ()]
    assert ask(station, {**state, "valve": True}).verdict in NONE


def unknown_side() -> tuple[Automaton, State]:
    """Whether the part is on the left is not known."""
    station = automaton(
        {"choose": Does(start=("a := true", "b := true if left"))},
        measured={"left": OFF, "seen": OFF},
        output={"a": OFF, "b": OFF},
        effects={"looks": ("true", ("left := true", "seen := true")), "tells": ("not left or seen", ("seen := true",))},
        goals={"known": "left", "chosen": "a", "seen": "seen"},
    )
    return station, synchronise(station, sense(station.initial_valuation, {"left": None}))


def test_what_is_unknown_stays_unknown() -> None:
    station, state = unknown_side()
    assert ask(station, state, "known").verdict is Verdict.NONE_AT_ALL
    assert starts(ask(station, state, "seen")) == [()]  # the effect may well happen, and writes what is known


def test_an_ability_whose_actions_depend_on_something_unknown_is_not_started() -> None:
    station, state = unknown_side()
    assert ask(station, state, "chosen").plan is None
    known = synchronise(station, sense(state, {"left": False}))
    assert starts(ask(station, known, "chosen")) == [("choose",), ()]


class Recorded:
    """Engines that take turns, and the goals of each task that they were given."""

    def __init__(self, station: Automaton) -> None:
        self.asked: list[set[str]] = []
        self._solvers = InTurn(Engines(station, synthesise(station), ALONE))

    def solve(self, attempt: PlanningAttempt, budget: Budget) -> None:
        self.asked.append({goal.name for goal in attempt.task.goals})
        self._solvers.solve(attempt, budget)


def test_no_engine_is_asked_for_what_a_silent_device_puts_out_of_reach() -> None:
    """It would take all of its time to find no plan; that none is possible shows at once."""
    station = automaton(
        {"open": Does(start=("valve := true",), when="not hot"), "on": Does(start=("lamp := true",))},
        measured={"hot": OFF},
        output={"valve": OFF, "lamp": OFF},
        goals={"reach": "valve", "lit": "lamp"},
    )
    silent = synchronise(station, sense(initial_state(station), {"hot": None}))
    solvers = Recorded(station)
    wanted = goals_of(station, station.operations)
    answer = Planner(station, synthesise(station), solvers).answer(PlanRequest(silent, wanted, 60, longest=LONGEST))
    assert (answer.goals, answer.left_out, answer.undecided) == (("lit",), ("reach",), ())
    assert all("reach" not in goals for goals in solvers.asked)
