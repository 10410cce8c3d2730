"""The names in examples of pipelines: variables and fields, and their values."""

from __future__ import annotations

from sequence_planner.workshop.references.occurrences import Where
from sequence_planner.workshop.references.record import Fields, Names
from sequence_planner.workshop.references.texts import entry, items, pairs


def read_examples(names: Names, before: Fields, examples: object, where: Where) -> None:
    """Note what examples name; `before` are the fields with which the records of a flow begin."""
    for index, example in enumerate(items(examples)):
        _read_example(names, before, example, where.to(index))
        for number, step in enumerate(items(entry(example, "steps"))):
            _read_example(names, before, step, where.to(index, "steps", number))


def _read_example(names: Names, before: Fields, example: object, where: Where) -> None:
    given, gives = where.to("given"), where.to("gives")
    if names.incoming:
        end = Names(names.naming, names.resource, True, names.fields, frozenset())
        _read_values(end, entry(example, "gives"), gives)
    else:
        start = Names(names.naming, names.resource, False, {}, frozenset())
        _read_values(start, entry(example, "given"), given)
    if before:
        _read_given(Names(names.naming, names.resource, True, before, frozenset()), entry(example, "given"), given)


def _read_values(names: Names, content: object, where: Where) -> None:
    for name, value in pairs(content):
        at = where.to(name)
        names.naming.note_value(names.read(name, at), at, value)


def _read_given(names: Names, content: object, where: Where) -> None:
    """What the sources of a flow give: by alias in a merge, else by name."""
    for alias, fields in pairs(content):
        if isinstance(fields, dict):
            own = {
                name.partition(".")[2]: field for name, field in names.fields.items() if name.startswith(f"{alias}.")
            }
            _read_values(Names(names.naming, names.resource, True, own, frozenset()), fields, where.to(alias))
    if not any("." in name for name in names.fields):
        _read_values(names, content, where)
