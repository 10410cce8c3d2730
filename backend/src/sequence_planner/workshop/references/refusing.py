"""Why a part cannot be called so: its new name is none, or taken, or not the model's alone."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from sequence_planner.automaton.grounding.declarations import FLAGS, OPERATION
from sequence_planner.expressions.lexer import KEYWORDS
from sequence_planner.model.layout import scalar
from sequence_planner.model.paths import EditError
from sequence_planner.pipelines.stages.builders.mapping import ANY
from sequence_planner.ros.names import check_topic
from sequence_planner.workshop.references.declared import Declared
from sequence_planner.workshop.references.occurrences import Gathered
from sequence_planner.workshop.references.parts import ROS_KINDS, Part, variable_of
from sequence_planner.workshop.references.texts import Content, file_of

_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_SHARING = ("variable", "ability")  # of a resource, which have no names in common


def require_name(part: Part, name: str) -> None:
    """Raises `EditError` for what is no name of such a part."""
    if part.kind == "message":
        raise EditError(f"{part} is known to all nodes by this name, which is a part of what ROS 2 compares: keep it")
    if part.kind in ROS_KINDS:
        try:
            check_topic(name)
        except ValueError as error:
            raise EditError(str(error).replace("'", "`")) from error
        return
    if not _IDENTIFIER.fullmatch(name) or name in KEYWORDS:
        raise EditError(
            f"`{name}` is no name: use letters, digits and `_`, no digit first, and none of the words of the language"
        )
    if scalar(name) != name:
        raise EditError(f"`{name}` is no name that YAML would read as a text: choose another")
    if name in FLAGS and part.kind in ("variable", "parameter", "ability"):
        raise EditError(f"`{name}` is a flag of every ability: choose another name")
    if part.kind == "enumeration" and name == "bool":
        raise EditError("`bool` is a type already: choose another name")
    if part.kind == "resource" and name == OPERATION:
        raise EditError(f"`{OPERATION}` stands for the operations in expressions: choose another name")
    if part.kind == "value" and name == ANY:
        raise EditError(f"`{ANY}` stands for every value in the rows of a table: choose another name")


def require_free(new: Part, declared: Declared, gathered: Gathered, content: Content) -> None:
    """Raises `EditError` if something is called so already, or is meant to be."""
    taken = {*declared.parts, *_undeclared(declared)}
    found = next((each for each in _rivals(new) if each in taken), None)
    if found is not None:
        raise EditError(f"{found} is there already: choose another name")
    rivals = set(_rivals(new))
    if (used := next((each for each in gathered.occurrences if each.part in rivals), None)) is not None:
        raise EditError(f"{new} is named already, by {used.where.said}: choose another name")
    if new.kind == "resource" and file_of(new.name) in content.texts:
        raise EditError(f"the file {file_of(new.name)} is there already: choose another name")


def _rivals(new: Part) -> Iterator[Part]:
    yield new
    if new.kind in _SHARING and new.owner is not None:
        yield from (new._replace(kind=kind) for kind in _SHARING if kind != new.kind)


def _undeclared(declared: Declared) -> Iterator[Part]:
    for full in declared.variables:
        owner, _, name = full.rpartition(".")
        yield variable_of(owner or None, name)


def require_known(part: Part, declared: Declared) -> None:
    """Raises `EditError` for a part that there is not."""
    if part not in declared.parts and not (part.kind == "variable" and part.full in declared.variables):
        raise EditError(f"{part} is declared nowhere, so it cannot be given another name")


def require_unbound(parts: Iterable[Part], gathered: Gathered, content: Content) -> None:
    """Raises `EditError` if some place cannot be written otherwise, or may be missed."""
    for part in sorted(parts):
        if (why := gathered.ties.get(part)) is not None:
            raise EditError(f"{part} cannot be given another name in the model alone: {why}")
        word = re.compile(rf"(?<!\w){re.escape(part.name)}(?!\w)")
        for where, text in gathered.unread:
            if word.search(text):
                raise EditError(
                    f"{text.place}: this cannot be read, and may name {part} ({where.said}): put it right first"
                )
        for finding in content.skipped:
            if word.search(content.texts[finding.place.file]):
                raise EditError(f"{finding.place}: this file cannot be read, and may name {part}: put it right first")


def hiding(declared: Declared, gathered: Gathered) -> set[tuple[Part, Part]]:
    """Parts that stand in the way of others: parameters of values and variables, variables of values beside them."""
    found = set(gathered.hidden)
    zones = _zones(gathered)
    for part in declared.parts:
        if part.kind != "parameter" or part.owner is None:
            continue
        found |= {(part, Part("value", each, part.name)) for each in declared.values.get(part.name, ())}
        resource = part.owner.partition(".")[0] if "." in part.owner else None
        for owner in {resource, None, *zones.get(part.owner, ())}:
            variable = variable_of(owner, part.name)
            if variable.full in declared.variables:
                found.add((part, variable))
    return found


def _zones(gathered: Gathered) -> dict[str, set[str]]:
    """The resources in whose names a specification is written, by what its parameters belong to."""
    found: dict[str, set[str]] = {}
    for each in gathered.occurrences:
        if each.part.kind == "resource" and "zone" in each.where.path:
            found.setdefault(each.where.around.holder, set()).add(each.part.name)
    return found
