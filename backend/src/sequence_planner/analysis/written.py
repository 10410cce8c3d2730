"""What is suspicious in a station as it is written: names that nothing uses, quantifiers that say nothing, values that
no message gives, and time limits that are too short. The automaton knows nothing of it any more.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterator

from pydantic import BaseModel

from sequence_planner.analysis.checks.ungiven_values import check_never_given
from sequence_planner.analysis.checks.warning import ModelWarning, families
from sequence_planner.analysis.checks.warning import place as place_of
from sequence_planner.analysis.folded_conditions import check_folded
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.shorthand.misuse import decided_by_number
from sequence_planner.language.shorthand.vocabulary import Vocabulary
from sequence_planner.language.syntax import Assignment, Expression, ExpressionError, Quantified, children
from sequence_planner.language.types import Place
from sequence_planner.mimic.instructions import unshown_of
from sequence_planner.mimic.picture import undrawn_of
from sequence_planner.model.documents import SetDocument
from sequence_planner.model.loader import Station
from sequence_planner.model.source import ExpandedText, SourceText
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.texts.message import message

# The sections that declare names for something longer, each with what one of it is.
_SECTIONS = {"sets": "set", "relations": "relation", "maps": "map", "predicates": "predicate"}
_FOR_PEOPLE = frozenset({"title", "description", "consequence", "action", "task", "instruction", "by_hand"})
_PACKAGES = "packages"
_NAMES = re.compile(r"[^\W\d]\w*(?:\.[^\W\d]\w*)*")
_COUNTING = re.compile(r"\bat\s+(?:least|most)\b")


def suspicious_in(station: Station | None, automaton: Automaton, pipelines: StationPipelines) -> Iterator[ModelWarning]:
    """Yield what is suspicious in the documents and pipelines of a station; of one that nobody has written only what is
    in its pipelines.
    """
    if station is not None:
        yield from _unused(station)
        said = list(_always_true(station, automaton.vocabulary))
        yield from said
        places = {each.place for each in said}
        yield from (each for each in check_folded(station) if each.place not in places)
        for finding in undrawn_of(automaton, station):
            yield ModelWarning(finding.place, "not-drawn", finding.message)
        for finding in unshown_of(automaton, station):
            yield ModelWarning(finding.place, "not-shown", finding.message)
    yield from check_never_given(automaton, pipelines)
    yield from _late(automaton)


# Time limits that are shorter than what takes so long.


def _late(automaton: Automaton) -> Iterator[ModelWarning]:
    """Abilities of which an alarm says that they are late though they take as long as they usually do; of instances of
    one, the first.
    """
    for written, (name, *_) in families(automaton.abilities).items():
        limit, usual = automaton.abilities[name].timeouts.finish, automaton.abilities[name].duration
        if limit is None or usual is None or usual[1] <= limit:
            continue
        id_ = "found.always-late" if usual[0] > limit else "found.often-late"
        seconds = {"shortest": f"{usual[0]:g}", "longest": f"{usual[1]:g}", "limit": f"{limit:g}"}
        yield ModelWarning(place_of(automaton, name), "too-late", message(id_, ability=written, **seconds))


# Names that nothing uses.


def _unused(station: Station) -> Iterator[ModelWarning]:
    """Sets, relations, maps and predicates that nothing uses; one of a type where no instance does.

    A set with a title is used by sentences: they say what several values are called together.
    """
    used = _used(station)
    idle: dict[Place, tuple[str, SourceText]] = {}
    for section, what in _SECTIONS.items():
        for name, declared in getattr(station.station, section).items():
            if str(name) not in used and not _speaks(declared):
                idle[name.place] = what, name
    own: dict[Place, list[tuple[str, str, SourceText]]] = defaultdict(list)
    for resource, document in station.resources.items():
        for section, what in _SECTIONS.items():
            for name, declared in getattr(document, section).items():
                if not _speaks(declared):
                    own[name.place._replace(instance="")].append((what, f"{resource}.{name}", name))
    for place, everywhere in own.items():
        brought = place.file.startswith(str(station.folder / _PACKAGES))  # for whoever else has the package
        if not brought and not any(full in used for _, full, _ in everywhere):
            idle[place] = everywhere[0][0], everywhere[0][2]
    for place, (what, name) in idle.items():
        said = message("found.never-used", what=message(f"found.never-used.{what}"), name=str(name))
        yield ModelWarning(place, "never-used", said)


def _speaks(declared: object) -> bool:
    return isinstance(declared, SetDocument) and declared.title is not None


def _used(station: Station) -> set[str]:
    """The words of all texts that are no declaration; those of a resource also as they are known elsewhere."""
    found: set[str] = set()
    for text in _texts_of_station(station):
        found |= _words_of(text)
    for text in _texts(list(station.specifications.values())):  # in a zone, the words are those of a resource
        found |= {f"{resource}.{word}" for resource in station.resources for word in _words_of(text)}
    for resource, document in station.resources.items():
        for text in _texts(document):
            found |= {each for word in _words_of(text) for each in (word, f"{resource}.{word}")}
    return found


def _words_of(text: SourceText) -> set[str]:
    return set(_NAMES.findall(text))


def _texts_of_station(station: Station) -> Iterator[SourceText]:
    """All texts but those of resources."""
    parts = (station.operations, station.specifications, station.work_masters, station.sequences)
    yield from _texts(station.station)
    for part in parts:
        yield from _texts(list(part.values()))


def _texts(content: object) -> Iterator[SourceText]:
    """The texts within a part of a document that are not for people; of a section that declares names without these."""
    if isinstance(content, SourceText):
        yield content
    elif isinstance(content, BaseModel):
        for field in type(content).model_fields:
            if field in _SECTIONS:
                yield from _texts(list(getattr(content, field).values()))
            elif field not in _FOR_PEOPLE and field != "enumerations":
                yield from _texts(getattr(content, field))
    elif isinstance(content, dict):
        for key, value in content.items():
            yield from _texts(key)
            yield from _texts(value)
    elif isinstance(content, list | tuple):
        for each in content:
            yield from _texts(each)


# Quantifiers that hold whatever their bodies say.


def _always_true(station: Station, vocabulary: Vocabulary) -> Iterator[ModelWarning]:
    found: dict[tuple[Place, str], None] = {}
    for part in (*_texts_of_station(station), *_texts(list(station.resources.values()))):
        for quantified in _counting(part) if _COUNTING.search(part) else ():
            decided = decided_by_number(quantified, vocabulary)
            if decided is not None and decided.always and not _is_given(part, quantified):
                found[part.at(quantified.span)._replace(instance=""), decided.message] = None
    for place, said in sorted(found):
        yield ModelWarning(place, "always-holds", said)


def _counting(text: SourceText) -> Iterator[Quantified]:
    """The quantifiers of a text; none of a text that is for something else."""
    reads: tuple[Callable[[str], Expression | Assignment], ...] = (parse, parse_formula, parse_assignment)
    for read in reads:
        try:
            found = read(text)
        except ExpressionError:
            continue
        parts = (found.value, found.condition) if isinstance(found, Assignment) else (found,)
        pending = [each for each in parts if each is not None]
        while pending:
            part = pending.pop()
            if isinstance(part, Quantified):
                yield part
            pending += children(part)
        return


def _is_given(text: SourceText, quantified: Quantified) -> bool:
    """Return whether an argument of an instance decides it: another instance may give another one."""
    if not isinstance(text, ExpandedText):
        return False
    begin, end = quantified.span.start, quantified.body.span.start
    return any(begin <= piece.start < end for piece in text.pieces)
