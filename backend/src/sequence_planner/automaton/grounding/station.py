"""The automaton that a station means: its abilities, operations, work masters, specifications and alarms."""

from __future__ import annotations

from pathlib import Path

from sequence_planner.automaton.automaton import Ability, AlarmDeclaration, Automaton, Flag
from sequence_planner.automaton.declarations import FLAGS, Declarations, GroundBefore
from sequence_planner.automaton.dependencies import ordered_flags
from sequence_planner.automaton.findings import Findings, own_title, readable, told_where_removed
from sequence_planner.automaton.grounding.abilities import ground_abilities
from sequence_planner.automaton.grounding.meaning import Meaning, alarm_condition, check_predicates
from sequence_planner.automaton.grounding.operations import ground_operations, ground_work_masters
from sequence_planner.automaton.grounding.specifications import ground_specifications
from sequence_planner.model.fields import words_of
from sequence_planner.model.loader import Station
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.texts.message import message


def ground(station: Station, before: GroundBefore | None = None) -> Automaton:
    """The automaton that `station` means; what was ground `before` and means the same is not ground again.

    Raises `ModelError` with all findings.
    """
    findings = Findings()
    declarations = Declarations(station, findings)
    meaning = Meaning(declarations, findings)
    check_predicates(meaning)
    abilities, effects, reactions = ground_abilities(meaning, before)
    operations = ground_operations(meaning, station)
    specifications = ground_specifications(meaning, station.specifications, station.resources)
    work_masters = ground_work_masters(meaning, station, operations)
    alarms = _alarms(meaning, station)
    rest = meaning.predicate(station.station.rest, meaning.scope({}))
    if isinstance(station.station.rest, SourceText):
        declarations.places.setdefault("rest", station.station.rest.place)
    declarations.places |= {Path(place.file).name: place for place in station.empty}
    automaton = Automaton(
        name=str(station.station.name),
        title=own_title(station.station.title, station.station.name),
        description=str(station.station.description or ""),
        resources={name: own_title(doc.title, name) for name, doc in station.resources.items()},
        variables=declarations.variables | meaning.activities,
        abilities=abilities,
        flags=_flags(abilities, declarations, findings),
        effects=effects,
        operations=operations,
        specifications=specifications,
        rest=rest,
        work_masters=work_masters,
        alarms=alarms,
        places=declarations.places,
        groups=tuple(declarations.groups),
        reactions=reactions,
        vocabulary=declarations.vocabulary,
        indices=declarations.indices(),
        titles=declarations.titles,
    )
    if findings.all:
        raise ModelError(told_where_removed(findings.all))
    return automaton


def _alarms(meaning: Meaning, station: Station) -> dict[str, AlarmDeclaration]:
    """All alarms by name, with the resource before those of one; nothing else reads them."""
    found = {}
    for resource, documents in ((None, station.station.alarms), *((n, d.alarms) for n, d in station.resources.items())):
        for name, document in documents.items():
            meaning.declarations.check_name(name, "alarm")
            full = str(name) if resource is None else f"{resource}.{name}"
            scope = meaning.scope({}, *(() if resource is None else (f"{resource}.",)))
            found[full] = AlarmDeclaration(
                full,
                resource,
                alarm_condition(meaning, document.when, scope),
                document.priority,
                words_of(document.title) or {"": readable(None, name, {}).capitalize()},
                words_of(document.consequence),
                words_of(document.action),
                document.delay,
                document.when.place if isinstance(document.when, SourceText) else name.place,
            )
    return found


def _flags(abilities: dict[str, Ability], declarations: Declarations, findings: Findings) -> tuple[Flag, ...]:
    flags = [Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS]
    ordered, circle = ordered_flags(flags)
    if circle:
        ability = abilities[circle[0].rpartition(".")[0]]
        said = message("wrong.flags-in-circle", names=" → ".join(circle))
        findings.add(declarations.places[ability.name], said)
    return ordered


def ground_variables(station: Station) -> tuple[Automaton, list[Finding]]:
    """An automaton that has the variables of `station` alone, those that are declared as they should be; and what is
    wrong with the names that are declared.
    """
    findings = Findings()
    declarations = Declarations(station, findings)
    automaton = Automaton(
        name=str(station.station.name),
        title=own_title(station.station.title, station.station.name),
        description="",
        resources={name: own_title(doc.title, name) for name, doc in station.resources.items()},
        variables=declarations.variables,
        abilities={},
        flags=(),
        places=declarations.places,
        vocabulary=declarations.vocabulary,
        titles=declarations.titles,
    )
    return automaton, findings.all
