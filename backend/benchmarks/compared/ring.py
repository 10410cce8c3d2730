"""A station of any size, shaped like real ones: a ring of resources that look at themselves and at their neighbour."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    Operation,
    VariableDeclaration,
)
from sequence_planner.automaton.dependencies import ordered_flags
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.resolver import resolve_assignment, resolve_predicate
from sequence_planner.language.syntax import Expression
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value

POSES = EnumerationType(("home", "above", "at_work", "between"))
PARTS = EnumerationType(("none", "placed", "done"))
FLAGS = ("enabled", "executing", "finished")
VARIABLES: Mapping[str, tuple[Kind, Type, Value]] = {
    "pose": (Kind.MEASURED, POSES, "home"),
    "running": (Kind.MEASURED, BOOLEAN, False),
    "torque": (Kind.MEASURED, BOOLEAN, False),
    "stock": (Kind.MEASURED, IntegerRange(0, 4), 4),
    "target": (Kind.OUTPUT, POSES, "home"),
    "run": (Kind.OUTPUT, BOOLEAN, False),
    "part": (Kind.ESTIMATED, PARTS, "none"),
}
TRANSITIONS_EACH = 18  # of a resource: 6 starts, 4 finishes, 8 effects


class Does(NamedTuple):
    """An ability as an engineer writes it; `next` is the neighbour."""

    enabled: str
    guard: str
    start: str
    executing: str
    finished: str
    finish: str | None = None
    finally_: tuple[str, ...] = ()
    effects: Mapping[str, tuple[str, str]] = {}


def _move(pose: str) -> Does:
    return Does(
        enabled=f"pose == target and pose != {pose} and pose != between and not work.executing",
        guard="next.pose != at_work or part == placed",
        start=f"target := {pose}",
        executing=f"target == {pose} and pose != {pose}",
        finished=f"target == {pose} and pose == {pose}",
        finish=f"executing and pose == {pose}",
        effects={
            "leave": (f"target == {pose} and not pose in {{{pose}, between}}", "pose := between"),
            "arrive": (f"target == {pose} and pose == between", f"pose := {pose}"),
        },
    )


ABILITIES: Mapping[str, Does] = {
    **{f"move_to_{pose}": _move(pose) for pose in ("home", "above", "at_work")},
    "work": Does(
        enabled="part == placed and not run and not running",
        guard="pose == at_work and target == at_work and not next.work.executing",
        start="run := true",
        executing="run and running and not torque",
        finished="torque",
        finish="run and torque",
        finally_=("run := false", "part := done"),
        effects={"reach": ("run and running and not torque", "torque := true")},
    ),
    "place": Does(
        enabled="part == none and stock > 0",
        guard="pose in {home, above} and next.stock + 1 >= stock",
        start="part := placed",
        executing="false",
        finished="part != none",
    ),
    "remove": Does(
        enabled="part == done",
        guard="pose == home and not work.executing and next.part != placed",
        start="part := none",
        executing="false",
        finished="part == none",
        effects={"refill": ("stock < 4 and part == none", "stock := 4")},
    ),
}


def ring(transitions: int) -> Automaton:
    """A station of about so many transitions: starts, finishes and effects."""
    resources = [f"resource_{number}" for number in range(max(2, round(transitions / TRANSITIONS_EACH)))]
    declared = {
        f"{resource}.{name}": VariableDeclaration(f"{resource}.{name}", type_, kind, initial, resource)
        for resource in resources
        for name, (kind, type_, initial) in VARIABLES.items()
    }
    types = {name: declaration.type for name, declaration in declared.items()}
    types |= {f"{resource}.{name}.{flag}": BOOLEAN for resource in resources for name in ABILITIES for flag in FLAGS}
    abilities: dict[str, Ability] = {}
    effects: list[Effect] = []
    operations: dict[str, Operation] = {}
    for resource, following in zip(resources, (*resources[1:], resources[0]), strict=True):
        for name, does in ABILITIES.items():
            words = _Words(types, resource, name, following)
            abilities[f"{resource}.{name}"] = words.ability(does)
            effects += words.effects(does)
        words = _Words(types, resource, "", following)
        name = f"{resource}_works"
        operations[name] = Operation(name, name, words.predicate("part == placed"), words.predicate("part == done"))
    flags, circle = ordered_flags(
        [Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS]
    )
    assert not circle
    return Automaton(
        name="ring",
        title="ring",
        description="",
        resources={resource: resource for resource in resources},
        variables=declared,
        abilities=abilities,
        flags=flags,
        effects=tuple(effects),
        operations=operations,
    )


class _Words:
    """What the words of an ability mean in its place in the ring."""

    def __init__(self, types: Mapping[str, Type], resource: str, ability: str, following: str) -> None:
        self._scope = NameScope(types, (f"{resource}.{ability}.", f"{resource}."))
        self._resource, self._name, self._following = resource, f"{resource}.{ability}", following

    def ability(self, does: Does) -> Ability:
        return Ability(
            name=self._name,
            resource=self._resource,
            title=self._name,
            enabled=self.predicate(does.enabled),
            start_guard=self.predicate(does.guard),
            start_actions=(resolve_assignment(parse_assignment(does.start), self._scope),),
            executing=self.predicate(does.executing),
            finished=self.predicate(does.finished),
            finish_guard=None if does.finish is None else self.predicate(does.finish),
            finish_actions=tuple(resolve_assignment(parse_assignment(action), self._scope) for action in does.finally_),
        )

    def effects(self, does: Does) -> list[Effect]:
        return [
            Effect(
                f"{self._name}.{name}",
                self._resource,
                "executing",
                self.predicate(guard),
                (resolve_assignment(parse_assignment(action), self._scope),),
            )
            for name, (guard, action) in does.effects.items()
        ]

    def predicate(self, text: str) -> Expression:
        return resolve_predicate(parse(text.replace("next.", f"{self._following}.")), self._scope)
