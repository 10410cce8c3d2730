"""What the supervisor makes impossible: against all that the reference can reach, and in small stations."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given

from checks.small import DEVICE, station
from core.choices import Choices, made_by
from core.explicit import Explicit, Key, outcomes
from core.plain_questions import meant, read
from core.random_devices import device_station
from core.random_expressions import equality, rare
from core.random_plain import document
from core.random_stations import automaton as random_automaton
from core.replaying import replay
from sequence_planner.analysis.checks import large_reachability
from sequence_planner.analysis.checks import supervised as checking
from sequence_planner.analysis.checks.supervised import check_supervision
from sequence_planner.analysis.checks.warning import ModelWarning
from sequence_planner.automaton.automaton import Ability, Automaton, HumanTask, Operation
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import Expression, Variable
from sequence_planner.language.types import BOOLEAN, IntegerRange
from sequence_planner.synthesis.supervisor import supervised, supervisor
from sequence_planner.synthesis.traces import StepKind
from support.automata import Does, automaton
from support.examples import examples
from support.told import as_message

OFF = (BOOLEAN, False)


def found(station: Automaton) -> list[ModelWarning]:
    warnings = check_supervision(station, supervised(station))
    for each in warnings:
        as_message(each.message)
    return warnings


def with_operations(choices: Choices) -> Automaton:
    """A random station, of which each operation has a precondition and a goal."""
    made = device_station(choices) if choices.chance(2) else random_automaton(choices)
    scope = [Variable(name, variable.type) for name, variable in made.variables.items()]
    operations = {
        name: Operation(name, name, equality(choices, scope), rare(choices, scope)) for name in ("g0", "g1", "g2")
    }
    return replace(made, operations=operations)


@dataclass(frozen=True)
class Expected(Explicit):
    """What the definition says of a station whose initial state is safe."""

    def closure(self, uncontrollable: Mapping[Key, frozenset[Key]], safely: bool) -> frozenset[Key]:
        reached, pending = {self.initial}, [self.initial]
        while pending:
            key = pending.pop()
            allowed = {after for after in self.starts[key].values() if not safely or after in self.safe}
            more = (uncontrollable[key] | allowed) - reached
            reached |= more
            pending.extend(more)
        return frozenset(reached)

    @cached_property
    def all_ways(self) -> frozenset[Key]:
        return self.closure(self.uncontrollable, safely=False)

    @cached_property
    def safe_ways(self) -> frozenset[Key]:
        return self.closure(self.uncontrollable, safely=True)

    def where(self, predicate: Expression) -> frozenset[Key]:
        return frozenset(key for key, state in self.states.items() if holds(predicate, state))

    def start(self, ability: Ability) -> str | None:
        """What should be found of the start of an ability."""
        if any(self.starts[key].get(ability.name) in self.safe for key in self.safe_ways):
            return None
        if any(ability.name in self.starts[key] for key in self.all_ways):
            return "never-allowed"
        return "never-starts"

    def operation(self, operation: Operation) -> str | None:
        """What should be found of an operation."""
        active, goal = self.where(operation.precondition), self.where(operation.goal)
        if not active & self.safe_ways:
            return "never-active"
        if not goal & self.closure(self.helpful, safely=True) and goal & self.closure(self.helpful, safely=False):
            return "goal-lost"
        return None if active & self.safe_ways <= self.completing(goal) else "goal-out-of-reach"

    def completing(self, goal: frozenset[Key]) -> frozenset[Key]:
        """From where the goal can be reached so that it holds after step 3 of a tick."""
        helpful = [effect for effect in self.automaton.effects if not effect.fault]
        ticks = {
            key: {self.key(after) for after in outcomes(self.automaton, self.states[key], helpful)} for key in self.safe
        }
        kept = {key for key in self.safe if ticks[key] & goal & self.safe}
        while more := {key for key in self.safe - kept if (self.helpful[key] | set(self.starts[key].values())) & kept}:
            kept |= more
        return frozenset(kept | (goal & self.safe))


@examples(120)
@given(made_by(with_operations))
def test_what_is_found_is_what_the_definition_says(made: Automaton) -> None:
    """What nothing brings about, with or without supervisor, need not be said: other checks may. Nor need what lies
    beyond states that are not safe, if something else is said for the same cause.
    """
    expected = Expected(made)
    assume(expected.initial in expected.safe)
    kinds = {name_of(warning): warning.kind for warning in found(made)}
    prevented = bool({"never-allowed", "never-active", "goal-lost"} & set(kinds.values()))
    for ability in made.abilities.values():
        kind = None if ability.restart else expected.start(ability)
        beyond = prevented and not any(ability.name in expected.starts[key] for key in expected.safe_ways)
        optional = kind == "never-starts" or (kind == "never-allowed" and beyond)
        assert kinds.pop(ability.name, None) in ({kind, None} if optional else {kind})
    for operation in made.operations.values():
        kind = expected.operation(operation)
        nowhere = not expected.where(operation.precondition) & expected.all_ways or not (
            expected.where(operation.goal) & expected.closure(expected.helpful, safely=False)
        )
        optional = nowhere or (kind == "never-active" and prevented)
        assert kinds.pop(operation.name, None) in ({kind, None} if optional else {kind})
    assert not kinds


@examples(60)
@given(made_by(with_operations))
def test_traces_of_findings_replay_and_end_where_they_say(made: Automaton) -> None:
    expected = Expected(made)
    assume(expected.initial in expected.safe)
    for warning in found(made):
        if warning.trace is None:
            assert warning.kind in {"never-starts", "never-active"}
            continue
        states = replay(made, warning.trace)
        last, name = states[-1], name_of(warning)
        match warning.kind:
            case "never-allowed" if "guards hold only" in warning.message:
                assert name in expected.starts[expected.key(last)]
            case "never-allowed":
                begin = next(
                    n for n, step in enumerate(warning.trace.steps) if expected.key(step.state) not in expected.safe
                )
                assert warning.trace.steps[begin].names == (name,)
                assert StepKind.START not in {step.kind for step in warning.trace.steps[begin + 1 :]}
            case "never-active":
                assert holds(made.operations[name].precondition, last)
                assert expected.key(last) not in expected.safe
            case "goal-lost":
                assert holds(made.operations[name].goal, last)
                assert any(expected.key(state) not in expected.safe for state in states)
            case _:
                assert holds(made.operations[name].precondition, last)
                assert {expected.key(state) for state in states} <= expected.safe


@examples(100)
@given(made_by(document))
def test_what_is_found_of_plain_automata_is_what_the_definition_says(written: dict[str, Any]) -> None:
    explicit, made = meant(written)
    assume(made is not None and explicit.initial <= explicit.safe)
    assert made is not None
    warnings = found(made)
    kinds = {name_of(warning): warning.kind for warning in warnings}
    for warning in warnings:
        assert warning.trace is None or replay(made, warning.trace)
    inside, anywhere = (explicit.distances(explicit.initial, supervised) for supervised in (True, False))
    for event in {each["event"] for each in written["transitions"] if each["controllable"]}:
        taken = [explicit.taken(each) for each in written["transitions"] if each["event"] == event]
        expected: set[str | None]
        if any(ways[key] in explicit.safe for ways in taken for key in ways.keys() & inside.keys()):
            expected = {None}
        elif any(ways.keys() & inside.keys() for ways in taken):
            expected = {"never-allowed"}
        elif any(ways.keys() & anywhere.keys() for ways in taken):
            expected = {"never-allowed", None} if kinds else {"never-allowed"}
        else:
            expected = {"never-starts"}
        assert kinds.pop(event, None) in expected
    (goal,) = made.operations.values()
    reached = [any(holds(goal.goal, explicit.valuation(key)) for key in keys) for keys in (inside, anywhere)]
    assert kinds.pop(goal.name, None) == (None if reached[0] else "goal-lost" if reached[1] else "goal-out-of-reach")
    assert not kinds


def name_of(warning: ModelWarning) -> str:
    named = re.match(r"`([^`]+)`", warning.message)
    assert named is not None
    return named[1]


def kinds_of(warnings: Iterable[ModelWarning]) -> list[tuple[str, str]]:
    return [(name_of(warning), warning.kind) for warning in warnings]


def test_an_ability_that_the_supervisor_never_allows_is_shown_with_what_would_follow() -> None:
    made = automaton(
        {"open": Does(start=("valve := true",)), "aim": Does(start=("aimed := true",))},
        measured={"burst": OFF},
        output={"valve": OFF, "aimed": OFF},
        effects={"bursts": ("valve", ("burst := true",))},
        forbidden={"no_burst": "burst"},
    )
    (warning,) = found(made)
    assert (name_of(warning), warning.kind) == ("open", "never-allowed")
    assert "it would lead to what `no_burst` forbids" in warning.message
    assert warning.trace is not None
    assert warning.trace.lines() == [
        "start 1: open: valve := true",
        "tick 2: burst := true (bursts), which no_burst forbids",
    ]


def test_what_only_follows_from_another_finding_is_left_out() -> None:
    made = automaton(
        {"open": Does(start=("valve := true",)), "fill": Does(start=("full := true",), enabled="valve")},
        output={"valve": OFF},
        estimated={"full": OFF},
        forbidden={"closed": "valve"},
        goals={"filled": "full"},
    )
    assert kinds_of(found(made)) == [
        ("filled", "goal-lost"),
        ("open", "never-allowed"),
    ]
    assert kinds_of(found(replace(made, specifications={}))) == []


def test_what_never_starts_though_each_of_its_words_can_come_true() -> None:
    """The relaxation of the other checks lets both devices be at the table at once, as they are there in turn."""
    made = automaton(
        {
            "left": Does(start=("at := 1",), enabled="at == 0"),
            "back": Does(start=("at := 0", "turned := true"), enabled="at == 1"),
            "again": Does(start=("at := 1", "turned := false"), enabled="at == 0"),
            "odd": Does(start=("at := 0",), enabled="at == 1 and turned"),
        },
        output={"at": (IntegerRange(0, 1), 0)},
        estimated={"turned": OFF},
    )
    made = replace(made, abilities={name: each for name, each in made.abilities.items() if name != "left"})
    (warning,) = found(made)
    assert (name_of(warning), warning.kind, warning.trace) == ("odd", "never-starts", None)
    assert "`at == 1 and turned` holds in no state that can be reached" in warning.message


def test_faults_and_abilities_for_restarts_can_enable_but_are_not_counted_on() -> None:
    def made(faults: tuple[str, ...], restart: bool) -> Automaton:
        return automaton(
            {
                "repair": Does(start=("broken := false",), enabled="worn", restart=restart),
                "note": Does(start=("noted := true",), enabled="worn"),
            },
            measured={"worn": OFF},
            estimated={"broken": (BOOLEAN, True), "noted": OFF},
            effects={"wears": ("true", ("worn := true",))},
            faults=faults,
            goals={"repaired": "not broken"},
        )

    assert found(made((), restart=False)) == []
    for unreliable in (made(("wears",), restart=False), made((), restart=True)):
        assert kinds_of(found(unreliable)) == [("repaired", "goal-out-of-reach")]


def test_a_goal_that_only_a_fault_puts_out_of_reach_is_said_to_be_so_and_that_a_person_may_have_meant_it() -> None:
    made = automaton(
        {"work": Does(start=("done := true",), enabled="not away")},
        measured={"away": OFF},
        estimated={"done": OFF},
        effects={"leaves": ("not away", ("away := true",))},
        faults=("leaves",),
        goals={"made": "done"},
    )
    (warning,) = found(made)
    assert (name_of(warning), warning.kind) == ("made", "goal-out-of-reach")
    assert "once there was the fault `leaves`, which nobody counts on" in warning.message
    by_hand = {name: replace(each, human=HumanTask("Do it.", "away")) for name, each in made.abilities.items()}
    (warning,) = found(replace(made, abilities=by_hand))
    assert "once a person has done `leaves`" in warning.message
    assert "That is as it should be where the person meant it" in warning.message


def test_the_events_and_goals_of_a_plain_automaton() -> None:
    """Two transitions of one event: it is enough that one of them can be taken."""
    entries: dict[str, Any] = {
        "name": "plain",
        "variables": {"at": {"min": 0, "max": 3}},
        "initial": "at == 0",
        "transitions": [
            {"event": "go", "controllable": True, "guard": "at == 0", "set": {"at": 1}},
            {"event": "go", "controllable": True, "guard": "at == 2", "set": {"at": 3}},
            {"event": "jump", "controllable": True, "guard": "at == 1", "set": {"at": 2}},
        ],
        "goal": ["F (at == 3)", "F (at == 1)"],
    }
    assert found(read(entries)) == []
    warnings = found(read({**entries, "forbidden": ["at == 2"]}))
    assert kinds_of(warnings) == [("jump", "never-allowed"), ("goal_1", "goal-lost")]
    assert warnings[0].trace is not None
    assert warnings[0].trace.lines() == ["step 1: go: at := 1", "step 2: jump: at := 2, which forbidden_1 forbids"]
    assert warnings[1].place.line > warnings[0].place.line


def test_what_never_happens_in_a_plain_automaton() -> None:
    """No other check looks at it, so that it is said here however plain it is."""
    written: dict[str, Any] = {
        "name": "plain",
        "variables": {"at": {"min": 0, "max": 3}},
        "initial": "at <= 1",
        "transitions": [
            {"event": "go", "controllable": True, "guard": "at == 0", "set": {"at": 1}},
            {"event": "jump", "controllable": True, "guard": "at == 2", "set": {"at": 3}},
        ],
        "goal": ["F (at == 3)"],
    }
    assert kinds_of(found(read(written))) == [("jump", "never-starts"), ("goal_1", "goal-out-of-reach")]


def test_of_what_is_too_much_to_find_out_it_is_said_that_it_is_not_known(monkeypatch: pytest.MonkeyPatch) -> None:
    made = automaton(
        {name: Does(start=(f"{name}_done := true",), enabled=f"not {name}_done") for name in ("one", "two")},
        estimated={"one_done": OFF, "two_done": OFF},
    )
    assert found(made) == []
    monkeypatch.setattr(checking, "MOST_EFFORT", 0)
    monkeypatch.setattr(checking, "MOST_EFFORT_IN_PARTS", 0)
    supervision = supervised(made)
    assert check_supervision(made, supervision, supervisor(supervision)) == []  # from afar it can still be known
    monkeypatch.setattr(large_reachability, "MOST_EFFORT", 0)
    assert check_supervision(made, supervision, supervisor(supervision)) == found(made)
    (warning,) = found(made)
    assert warning.kind == "too-many-states"
    assert warning.message.startswith("of `one`, `two` it is not known whether they are always possible")


def test_parts_are_looked_at_where_the_whole_is_too_much(monkeypatch: pytest.MonkeyPatch) -> None:
    made = automaton(
        {"open": Does(start=("valve := true",)), "aim": Does(start=("aimed := true",))},
        output={"valve": OFF, "aimed": OFF},
        forbidden={"closed": "valve"},
    )
    monkeypatch.setattr(checking, "MOST_EFFORT", 0)
    assert kinds_of(found(made)) == [("open", "never-allowed")]


def test_instances_of_which_the_same_is_said_are_named_together(tmp_path: Path) -> None:
    resource = """
measured: {stuck: {type: bool}}
output: {at: {type: place}}
abilities:
  go:
    parameters: {to: place}
    enabled: at != to
    start: {do: [at := to]}
"""
    apart = "left_only:\n  forbidden: robot.at != left\n"
    (warning,) = found(station(tmp_path, {"robot": resource}, specifications=apart))
    assert warning.message.startswith("for all to in {right, between}: `robot.go(to)` never starts, as the supervisor")
    assert warning.members == ("robot.go(right)", "robot.go(between)")
    assert warning.place.file.endswith("robot.yaml")


@pytest.mark.parametrize(
    ("specifications", "said"),
    [
        ("no_blank: {forbidden: count == 2 and part}", "`no_blank` forbids it"),
        ("one: {forbidden: count == 2 and device.on}\ntwo: {forbidden: count > 1 and not device.on}", "it is so in no"),
        # While the device is on, nothing is brought; that it is seen to be off is enough.
        ("not_now: {forbidden: count == 2 and device.on}", ""),
        ("other: {forbidden: count == 3 and part}", ""),
    ],
)
def test_a_product_that_is_safe_in_no_state(tmp_path: Path, specifications: str, said: str) -> None:
    documents = {
        "operations": "make: {precondition: count == 2, goal: count == 0}",
        "work_masters": "another: {sequence: make}\nmade:\n  brings: [count := 2, part := true]\n  sequence: make",
        "specifications": specifications,
    }
    ready = "  reset: {enabled: count == 2 and not on, start: {do: [count := 0, part := false]}}\n"
    warnings = found(station(tmp_path, {"device": DEVICE + ready}, **documents))
    told = [each for each in warnings if "no job" in each.message]
    assert bool(told) is bool(said)
    for each in told:
        assert (each.kind, each.place.line, each.place.column) == ("never-allowed", 3, 12)
        assert Path(each.place.file).name == "work_masters.yaml"
        assert (
            f"no job of `made` ever begins: its product brings `count == 2 and part == true`, and {said}"
            in each.message
        )
