"""Ground abilities with their effects."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from sequence_planner.automaton.grounding.declarations import FLAGS, Declarations
from sequence_planner.automaton.grounding.findings import Binding, Findings, instance_name, readable
from sequence_planner.automaton.grounding.meaning import Meaning, Writing
from sequence_planner.automaton.structure import Ability, Effect, HumanTask, Kind, Timeouts
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import Scope, suggestion
from sequence_planner.expressions.syntax import TRUE, Expression, conjunction
from sequence_planner.expressions.types import BOOLEAN
from sequence_planner.model.documents import AbilityDocument, EffectDocument, Predicate, TimeoutsDocument
from sequence_planner.model.source import Finding, SourceText

_COMMANDS = (Kind.OUTPUT, Kind.ESTIMATED)
START = Writing("a start", _COMMANDS)
FINISH = Writing("a finish", _COMMANDS)
CANCEL = Writing("a cancel", _COMMANDS)
EFFECT = Writing("an effect", (Kind.MEASURED,))


class GroundAbility(NamedTuple):
    """An ability as its document means it, with all that grounding noted of it and of nothing else.

    `effects` are with what makes two of them one, and where each is written.
    """

    ability: Ability
    places: dict[str, Place]
    effects: tuple[tuple[tuple[object, ...], Effect, Place], ...]
    findings: tuple[Finding, ...]
    activities: tuple[str, ...]


class GroundBefore:
    """What the abilities of one station meant when they were ground before.

    An ability means the same for as long as its document is the same object and what is declared is the same.
    """

    def __init__(self) -> None:
        self._declared: object = None
        self._known: dict[tuple[str, str], tuple[SourceText, AbilityDocument, list[GroundAbility]]] = {}
        self._used: set[tuple[str, str]] = set()

    def begin(self, declarations: Declarations) -> None:
        """The station is ground with these names now."""
        declared = declarations.all()
        if declared != self._declared:
            self._known = {}
        self._declared = declared
        self._used = set()

    def end(self) -> None:
        """All abilities were asked for."""
        self._known = {key: known for key, known in self._known.items() if key in self._used}

    def ground(
        self, resource: str, name: SourceText, document: AbilityDocument, ground: Callable[[], list[GroundAbility]]
    ) -> list[GroundAbility]:
        """The ability for all choices of its parameters, made by `ground` unless it is known."""
        key = resource, str(name)
        self._used.add(key)
        known = self._known.get(key)
        if known is None or known[0] is not name or known[1] is not document:
            known = self._known[key] = name, document, ground()
        return known[2]


def ground_abilities(
    meaning: Meaning, before: GroundBefore | None = None
) -> tuple[dict[str, Ability], tuple[Effect, ...], dict[str, tuple[str, ...]]]:
    """All abilities by name, what is expected of the devices, and by ability the names of its part of that.

    A reaction that is said once for each value of a parameter it does not depend on is one reaction. What was ground
    `before` and means the same is not ground again.
    """
    abilities: dict[str, Ability] = {}
    effects: dict[tuple[object, ...], Effect] = {}
    reactions: dict[str, tuple[str, ...]] = {}
    declarations, places = meaning.declarations, meaning.declarations.places
    before = before or GroundBefore()
    before.begin(declarations)
    for resource, name, document in declarations.written_abilities():
        make = partial(_ground, declarations, resource, name, document)
        for each in before.ground(resource, name, document, make):
            ability = each.ability
            abilities[ability.name] = ability
            places |= each.places
            meaning.take(each.findings, each.activities)
            for key, effect, place in each.effects:
                shared = effects.setdefault(key, effect)
                if shared is effect:
                    places[effect.name] = place
                reactions[ability.name] = (*reactions.get(ability.name, ()), shared.name)
    before.end()
    return abilities, tuple(effects.values()), reactions


def _ground(
    declarations: Declarations, resource: str, name: SourceText, document: AbilityDocument
) -> list[GroundAbility]:
    return [
        _instance(declarations, resource, name, document, binding)
        for binding in declarations.bindings(document.parameters)
    ]


def _instance(
    declarations: Declarations, resource: str, name: SourceText, document: AbilityDocument, binding: Binding
) -> GroundAbility:
    findings = Findings()
    meaning = Meaning(declarations, findings)
    scope = meaning.scope(binding, f"{instance_name(f'{resource}.{name}', binding)}.", f"{resource}.")
    ability = _ability(meaning, resource, name, document, binding, scope)
    effects: list[tuple[tuple[object, ...], Effect, Place]] = []
    for effect_name, effect_document in document.effects.items():
        effect = _effect(meaning, f"{ability.name}.{effect_name}", resource, effect_document, scope)
        written = (resource, str(name), str(effect_name))
        effects.append(((written, effect.guard, effect.actions), effect, effect_name.place))
    places = _places(ability.name, name, document)
    return GroundAbility(ability, places, tuple(effects), tuple(findings.all), tuple(meaning.activities))


def _ability(
    meaning: Meaning, resource: str, name: SourceText, document: AbilityDocument, binding: Binding, scope: Scope
) -> Ability:
    enabled = meaning.predicate(document.enabled, scope)
    start_guard = meaning.predicate(document.start.when, scope)
    finish = document.finish
    finish_guard = None if finish is None else meaning.predicate(finish.when, scope)
    cancelled = () if document.cancel is None else document.cancel.do
    return Ability(
        name=instance_name(f"{resource}.{name}", binding),
        resource=resource,
        title=readable(document.title, name, binding),
        enabled=enabled,
        start_guard=start_guard,
        start_actions=meaning.actions(document.start.do, scope, conjunction(enabled, start_guard), START),
        executing=meaning.predicate(document.executing, scope),
        finished=meaning.predicate(document.finished, scope),
        finish_guard=finish_guard,
        finish_actions=()
        if finish is None or finish_guard is None
        else meaning.actions(finish.do, scope, finish_guard, FINISH),
        restart=document.restart,
        human=_human(meaning, resource, document, binding),
        timeouts=_timeouts(document.timeouts),
        duration=document.duration,
        cancel_actions=meaning.actions(cancelled, scope, TRUE, CANCEL),
    )


def _timeouts(document: TimeoutsDocument) -> Timeouts:
    return Timeouts(document.react, document.finish, document.retries, document.then == "replan")


def _human(meaning: Meaning, resource: str, document: AbilityDocument, binding: Binding) -> HumanTask | None:
    if document.human is None:
        return None
    text = document.human.acknowledgement
    check_acknowledgement(meaning, resource, text)
    return HumanTask(readable(document.human.task, "", binding), f"{resource}.{text}")


def check_acknowledgement(meaning: Meaning, resource: str, text: SourceText) -> None:
    """Note an acknowledgement that is no measured `bool` of the resource."""
    variables = meaning.declarations.variables
    variable = variables.get(f"{resource}.{text}")
    if variable is None or variable.kind is not Kind.MEASURED or variable.type != BOOLEAN:
        candidates = [v for v in variables.values() if v.resource == resource and v.type == BOOLEAN]
        own = [v.name.removeprefix(f"{resource}.") for v in candidates if v.kind is Kind.MEASURED]
        meaning.findings.add(text, f"`{text}` must be a measured bool of `{resource}`{suggestion(text, own)}")


def _effect(meaning: Meaning, name: str, resource: str, document: EffectDocument, scope: Scope) -> Effect:
    guard = observable_condition(meaning, document.when, scope)
    actions = meaning.actions(document.do, scope, guard, EFFECT)
    shortest, longest = document.takes
    return Effect(name, resource, document.kind, guard, actions, shortest, longest, document.fault)


def observable_condition(meaning: Meaning, text: Predicate, scope: Scope) -> Expression:
    """The condition of an effect."""
    guard = meaning.predicate(text, scope)
    if isinstance(text, SourceText):
        meaning.check_observable(text, guard)
    return guard


def _places(ability: str, name: SourceText, document: AbilityDocument) -> dict[str, Place]:
    """Where the ability and its parts were written; a part that is left out stands where the ability does."""
    finish = document.finish
    parts = {
        **{flag: getattr(document, flag) for flag in FLAGS},
        "start": document.start.when,
        "finish": True if finish is None else finish.when,
    }
    return {ability: name.place, **{f"{ability}.{part}": _place(text, name.place) for part, text in parts.items()}}


def _place(text: object, otherwise: Place) -> Place:
    return text.place if isinstance(text, SourceText) else otherwise
