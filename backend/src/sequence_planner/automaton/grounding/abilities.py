"""Ground abilities with their effects."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import partial

from sequence_planner.automaton.automaton import (
    Ability,
    Effect,
    HumanTask,
    Instruction,
    Kind,
    LateTexts,
    Timeouts,
    commanded,
)
from sequence_planner.automaton.declarations import FLAGS, Declarations, GroundAbility, GroundBefore
from sequence_planner.automaton.findings import Binding, Findings, instance_name, readable, title_of, with_values
from sequence_planner.automaton.grounding.meaning import Meaning, Writing, observable_condition
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import TRUE, Assignment, Expression, Not, Span, conjunction, conjuncts, variables
from sequence_planner.language.types import BOOLEAN, Place
from sequence_planner.model.documents import AbilityDocument, EffectDocument, InstructionDocument, TimeoutsDocument
from sequence_planner.model.fields import Words, by_language
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message

_COMMANDS = (Kind.OUTPUT, Kind.ESTIMATED)
START = Writing("start", _COMMANDS)
FINISH = Writing("finish", _COMMANDS)
CANCEL = Writing("cancel", _COMMANDS)
EFFECT = Writing("effect", (Kind.MEASURED,))
_TOLD = (Kind.MEASURED, Kind.OUTPUT, Kind.ESTIMATED)  # whose values can stand in a text for people
_IN_BRACES = re.compile(r"\{([^{}]*)\}")


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
        written = (resource, str(name), str(effect_name))
        for each in declarations.bindings(effect_document.each):
            full = instance_name(f"{ability.name}.{effect_name}", each, indexed=True)
            around = scope.binding(each)
            effect = _effect(meaning, full, resource, effect_name, effect_document, around, ability.executing)
            effects.append(((written, effect.guard, effect.actions), effect, effect_name.place))
    places = _places(ability.name, name, document)
    return GroundAbility(ability, places, tuple(effects), tuple(findings.all), tuple(meaning.activities))


def _ability(
    meaning: Meaning, resource: str, name: SourceText, document: AbilityDocument, binding: Binding, scope: NameScope
) -> Ability:
    enabled = meaning.predicate(document.enabled, scope)
    start_guard = meaning.predicate(document.start.when, scope)
    start_actions = meaning.actions(document.start.do, scope, conjunction(enabled, start_guard), START)
    executing, finish_guard = _course(meaning, resource, document, scope, start_actions)
    finish = document.finish
    cancelled = () if document.cancel is None else document.cancel.do
    return Ability(
        name=instance_name(f"{resource}.{name}", binding),
        resource=resource,
        title=title_of(document.title, name, binding, meaning.declarations.titles),
        enabled=enabled,
        start_guard=start_guard,
        start_actions=start_actions,
        executing=executing,
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
        instruction=_instruction(meaning, document.instruction, binding),
        moves=document.moves,
        late=LateTexts(
            _with_variables(meaning, resource, document.late.not_begun, binding),
            _with_variables(meaning, resource, document.late.not_finished, binding),
        ),
    )


def _course(
    meaning: Meaning, resource: str, document: AbilityDocument, scope: NameScope, start: Sequence[Assignment]
) -> tuple[Expression, Expression | None]:
    """While what it executes, and when it finishes: as written, or what follows from its command and `until`."""
    finish = None if document.finish is None else meaning.predicate(document.finish.when, scope)
    if document.until is None:
        return meaning.predicate(document.executing, scope), finish
    until = meaning.predicate(document.until, scope)
    variables = meaning.declarations.variables.values()
    command = commanded(start, {v.name for v in variables if v.kind is Kind.OUTPUT and v.resource == resource})
    if command == TRUE and isinstance(document.until, SourceText) and not meaning.findings.all:
        meaning.findings.add(document.until, message("wrong.until", resource=resource))
    if "executing" in document.model_fields_set:
        executing = meaning.predicate(document.executing, scope)
    else:
        executing = simplify(conjunction(*conjuncts(command), Not(until)))
    parts = (command, until, TRUE if finish is None else finish)
    return executing, simplify(conjunction(*(each for part in parts for each in conjuncts(part))))


def _timeouts(document: TimeoutsDocument) -> Timeouts:
    return Timeouts(document.react, document.finish, document.retries, document.then == "replan")


def _human(meaning: Meaning, resource: str, document: AbilityDocument, binding: Binding) -> HumanTask | None:
    if document.human is None:
        return None
    text = document.human.acknowledgement
    check_acknowledgement(meaning, resource, text)
    return HumanTask(title_of(document.human.task, "", binding, meaning.declarations.titles), f"{resource}.{text}")


def _instruction(meaning: Meaning, document: InstructionDocument | None, binding: Binding) -> Instruction | None:
    if document is None:
        return None
    titles = meaning.declarations.titles
    return Instruction(
        {
            language: readable(said, "", binding, titles, language or "en")
            for language, said in by_language(document.text).items()
        },
        document.image and with_values(document.image, binding),
        document.video and with_values(document.video, binding),
    )


def _with_variables(meaning: Meaning, resource: str, text: Words | None, binding: Binding) -> dict[str, str]:
    """A text with parameters and variables in braces, by language: what the parameters are called, and the full names
    of the variables, of which those of the resource come first. What is neither is noted.
    """
    known = {name: each for name, each in meaning.declarations.variables.items() if each.kind in _TOLD}
    found: dict[str, str] = {}
    for language, said in by_language(text).items():
        told = readable(said, "", binding, meaning.declarations.titles, language or "en")
        for match in _IN_BRACES.finditer(said):
            if match[1] in binding:
                continue
            full = next((each for each in (f"{resource}.{match[1]}", match[1]) if each in known), None)
            if full is None:
                own = (each.removeprefix(f"{resource}.") for each in known)
                near = suggestion(match[1], [*binding, *own])
                meaning.findings.add_within(
                    said, Span(*match.span(1)), message("wrong.no-value-in-text", text=match[0], hint=near)
                )
            else:
                told = told.replace(match[0], f"{{{full}}}")
        found[language] = told
    return found


def check_acknowledgement(meaning: Meaning, resource: str, text: SourceText) -> None:
    """Note an acknowledgement that is no measured `bool` of the resource."""
    variables = meaning.declarations.variables
    variable = variables.get(f"{resource}.{text}")
    if variable is None or variable.kind is not Kind.MEASURED or variable.type != BOOLEAN:
        candidates = [v for v in variables.values() if v.resource == resource and v.type == BOOLEAN]
        own = [v.name.removeprefix(f"{resource}.") for v in candidates if v.kind is Kind.MEASURED]
        meaning.findings.add(
            text, message("wrong.acknowledgement", name=str(text), resource=resource, hint=suggestion(text, own))
        )


def _effect(
    meaning: Meaning,
    name: str,
    resource: str,
    written: SourceText,
    document: EffectDocument,
    scope: NameScope,
    executing: Expression,
) -> Effect:
    if document.when is None:
        guard = executing
        unseen = (each for each in variables(guard) if not meaning.is_observable(each))
        if (found := next(unseen, None)) is not None:
            meaning.findings.add(written, message("wrong.effect-without-when", name=found))
    else:
        guard = observable_condition(meaning, document.when, scope)
    actions = meaning.actions(document.do, scope, guard, EFFECT)
    shortest, longest = document.takes
    return Effect(name, resource, document.kind, guard, actions, shortest, longest, document.fault)


def _places(ability: str, name: SourceText, document: AbilityDocument) -> dict[str, Place]:
    """Return where the ability and its parts were written; a part that is left out stands where the ability does."""
    written = {flag: getattr(document, flag) for flag in FLAGS}
    finish = True if document.finish is None else document.finish.when
    if document.until is not None:
        finish = finish if isinstance(finish, SourceText) else document.until
        written["executing"] = document.executing or document.until
    parts = {**written, "start": document.start.when, "finish": finish}
    return {
        ability: name.place,
        **{f"{ability}.{part}": _ability_place(text, name.place) for part, text in parts.items()},
    }


def _ability_place(text: object, otherwise: Place) -> Place:
    return text.place if isinstance(text, SourceText) else otherwise
