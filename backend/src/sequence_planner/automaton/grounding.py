"""From documents to the automaton: names resolved, parameters replaced by values, types checked."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import product

from sequence_planner.automaton.dependencies import ordered_flags
from sequence_planner.automaton.structure import (
    Ability,
    Automaton,
    Effect,
    Flag,
    HumanTask,
    Kind,
    Operation,
    Specification,
    Timeouts,
    VariableDeclaration,
    target,
)
from sequence_planner.expressions.lexer import KEYWORDS, MOST_DIGITS
from sequence_planner.expressions.parser import parse, parse_assignment
from sequence_planner.expressions.resolution import Scope, resolve_assignment, resolve_predicate, suggestion
from sequence_planner.expressions.simplification import simplify, simplify_assignment
from sequence_planner.expressions.syntax import (
    FALSE,
    TRUE,
    Assignment,
    Constant,
    Expression,
    ExpressionError,
    occurrences,
)
from sequence_planner.expressions.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value, contains
from sequence_planner.model.documents import (
    AbilityDocument,
    EffectDocument,
    Parameters,
    Predicate,
    VariableDocument,
)
from sequence_planner.model.loading import Station
from sequence_planner.model.source import Finding, ModelError, Place, SourceText

FLAGS = ("enabled", "executing", "finished")
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_RANGE = re.compile(r"(-?[0-9]{1,18})\s*\.\.\s*(-?[0-9]{1,18})")
MOST_VALUES = 1000  # of a range; every value costs memory in plans and supervisors

_KINDS = {
    Kind.MEASURED: "a measured variable",
    Kind.OUTPUT: "an output variable",
    Kind.ESTIMATED: "an estimated variable",
}

WRITTEN_KINDS = (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)

Binding = Mapping[str, tuple[str, EnumerationType]]


def ground(station: Station) -> Automaton:
    """The automaton that `station` means. Raises `ModelError` with all findings."""
    grounding = _Grounding(station)
    automaton = grounding.automaton()
    if grounding.findings:
        raise ModelError(grounding.findings)
    return automaton


def instance_name(name: str, values: Iterable[str], indexed: bool = False) -> str:
    """The name of a ground instance: `move_to_position(home)`, or `bolts[bolt_pair_1]` for a variable."""
    arguments = ", ".join(values)
    if not arguments:
        return name
    return f"{name}[{arguments}]" if indexed else f"{name}({arguments})"


def _without_arguments(name: str) -> str:
    return re.sub(r"[\[(][^\])]*[\])]", "", name)


def _readable(text: str, binding: Binding) -> str:
    """`text` with `{parameter}` replaced by its value in plain words."""
    for name, (value, _) in binding.items():
        text = text.replace(f"{{{name}}}", value.replace("_", " "))
    return text


class _Grounding:
    def __init__(self, station: Station) -> None:
        self._station = station
        self.findings: list[Finding] = []
        self._enumerations: dict[str, EnumerationType] = {}
        self._variables: dict[str, VariableDeclaration] = {}
        self._places: dict[str, Place] = {}
        self._broken: set[str] = set()  # declared, but of no usable type: their uses are not wrong as well
        self._types: dict[str, Type] = {}

    def automaton(self) -> Automaton:
        station = self._station
        self._check_resources()
        self._read_enumerations()
        self._read_variables()
        self._declare_flags()
        abilities: dict[str, Ability] = {}
        effects: dict[tuple[object, ...], Effect] = {}
        for resource, name, document, binding in self._abilities():
            ability = self._ability(resource, name, document, binding)
            abilities[ability.name] = ability
            scope = self._scope(binding, f"{ability.name}.", f"{resource}.")
            for effect_name, effect_document in document.effects.items():
                effect = self._effect(f"{ability.name}.{effect_name}", resource, effect_document, scope)
                # One reaction of a device, said once for each value of a parameter it does not depend on.
                effects.setdefault((effect.guard, effect.actions, effect.kind, effect.fault), effect)
        flags = [Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS]
        ordered, cycle = ordered_flags(flags)
        if cycle:
            names = " → ".join(cycle)
            ability = abilities[cycle[0].rpartition(".")[0]]
            place = self._places[_without_arguments(ability.name)]
            self.findings.append(Finding(place, f"flags depend on each other in a circle: {names}"))
        return Automaton(
            name=str(station.station.name),
            title=str(station.title),
            description=str(station.station.description or ""),
            resources={name: str(doc.title or name) for name, doc in station.resources.items()},
            variables=self._variables,
            abilities=abilities,
            flags=ordered,
            effects=tuple(effects.values()),
            operations=dict(self._operations()),
            specifications=dict(self._specifications()),
            rest=self._predicate(station.station.rest, self._scope({})),
        )

    # Declarations

    def _found(self, where: SourceText | Place, message: str) -> None:
        self.findings.append(Finding(where.place if isinstance(where, SourceText) else where, message))

    def _check_name(self, name: SourceText) -> None:
        if not _IDENTIFIER.fullmatch(name) or name in KEYWORDS:
            self._found(
                name, f"`{name}` is no name: use letters, digits and `_`, and none of the words of the language"
            )

    def _check_resources(self) -> None:
        for name in self._station.resources:
            file = str(self._station.folder / "resources" / f"{name}.yaml")
            self._check_name(SourceText(name, Place(file, 1, 1), name))

    def _declare(self, name: str, key: SourceText) -> bool:
        """Whether `name` is new; a second declaration is a finding."""
        if name in self._places:
            self._found(key, f"duplicate name `{name}`, first declared at {self._places[name]}: rename one of them")
            return False
        self._places[name] = key.place
        return True

    def _read_enumerations(self) -> None:
        for name, values in self._station.station.enumerations.items():
            self._check_name(name)
            if name == "bool":
                self._found(name, "`bool` is a type already: rename the enumeration")
            for index, value in enumerate(values):
                self._check_name(value)
                if value in values[:index]:
                    self._found(value, f"duplicate value `{value}` in `{name}`")
            self._enumerations[name] = EnumerationType(tuple(map(str, values)))

    def _read_variables(self) -> None:
        for name, document in self._station.station.estimated.items():
            self._read_variable(None, name, document, Kind.ESTIMATED)
        for resource, resource_document in self._station.resources.items():
            for kind in WRITTEN_KINDS:
                for name, document in getattr(resource_document, kind.value).items():
                    self._read_variable(resource, name, document, kind)

    def _read_variable(self, resource: str | None, name: SourceText, document: VariableDocument, kind: Kind) -> None:
        self._check_name(name)
        full = name if resource is None else f"{resource}.{name}"
        type_ = self._type(document.type)
        if name in FLAGS:
            self._found(name, f"`{name}` is a flag of every ability: give the variable another name")
        if not self._declare(full, name):
            return
        bindings = self._bindings(document.each)
        if type_ is None or not bindings:
            self._broken.add(full)
            return
        initial: Value = document.initial if document.initial is not None else type_.domain[0]
        if isinstance(initial, SourceText):
            initial = str(initial)
        if not contains(type_, initial):
            where = document.initial if isinstance(document.initial, SourceText) else name
            near = suggestion(str(initial), map(str, type_.domain))
            self._found(where, f"`{initial}` is no initial value of `{full}`, which ranges over {type_}{near}")
        for binding in bindings:
            ground_name = instance_name(full, (value for value, _ in binding.values()), indexed=True)
            self._variables[ground_name] = VariableDeclaration(ground_name, type_, kind, initial, resource)
            self._types[ground_name] = type_

    def _type(self, text: SourceText) -> Type | None:
        if text == "bool":
            return BOOLEAN
        if match := _RANGE.fullmatch(text):
            low, high = int(match[1]), int(match[2])
            if low > high:
                self._found(text, f"the range {text} is empty: write the smaller number first")
                return None
            if high - low >= MOST_VALUES:
                self._found(text, f"the range {text} has more than {MOST_VALUES} values: use a coarser measure")
                return None
            if max(-low, high) >= 10**MOST_DIGITS:
                self._found(text, f"integers have at most {MOST_DIGITS} digits")
                return None
            return IntegerRange(low, high)
        if text not in self._enumerations:
            near = suggestion(text, ["bool", *self._enumerations])
            self._found(text, f"unknown type `{text}`: write bool, a range such as 0..3, or an enumeration{near}")
            return None
        return self._enumerations[text]

    def _bindings(self, parameters: Parameters) -> list[Binding]:
        """Every choice of values for `parameters`; one empty choice when there are none."""
        for name, enumeration in parameters.items():
            self._check_name(name)
            if enumeration not in self._enumerations:
                near = suggestion(enumeration, self._enumerations)
                self._found(enumeration, f"unknown enumeration `{enumeration}`{near}")
                return []
        types = [self._enumerations[enumeration] for enumeration in parameters.values()]
        return [
            {str(name): (value, type_) for name, value, type_ in zip(parameters, values, types, strict=True)}
            for values in product(*(type_.values for type_ in types))
        ]

    def _abilities(self) -> Iterator[tuple[str, SourceText, AbilityDocument, Binding]]:
        for resource, document in self._station.resources.items():
            for name, ability in document.abilities.items():
                for binding in self._bindings(ability.parameters):
                    yield resource, name, ability, binding

    def _declare_flags(self) -> None:
        for resource, document in self._station.resources.items():
            for name, ability in document.abilities.items():
                self._check_name(name)
                if self._declare(f"{resource}.{name}", name) and not self._bindings(ability.parameters):
                    self._broken.add(f"{resource}.{name}")
        for resource, name, _, binding in self._abilities():
            full = instance_name(f"{resource}.{name}", (value for value, _ in binding.values()))
            self._types |= {f"{full}.{flag}": BOOLEAN for flag in FLAGS}

    # Meaning

    def _scope(self, binding: Binding, *prefixes: str) -> Scope:
        return Scope(self._types, prefixes, binding)

    def _predicate(self, text: Predicate, scope: Scope) -> Expression:
        if not isinstance(text, SourceText):
            return Constant(bool(text))
        try:
            return simplify(resolve_predicate(parse(text), scope))
        except ExpressionError as error:
            self._misread(text, error, scope)
            return FALSE

    def _misread(self, text: SourceText, error: ExpressionError, scope: Scope) -> None:
        name = _without_arguments(text[error.span.start : error.span.end])
        owner = name.rpartition(".")[0]  # of a flag
        if not any(prefix + one in self._broken for prefix in (*scope.prefixes, "") for one in (name, owner)):
            self._found(text.at(error.span), error.message)

    def _actions(
        self, texts: list[SourceText], scope: Scope, allowed: tuple[Kind, ...], what: str
    ) -> tuple[Assignment, ...]:
        actions: dict[str, Assignment] = {}
        for text in texts:
            try:
                parsed = parse_assignment(text)
                action = simplify_assignment(resolve_assignment(parsed, scope))
            except ExpressionError as error:
                self._misread(text, error, scope)
                continue
            name = target(action)
            variable = self._variables.get(name)
            if variable is None or variable.kind not in allowed:
                kind = _KINDS[variable.kind] if variable else "a flag of an ability"
                permitted = " or ".join(allowed)
                self._found(text, f"{what} writes {permitted} variables, and `{parsed.target}` is {kind}")
            elif name in actions:
                self._found(text, f"`{name}` is written twice by one transition")
            elif action.condition != FALSE:
                actions[name] = action
                if Kind.MEASURED in allowed:
                    self._check_observable(text, action.value, action.condition or TRUE)
        return tuple(actions.values())

    def _ability(self, resource: str, name: SourceText, document: AbilityDocument, binding: Binding) -> Ability:
        full = instance_name(f"{resource}.{name}", (value for value, _ in binding.values()))
        scope = self._scope(binding, f"{full}.", f"{resource}.")
        commands = (Kind.OUTPUT, Kind.ESTIMATED)
        finishing = document.finish
        return Ability(
            name=full,
            resource=resource,
            title=_readable(document.title or name.replace("_", " "), binding),
            enabled=self._predicate(document.enabled, scope),
            start_guard=self._predicate(document.start.when, scope),
            start_actions=self._actions(document.start.do, scope, commands, "a start"),
            executing=self._predicate(document.executing, scope),
            finished=self._predicate(document.finished, scope),
            finish_guard=None if finishing is None else self._predicate(finishing.when, scope),
            finish_actions=() if finishing is None else self._actions(finishing.do, scope, commands, "a finish"),
            restart=document.restart,
            human=self._human(resource, document, binding),
            timeouts=Timeouts(finish=document.time_limit),
        )

    def _human(self, resource: str, document: AbilityDocument, binding: Binding) -> HumanTask | None:
        if document.human is None:
            return None
        text = document.human.acknowledgement
        variable = self._variables.get(f"{resource}.{text}")
        if variable is None or variable.kind is not Kind.MEASURED or variable.type != BOOLEAN:
            candidates = [v for v in self._variables.values() if v.resource == resource and v.type == BOOLEAN]
            own = [v.name.removeprefix(f"{resource}.") for v in candidates if v.kind is Kind.MEASURED]
            near = suggestion(text, own)
            self._found(text, f"`{text}` must be a measured bool of `{resource}`{near}")
        return HumanTask(_readable(document.human.task, binding), f"{resource}.{text}")

    def _effect(self, name: str, resource: str, document: EffectDocument, scope: Scope) -> Effect:
        guard = self._predicate(document.when, scope)
        if isinstance(document.when, SourceText):
            self._check_observable(document.when, guard)
        actions = self._actions(document.do, scope, (Kind.MEASURED,), "an effect")
        shortest, longest = document.takes
        return Effect(name, resource, document.kind, guard, actions, shortest, longest, document.fault)

    def _check_observable(self, text: SourceText, *read: Expression) -> None:
        """A device knows nothing of what we believe, and an emulated one only hears messages."""
        for seen in (each for expression in read for each in occurrences(expression)):
            variable = self._variables.get(seen.name)
            if variable is None or variable.kind is Kind.ESTIMATED:
                written = text[seen.span.start : seen.span.end]
                message = f"an effect depends on measured and output variables only, and `{written}` is neither"
                self._found(text.at(seen.span), message)

    def _operations(self) -> Iterator[tuple[str, Operation]]:
        for name, document in self._station.operations.items():
            self._check_name(name)
            for binding in self._bindings(document.parameters):
                full = instance_name(name, (value for value, _ in binding.values()))
                scope = self._scope(binding)
                yield (
                    full,
                    Operation(
                        full,
                        _readable(document.title or name.replace("_", " "), binding),
                        self._predicate(document.precondition, scope),
                        self._predicate(document.goal, scope),
                        document.priority,
                    ),
                )

    def _specifications(self) -> Iterator[tuple[str, Specification]]:
        for name, document in self._station.specifications.items():
            self._check_name(name)
            for binding in self._bindings(document.parameters):
                full = instance_name(name, (value for value, _ in binding.values()))
                title = _readable(document.title or name.replace("_", " "), binding)
                yield full, Specification(full, title, self._predicate(document.forbidden, self._scope(binding)))
