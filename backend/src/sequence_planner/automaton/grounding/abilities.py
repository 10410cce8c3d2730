"""Ground abilities with their effects."""

from __future__ import annotations

from sequence_planner.automaton.grounding.declarations import FLAGS
from sequence_planner.automaton.grounding.findings import Binding, instance_name, readable
from sequence_planner.automaton.grounding.meaning import Meaning, Writing
from sequence_planner.automaton.structure import Ability, Effect, HumanTask, Kind, Timeouts
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import Scope, suggestion
from sequence_planner.expressions.syntax import TRUE, Expression, conjunction
from sequence_planner.expressions.types import BOOLEAN
from sequence_planner.model.documents import AbilityDocument, EffectDocument, Predicate, TimeoutsDocument
from sequence_planner.model.source import SourceText

_COMMANDS = (Kind.OUTPUT, Kind.ESTIMATED)
START = Writing("a start", _COMMANDS)
FINISH = Writing("a finish", _COMMANDS)
CANCEL = Writing("a cancel", _COMMANDS)
EFFECT = Writing("an effect", (Kind.MEASURED,))


def ground_abilities(
    meaning: Meaning,
) -> tuple[dict[str, Ability], tuple[Effect, ...], dict[str, tuple[str, ...]]]:
    """All abilities by name, what is expected of the devices, and by ability the names of its part of that.

    A reaction that is said once for each value of a parameter it does not depend on is one reaction.
    """
    abilities: dict[str, Ability] = {}
    effects: dict[tuple[object, ...], Effect] = {}
    reactions: dict[str, tuple[str, ...]] = {}
    for resource, name, document, binding in meaning.declarations.abilities():
        scope = meaning.scope(binding, f"{instance_name(f'{resource}.{name}', binding)}.", f"{resource}.")
        ability = _ability(meaning, resource, name, document, binding, scope)
        abilities[ability.name] = ability
        _note_places(meaning, ability.name, name, document)
        for effect_name, effect_document in document.effects.items():
            effect = _effect(meaning, f"{ability.name}.{effect_name}", resource, effect_document, scope)
            written = (resource, str(name), str(effect_name))
            shared = effects.setdefault((written, effect.guard, effect.actions), effect)
            if shared is effect:
                meaning.declarations.places[effect.name] = effect_name.place
            reactions[ability.name] = (*reactions.get(ability.name, ()), shared.name)
    return abilities, tuple(effects.values()), reactions


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


def _note_places(meaning: Meaning, ability: str, name: SourceText, document: AbilityDocument) -> None:
    """Where the ability and its parts were written; a part that is left out stands where the ability does."""
    finish = document.finish
    parts = {
        **{flag: getattr(document, flag) for flag in FLAGS},
        "start": document.start.when,
        "finish": True if finish is None else finish.when,
    }
    places = meaning.declarations.places
    places[ability] = name.place
    for part, text in parts.items():
        places[f"{ability}.{part}"] = _place(text, name.place)


def _place(text: object, otherwise: Place) -> Place:
    return text.place if isinstance(text, SourceText) else otherwise
