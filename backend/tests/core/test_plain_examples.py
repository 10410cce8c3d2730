"""Plain automata as people write them: two users of one thing, philosophers, counters."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any

import pytest

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.evaluator import holds
from sequence_planner.language.printer import print_expression
from sequence_planner.model.efa_document import read_plain
from sequence_planner.planning.efa_planner import plan_transitions
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.problem import Verdict, goals_of
from sequence_planner.synthesis.supervisor import Supervision, SynthesisError, relevant, synthesise
from sequence_planner.synthesis.transition_relation import Plant

Transition = dict[str, Any]


def event(name: str, guard: str, updates: dict[str, object], controllable: bool = True) -> Transition:
    return {"event": name, "controllable": controllable, "guard": guard, "set": updates}


def read(**entries: object) -> Automaton:
    return plain_automaton(read_plain(json.dumps({"name": "example", **entries}, indent=1), "example.efa.json"))


def supervised(automaton: Automaton) -> Supervision:
    return Supervision(Plant(automaton, relevant(automaton)))


def two_users() -> Automaton:
    """Of one thing; each asks for it and gives it back when it likes. `n` counts up to 3, then the thing is cleaned."""
    return read(
        variables={u: ["idle", "waits", "has"] for u in ("u1", "u2")} | {"free": "bool", "n": {"min": 0, "max": 3}},
        initial="u1 == idle and u2 == idle and free and n == 0",
        transitions=[event("cleans", "n == 3 and free", {"n": 0})]
        + [
            transition
            for u in ("u1", "u2")
            for transition in (
                event(f"{u}_asks", f"{u} == idle", {u: "waits"}, False),
                event(f"{u}_grabs", f"{u} == waits", {u: "has", "free": False, "n": "n + 1"}),
                event(f"{u}_drops", f"{u} == has", {u: "idle", "free": True}, False),
            )
        ],
        forbidden=["u1 == has and u2 == has"],
        marked="u1 == idle",
        goal=["F (u1 == has)", "F (u2 == has)", "F (n == 3)", "G (n < 3)", "F (u1 == has and u2 == has)"],
    )


def philosophers(number: int) -> Automaton:
    """Each takes the left fork, then the right one. `N` thinks, `L` has the left one, `R` has both."""
    names = [f"p{i}" for i in range(number)]
    forks = [f"f{i}" for i in range(number)]
    transitions = []
    for i, p in enumerate(names):
        left, right = forks[i], forks[(i + 1) % number]
        transitions += [
            event(f"left{i}", f"{p} == N and {left}", {p: "L", left: False}),
            event(f"right{i}", f"{p} == L and {right}", {p: "R", right: False}),
            event(f"back{i}", f"{p} == R", {p: "N", left: True, right: True}, False),
        ]
    return read(
        variables={p: ["N", "L", "R"] for p in names} | dict.fromkeys(forks, "bool"),
        initial=" and ".join([*(f"{p} == N" for p in names), *forks]),
        transitions=transitions,
        marked=" and ".join(f"{p} == N" for p in names),
        goal=["F (p1 == R)"],
    )


def planned(
    automaton: Automaton, goal: str, supervisor: Supervisor | None = None, state: State | None = None
) -> PlainAnswer:
    return plan_transitions(automaton, supervisor or synthesise(automaton), goals_of(automaton, (goal,)), state)


def test_the_second_user_must_wait_until_the_first_has_given_the_thing_back() -> None:
    automaton = two_users()
    supervisor = synthesise(automaton)
    state = dict(automaton.initial_valuation) | {"u1": "waits", "u2": "has", "free": False, "n": 1}
    assert not supervisor.guards["u1_grabs"].includes(state)
    assert supervisor.guards["u1_grabs"].includes(state | {"u2": "idle", "free": True})


def test_an_update_out_of_range_disables_its_transition() -> None:
    automaton = two_users()
    assert print_expression(automaton.abilities["u1_grabs"].start_guard) == "u1 == waits and n + 1 <= 3"
    counter = read(
        variables={"n": {"min": 0, "max": 3}},
        initial="n == 0",
        marked="n == 0",
        transitions=[event("up", "true", {"n": "n + 1"}), event("down", "true", {"n": "n - 1"}, False)],
    )
    supervision = supervised(counter)
    assert supervision.plant.diagrams.count(supervision.reachable(supervised=True)) == 4


def test_plans_are_sequences_of_events_in_which_the_environment_helps() -> None:
    automaton = two_users()
    supervisor = synthesise(automaton)
    answer = planned(automaton, "goal_1", supervisor)
    assert answer.events == ("u1_asks", "u1_grabs")
    thrice = planned(automaton, "goal_3", supervisor)
    assert [e.partition("_")[2] for e in thrice.events].count("grabs") == 3
    # Only those of the form F p can be planned; all are kept.
    assert set(automaton.operations) == {"goal_1", "goal_2", "goal_3", "goal_5"}
    assert len(automaton.goals) == 5


def test_no_plan_goes_against_the_supervisor() -> None:
    automaton = two_users()
    answer = planned(automaton, "goal_5")
    assert answer.verdict is Verdict.NONE_AT_ALL
    assert answer.proof is not None
    assert answer.transitions == ()


def test_a_goal_that_holds_needs_no_transition_and_outside_the_safe_set_nothing_is_planned() -> None:
    automaton = two_users()
    state = dict(automaton.initial_valuation) | {"u1": "has", "free": False}
    answer = planned(automaton, "goal_1", state=state)
    assert (answer.verdict, answer.transitions, answer.minimal) == (Verdict.FOUND, (), True)
    with pytest.raises(ValueError, match="outside the safe set"):
        planned(automaton, "goal_1", state=state | {"u2": "has"})


@pytest.mark.parametrize("number", [2, 3])
def test_philosophers_never_each_hold_one_fork(number: int) -> None:
    """Then nobody could go on. All else stays possible: the supervisor removes exactly that state."""
    automaton = philosophers(number)
    found = supervised(automaton)
    removed = found.reachable(supervised=False) & ~found.reachable(supervised=True)
    [state] = found.plant.diagrams.exported(removed, automaton.variables).members()
    assert {state[f"p{i}"] for i in range(number)} == {"L"}
    assert planned(automaton, "goal_1").events == ("left1", "right1")


def test_of_two_transitions_that_exclude_each_other_only_one_happens() -> None:
    """One at a time: in a tick, effects of both could happen together."""
    automaton = read(
        variables={"a": "bool", "b": "bool"},
        initial="not a and not b",
        transitions=[event("left", "not b", {"a": True}, False), event("right", "not a", {"b": True}, False)],
        forbidden=["a and b"],
        goal=["F (a and b)"],
    )
    supervisor = synthesise(automaton)
    assert supervisor.safe.includes(automaton.initial_valuation)
    found = supervised(automaton)
    assert found.plant.diagrams.count(found.reachable(supervised=True)) == 3
    free = read(
        variables={"a": "bool", "b": "bool"},
        initial="not a and not b",
        transitions=[event("left", "not b", {"a": True}, False), event("right", "not a", {"b": True}, False)],
        goal=["F (a and b)"],
    )
    assert planned(free, "goal_1").verdict is Verdict.NONE_AT_ALL


def test_every_initial_state_must_be_safe() -> None:
    entries: dict[str, Any] = {
        "variables": {"a": "bool", "hot": "bool"},
        "transitions": [event("heats", "a", {"hot": True}, False)],
        "forbidden": ["hot"],
    }
    assert synthesise(read(initial="not hot and not a", **entries))
    with pytest.raises(SynthesisError) as error:
        synthesise(read(initial="not hot", **entries))
    assert str(error.value).splitlines() == [
        "specification forbidden_1 cannot be met: no start could prevent this from the initial state on",
        "  step 1: hot := true",
        "  violated with a = true, hot = true",
    ]


def test_initial_states_are_found_among_more_than_could_be_enumerated() -> None:
    names = [f"x{i}" for i in range(60)]
    alike = " and ".join(f"{one} == {other}" for one, other in pairwise(names))
    automaton = read(variables=dict.fromkeys(names, "bool"), initial=f"{alike} and x59")
    assert automaton.initial is None
    assert all(automaton.variables[name].initial is True for name in names)
    several = read(variables=dict.fromkeys(names, "bool"), initial=alike)
    assert several.initial is not None
    assert holds(several.initial, several.initial_valuation)


def test_many_states_are_no_obstacle() -> None:
    names = [f"x{i}" for i in range(60)]
    transitions = [event(f"sets_{name}", f"not {name}", {name: True}) for name in names]
    automaton = read(
        variables=dict.fromkeys(names, "bool"),
        initial=f"not ({' and '.join(names)})",
        transitions=transitions,
        forbidden=[" and ".join(names)],
    )
    found = supervised(automaton)
    assert found.plant.diagrams.count(found.reachable(supervised=True)) == 2**60 - 1
    assert set(synthesise(automaton).guards) == {f"sets_{name}" for name in names}


@pytest.mark.parametrize("value", [4, "4", "n + 9", "n - 4", "m + 2"])
def test_an_update_that_can_never_fit_disables_its_transition(value: object) -> None:
    automaton = read(
        variables={"n": {"min": 0, "max": 3}, "m": {"min": 5, "max": 9}},
        initial="n == 0 and m == 5",
        transitions=[event("leaps", "true", {"n": value})],
    )
    assert print_expression(automaton.abilities["leaps"].start_guard) == "false"


def counter(initial: str, most: int = 10) -> Automaton:
    return read(
        variables={"n": {"min": 0, "max": most}, "free": "bool"},
        initial=initial,
        transitions=[event("up", "free", {"n": "n + 1"})],
        goal=["F (n == 9)", "F (n == 0)"],
    )


def test_of_several_initial_states_the_best_is_begun_with() -> None:
    """It once was planned from one of them alone, and said to be the fewest, or none at all."""
    answer = planned(counter("n < 5 or (n == 7 and free)"), "goal_1")
    assert (answer.events, answer.minimal, answer.begin) == (("up", "up"), True, {"n": 7, "free": True})
    holds_there = planned(counter("n <= 5"), "goal_2")
    assert (holds_there.transitions, holds_there.minimal) == ((), True)
    assert holds_there.begin is not None
    assert holds_there.begin["n"] == 0
    assert planned(counter("n > 3 and not free and n < 9"), "goal_1").verdict is Verdict.NONE_AT_ALL
    assert planned(counter("n == 7 and free"), "goal_1").begin is None, "there is no other"


def test_more_initial_states_than_can_be_planned_from_are_refused() -> None:
    with pytest.raises(ValueError, match="`initial` describes more than 100 states: say with --state in which one"):
        planned(counter("free", 500), "goal_1")
    assert planned(counter("free", 500), "goal_1", state={"n": 8, "free": True}).events == ("up",)
