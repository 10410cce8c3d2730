"""The names in the stages of a pipeline: fields and variables, and the values that stages make or look for."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.stages.builders.mapping import ANY
from sequence_planner.workshop.references.calculations import read_calculation
from sequence_planner.workshop.references.declared import Declared
from sequence_planner.workshop.references.occurrences import Where
from sequence_planner.workshop.references.record import Names
from sequence_planner.workshop.references.texts import entry, items, pairs

_PYTHON = "the function of a `python` stage is called with it by this name: change the function and the stage by hand"
_PYTHON_VALUE = "the function of a `python` stage gives its values by their names"


def given_by(stages: object) -> frozenset[str]:
    """All names that stages give to what they make, in an incoming pipeline."""
    found: list[object] = []
    for stage in items(stages):
        found += [name for _, name in pairs(entry(stage, "rename"))]
        found += [name for name, _ in pairs(entry(stage, "expression"))]
        found += [entry(stage, kind, "variable") for kind in ("discretise", "map", "match", "member", "remember")]
        found += items(entry(stage, "table", "variables"))
        found += [name for name, _ in pairs(entry(stage, "python", "gives"))]
    return frozenset(str(name).partition("[")[0] for name in found if isinstance(name, SourceText))


def kinds_of(stages: object, declared: Declared, resource: str) -> dict[str, str]:
    """The enumerations of names that are no variables, by the variables that they become in later stages."""
    found: dict[str, str] = {}
    for stage in reversed(items(stages)):
        become: list[tuple[object, object]] = [(name, field) for field, name in pairs(entry(stage, "rename"))]
        become += pairs(entry(stage, "expression"))
        remember = entry(stage, "remember")
        for name, source in (*become, (entry(remember, "variable"), entry(remember, "of"))):
            kind = declared.enumeration(resource, str(name)) or found.get(str(name))
            if isinstance(source, SourceText) and kind is not None:
                found.setdefault(str(source), kind)
    return found


class Stages:
    """Reads stages one after the other. `called` is the pipeline in words."""

    def __init__(self, names: Names, called: str) -> None:
        self.names = names
        self._called = called

    def read(self, stages: object, where: Where) -> None:
        """All stages of a pipeline."""
        for index, stage in enumerate(items(stages)):
            for kind, content in pairs(stage):
                reader = getattr(self, f"_{kind}", None)
                if reader is not None and str(kind) in _READ:
                    reader(content, where.to(index, kind))

    def tie(self, enumeration: str | None, why: str) -> None:
        """Note that the values of an enumeration are texts or constants of a message."""
        self.names.naming.tie_values(enumeration, why)

    def _spoken(self, name: object) -> str:
        return f"{self._called} says the values of `{name}` by their names"

    def _rename(self, content: object, where: Where) -> None:
        made = []
        for field, name in pairs(content):
            at = where.to(field)
            if self.names.incoming:
                is_message = not self.names.is_known(field)
                made.append((name, at, self.names.read(field, at), is_message))
            else:
                self.tie(self.names.read(name, at), self._spoken(name))
        for name, at, found, is_message in made:
            enumeration = self.names.give(name, at)
            self.names.naming.link(enumeration, found)
            if is_message or found is None:
                self.tie(enumeration, self._spoken(name))
        if not self.names.incoming:
            for field, _ in pairs(content):
                self.names.give(field, where.to(field))

    def _constant(self, content: object, where: Where) -> None:
        for field, _ in pairs(content):
            self.names.give(field, where.to(field))

    def _expression(self, content: object, where: Where) -> None:
        # All are read before one is given.
        for name, written in pairs(content):
            own = self._enumeration(name)
            is_message = read_calculation(self.names, written, where.to(name), own)
            is_single = isinstance(written, SourceText) and str(written).isidentifier()
            if is_message or (is_single and self.names.enumeration(str(written)) is None):
                self.tie(own, self._spoken(name))
            elif not self.names.incoming and is_single:
                self.tie(self.names.enumeration(str(written)), self._spoken(written))
        for name, _ in pairs(content):
            self.names.give(name, where.to(name))

    def _filter(self, content: object, where: Where) -> None:
        read_calculation(self.names, content, where)

    def _discretise(self, content: object, where: Where) -> None:
        self.names.read(entry(content, "field"), where.to("field"), is_message=True)
        self._made(content, where)

    def _match(self, content: object, where: Where) -> None:
        self._discretise(content, where)

    def _made(self, content: object, where: Where) -> None:
        enumeration = self.names.give(entry(content, "variable"), where.to("variable"))
        for section in ("values", "ranges"):
            self._values(enumeration, (key for key, _ in pairs(entry(content, section))), where.to(section))
        self._value(enumeration, entry(content, "otherwise"), where.to("otherwise"))

    def _undiscretise(self, content: object, where: Where) -> None:
        enumeration = self.names.read(entry(content, "variable"), where.to("variable"))
        self._values(enumeration, (key for key, _ in pairs(entry(content, "values"))), where.to("values"))
        self.names.give(entry(content, "field"), where.to("field"))

    def _map(self, content: object, where: Where) -> None:
        if not self.names.incoming:
            self._undiscretise(content, where)
            return
        read = self.names.read(entry(content, "field"), where.to("field"), is_message=True)
        made = self.names.give(entry(content, "variable"), where.to("variable"))
        for key, value in pairs(entry(content, "values")):
            self._value(read, key, where.to("values", key))
            self._value(made, value, where.to("values", key))
        self._value(made, entry(content, "otherwise"), where.to("otherwise"))

    def _table(self, content: object, where: Where) -> None:
        fields, variables = items(entry(content, "fields")), items(entry(content, "variables"))
        read = [self.names.read(each, where.to("fields", index)) for index, each in enumerate(fields)]
        made = [self.names.give(each, where.to("variables", index)) for index, each in enumerate(variables)]
        for index, row in enumerate(items(entry(content, "rows"))):
            for key, kinds in (("when", read), ("gives", made)):
                self._cells(kinds, entry(row, key), where.to("rows", index, key), key == "when")
        self._cells(made, entry(content, "otherwise"), where.to("otherwise"))

    def _cells(self, kinds: Iterable[str | None], cells: object, where: Where, is_pattern: bool = False) -> None:
        for index, (kind, cell) in enumerate(zip(kinds, items(cells), strict=False)):
            if not is_pattern or cell != ANY:
                self._value(kind, cell, where.to(index))

    def _member(self, content: object, where: Where) -> None:
        self._discretise(content, where)

    def _remember(self, content: object, where: Where) -> None:
        of = entry(content, "of")
        is_message = isinstance(of, SourceText) and not self.names.is_known(str(of))
        read = self.names.read(of, where.to("of"))
        self._cells([read] * len(items(entry(content, "except"))), entry(content, "except"), where.to("except"))
        made = self.names.give(entry(content, "variable"), where.to("variable"))
        self.names.naming.link(made, read)
        if is_message or read is None:
            self.tie(made, self._spoken(entry(content, "variable")))

    def _debounce(self, content: object, where: Where) -> None:
        self._passing(entry(content, "fields"), where.to("fields"))

    def _timeout(self, content: object, where: Where) -> None:
        self._debounce(content, where)

    def _fold(self, content: object, where: Where) -> None:
        self._passing(content, where)

    def _passing(self, fields: object, where: Where) -> None:
        for index, field in enumerate(items(fields)):
            self.names.read(field, where.to(index))

    def _override(self, content: object, where: Where) -> None:
        for field, bounds in pairs(entry(content, "fields")):
            at = where.to("fields", field)
            enumeration = self.names.read(field, at)
            among = entry(bounds, "in")
            self._cells([enumeration] * len(items(among)), among, at.to("in"))

    def _python(self, content: object, where: Where) -> None:
        naming = self.names.naming
        for field, _ in pairs(entry(content, "reads")):
            before = len(naming.gathered.occurrences)
            self.tie(self.names.read(field, where.to("reads", field)), _PYTHON_VALUE)
            for found in naming.gathered.occurrences[before:]:
                naming.gathered.tie(found.part, _PYTHON)
        for field, _ in pairs(entry(content, "gives")):
            before = len(naming.gathered.occurrences)
            self.tie(self.names.give(field, where.to("gives", field)), _PYTHON_VALUE)
            for found in naming.gathered.occurrences[before:]:
                naming.gathered.tie(found.part, _PYTHON)

    def _enumeration(self, name: SourceText) -> str | None:
        declared = self.names.naming.declared
        return declared.enumeration(self.names.resource, str(name)) if self.names.incoming else None

    def _values(self, enumeration: str | None, keys: Iterable[SourceText], where: Where) -> None:
        for key in keys:
            self._value(enumeration, key, where.to(key))

    def _value(self, enumeration: str | None, text: object, where: Where) -> None:
        self.names.naming.note_value(enumeration, where, text)


_READ = frozenset(
    {
        "rename", "constant", "expression", "filter", "discretise", "undiscretise", "map", "table", "match", "member",
        "remember", "debounce", "timeout", "fold", "override", "python",
    }
)  # fmt: skip
