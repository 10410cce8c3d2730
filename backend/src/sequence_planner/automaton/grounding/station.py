"""The automaton of a station, put together from its parts."""

from __future__ import annotations

from pathlib import Path

from sequence_planner.automaton.dependencies import ordered_flags
from sequence_planner.automaton.grounding.abilities import GroundBefore, ground_abilities
from sequence_planner.automaton.grounding.declarations import FLAGS, Declarations
from sequence_planner.automaton.grounding.findings import Findings
from sequence_planner.automaton.grounding.meaning import Meaning
from sequence_planner.automaton.grounding.operations import ground_operations, ground_work_masters
from sequence_planner.automaton.grounding.specifications import ground_specifications
from sequence_planner.automaton.structure import Ability, Automaton, Flag
from sequence_planner.model.loading import Station
from sequence_planner.model.source import Finding, ModelError, SourceText


def ground(station: Station, before: GroundBefore | None = None) -> Automaton:
    """The automaton that `station` means; what was ground `before` and means the same is not ground again.

    Raises `ModelError` with all findings.
    """
    findings = Findings()
    declarations = Declarations(station, findings)
    meaning = Meaning(declarations, findings)
    abilities, effects, reactions = ground_abilities(meaning, before)
    operations = ground_operations(meaning, station.operations)
    specifications = ground_specifications(meaning, station.specifications, station.resources)
    work_masters = ground_work_masters(meaning, station.work_masters, operations)
    rest = meaning.predicate(station.station.rest, meaning.scope({}))
    if isinstance(station.station.rest, SourceText):
        declarations.places.setdefault("rest", station.station.rest.place)
    declarations.places |= {Path(place.file).name: place for place in station.empty}
    automaton = Automaton(
        name=str(station.station.name),
        title=str(station.title),
        description=str(station.station.description or ""),
        resources={name: str(doc.title or name) for name, doc in station.resources.items()},
        variables=declarations.variables | meaning.activities,
        abilities=abilities,
        flags=_flags(abilities, declarations, findings),
        effects=effects,
        operations=operations,
        specifications=specifications,
        rest=rest,
        work_masters=work_masters,
        places=declarations.places,
        reactions=reactions,
    )
    if findings.all:
        raise ModelError(findings.all)
    return automaton


def _flags(abilities: dict[str, Ability], declarations: Declarations, findings: Findings) -> tuple[Flag, ...]:
    flags = [Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS]
    ordered, circle = ordered_flags(flags)
    if circle:
        ability = abilities[circle[0].rpartition(".")[0]]
        message = f"flags depend on each other in a circle: {' → '.join(circle)}"
        findings.add(declarations.places[ability.name], message)
    return ordered


def ground_variables(station: Station) -> tuple[Automaton, list[Finding]]:
    """An automaton that has the variables of `station` alone, those that are declared as they should be; and what is
    wrong with the names that are declared.
    """
    findings = Findings()
    declarations = Declarations(station, findings)
    automaton = Automaton(
        name=str(station.station.name),
        title=str(station.title),
        description="",
        resources={name: str(doc.title or name) for name, doc in station.resources.items()},
        variables=declarations.variables,
        abilities={},
        flags=(),
        places=declarations.places,
    )
    return automaton, findings.all
