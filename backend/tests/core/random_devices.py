"""Random stations in the shape of real ones: devices that follow their commands, and estimates of what they have done.

Purely random models seldom need more than two starts. These need several, of different devices, in some order and with
waiting, and their specifications forbid something that matters.
"""

from __future__ import annotations

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Flag,
    Kind,
    Operation,
    Specification,
    VariableDeclaration,
)
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Or,
    Variable,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value

from .choices import Choices
from .random_expressions import Scope, equality

DEVICE_TYPES: tuple[Type, ...] = (BOOLEAN, EnumerationType(("p", "q")), EnumerationType(("q", "r", "s")))
WORK = Variable("work", IntegerRange(0, 2))
FLAGS = ("enabled", "executing", "finished")


def device_station(choices: Choices) -> Automaton:
    """Two devices, an ability for some of the values each can be told to take, and an estimate of the work done."""
    declared = {WORK.name: VariableDeclaration(WORK.name, WORK.type, Kind.ESTIMATED, 0, None)}
    devices: list[tuple[Variable, Variable]] = []
    for number in range(2):
        type_ = choices.pick(DEVICE_TYPES)
        command, report = Variable(f"command{number}", type_), Variable(f"report{number}", type_)
        initial = type_.domain[0]
        declared[command.name] = VariableDeclaration(command.name, type_, Kind.OUTPUT, initial, None)
        declared[report.name] = VariableDeclaration(report.name, type_, Kind.MEASURED, initial, None)
        devices.append((command, report))
    operations = {name: Operation(name, name, TRUE, FALSE) for name in ("g0",) if choices.chance(3)}
    for operation in operations.values():
        declared[operation.activity] = VariableDeclaration(operation.activity, BOOLEAN, Kind.ACTIVITY, False, None)
    plain = [Variable(name, variable.type) for name, variable in declared.items()]
    seen = [variable for device in devices for variable in device]
    abilities = [
        _go(choices, f"go{number}_{str(value).lower()}", device, value, plain)
        for number, device in enumerate(devices)
        for value in choices.different(device[0].type.domain, 2, 3)
    ]
    if choices.chance(2):
        abilities.append(_reset(choices, plain))
    effects = [_follow(choices, f"follow{number}", device, seen) for number, device in enumerate(devices)]
    flags = [Variable(ability.flag(which), BOOLEAN) for ability in abilities for which in FLAGS]
    return Automaton(
        name="devices",
        title="devices",
        description="",
        resources={"station": "station"},
        variables=declared,
        abilities={ability.name: ability for ability in abilities},
        flags=tuple(Flag(a.flag(which), getattr(a, which)) for a in abilities for which in FLAGS),
        effects=tuple(effects),
        specifications={
            f"s{i}": Specification(f"s{i}", f"s{i}", _forbidden(choices, plain, flags))
            for i in range(choices.number(0, 2))
        },
        rest=equality(choices, plain) if choices.chance(3) else None,
        operations=operations,
    )


def _go(choices: Choices, name: str, device: tuple[Variable, Variable], value: Value, scope: Scope) -> Ability:
    """The device is told to take `value`; when it says it has, some work may be done."""
    command, report = device
    wanted, there = (Comparison("==", variable, Constant(value)) for variable in device)
    idle = Comparison("==", command, report)
    elsewhere = Comparison("!=", report, Constant(value))
    enabled: Expression = And((idle, elsewhere)) if choices.chance(2) else Comparison("!=", command, Constant(value))
    if choices.chance(3):
        enabled = And((enabled, equality(choices, scope)))
    work = Assignment(WORK, Constant(choices.number(0, 2)), equality(choices, scope) if choices.chance(2) else None)
    executing = Variable(f"{name}.executing", BOOLEAN)
    return Ability(
        name=name,
        resource="station",
        title=name,
        enabled=enabled,
        start_guard=equality(choices, scope) if choices.chance(4) else TRUE,
        start_actions=(Assignment(command, Constant(value)),),
        executing=And((wanted, elsewhere)),
        finished=there,
        finish_guard=And((executing if choices.chance(2) else wanted, there)),
        finish_actions=(work,) if choices.chance(2) else (),
    )


def _reset(choices: Choices, scope: Scope) -> Ability:
    """Done at its start: the work is taken away."""
    return Ability(
        name="reset",
        resource="station",
        title="reset",
        enabled=Comparison("==", WORK, Constant(choices.number(1, 2))),
        start_guard=equality(choices, scope) if choices.chance(2) else TRUE,
        start_actions=(Assignment(WORK, Constant(0)),),
        executing=FALSE,
        finished=FALSE,
        finish_guard=None,
        finish_actions=(),
    )


def _follow(choices: Choices, name: str, device: tuple[Variable, Variable], seen: Scope) -> Effect:
    """The device takes the value it is told to; now and then only while something else holds."""
    command, report = device
    behind: Expression = Comparison("!=", command, report)
    if choices.chance(3):
        behind = And((behind, Or((equality(choices, seen), equality(choices, seen)))))
    return Effect(name, "station", "executing", behind, (Assignment(report, command),))


def _forbidden(choices: Choices, plain: Scope, flags: Scope) -> Expression:
    return And((equality(choices, plain), equality(choices, plain), equality(choices, [*plain, *flags])))
