"""Stages to begin with: of each kind some that the record at an edge suggests, for people to fill in further.

Whether one of them can stand there, the builder of pipelines says and nobody else.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from sequence_planner.expressions.types import BooleanType, EnumerationType, IntegerRange, Type
from sequence_planner.pipelines.message_types import feeds, fills
from sequence_planner.pipelines.record import FieldType, ListType, NestedType, RealType, RecordType, TextType
from sequence_planner.pipelines.stages.builders.own import FOLDER
from sequence_planner.pipelines.stages.values import domain, is_numeric, is_textual

DEEPEST = 3  # messages within messages
MOST_SUBJECTS = 12  # fields that are tried for a kind of stage
MOST_POINTS = 40  # values that are written out
# Kinds that give a variable that is there, and those that give a field of a message.
GIVING_VARIABLES, GIVING_FIELDS = ("rename", "map"), ("rename", "constant", "undiscretise", "map")


@dataclass(frozen=True)
class Candidate:
    """A stage as a document has it, and the variables that it needs declared, with their types."""

    stage: Mapping[str, object]
    declares: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Spot:
    """Where a stage shall stand: the record there, what there is a use for at the end, `open` what of it nothing gives
    yet (of a message then the rest), and names that are taken. `enumerations` are those of the station.
    """

    is_incoming: bool
    fields: RecordType
    wanted: RecordType
    open: RecordType
    taken: frozenset[str]
    enumerations: Mapping[str, tuple[str, ...]]
    folder: Path

    def name(self, stem: str) -> str:
        """A name that is free."""
        stem = re.sub(r"\W+", "_", stem).strip("_") or "value"
        names = (stem, *(f"{stem}_{number}" for number in range(2, 1000)))
        return next(each for each in names if each not in self.taken and each not in self.fields)

    def type_name(self, type_: FieldType) -> str | None:
        """How a variable's document writes a type."""
        match type_:
            case BooleanType():
                return "bool"
            case IntegerRange() if domain(type_) is not None:
                return str(type_)
            case EnumerationType():
                return next((name for name, values in self.enumerations.items() if values == type_.values), None)
        return None

    @property
    def leaves(self) -> list[tuple[str, FieldType]]:
        """The fields, those within messages too, the most telling first: those that nobody else has taken."""
        found = list(_leaves(self.fields))
        return sorted(found, key=lambda each: each[0] in self.taken)


def _leaves(fields: RecordType, above: str = "", depth: int = 0) -> Iterator[tuple[str, FieldType]]:
    for name, type_ in fields.items():
        path = f"{above}{name}"
        if not isinstance(type_, NestedType):
            yield path, type_
        elif depth < DEEPEST:
            yield from _leaves(type_.fields, f"{path}.", depth + 1)


def candidates(kind: str, spot: Spot) -> list[Candidate]:
    """Stages of a kind that could stand there, the likeliest first; where the record suggests none, one about any
    field, so that the builder can say why not. There is none of `python` without a function that could be called, and
    none that gives something where nothing is left to be given.
    """
    found = list(_MAKERS[kind](spot))
    giving = GIVING_VARIABLES if spot.is_incoming else GIVING_FIELDS
    if found or kind == "python" or (kind in giving and not spot.open):
        return found
    return list(_anything(kind, spot))


def _anything(kind: str, spot: Spot) -> Iterator[Candidate]:
    """A stage of a kind about any field, where no field suggests one."""
    name = next((path for path, _ in spot.leaves), "field")
    target = next(iter(spot.open), "")
    forms: dict[str, object] = {
        "rename": {name: target} if spot.is_incoming else {target: name},
        "constant": {target: 0},
        "expression": {spot.name(f"{name}_again"): name},
        "discretise": {"field": name, "variable": spot.name(f"{name}_name"), "ranges": {"low": [None, 0]}},
        "undiscretise": {"variable": name, "field": target, "values": {"low": [0.0]}},
        "map": {"field": name, "variable": target, "values": {"0": 0}},
        "match": {"field": name, "variable": spot.name(f"{name}_is_ready"), "equals": "ready"},
        "member": {"field": name, "item": 0, "variable": spot.name(f"has_{name}")},
        "remember": {"variable": spot.name(f"last_{name}"), "of": name},
        "filter": f"{name}",
        "debounce": {"fields": [name], "seconds": 0.1},
        "timeout": {"fields": [name], "seconds": 1.0},
        "override": {"name": spot.name(name), "fields": {name: {"in": [0]}}, "expires": 60},
        "fold": [name],
        "table": {"fields": [name], "variables": [spot.name(name)], "rows": [{"when": ["any"], "gives": [0]}]},
    }
    yield Candidate({kind: forms[kind]})


def _subjects(spot: Spot, fits: Callable[[FieldType], bool]) -> Iterator[tuple[str, FieldType]]:
    found = ((path, type_) for path, type_ in spot.leaves if fits(type_))
    for each, _ in zip(found, range(MOST_SUBJECTS), strict=False):
        yield each


def _truth(path: str, type_: FieldType) -> str | None:
    """A condition on a field."""
    match type_:
        case BooleanType():
            return path
        case EnumerationType():
            return f"{path} == {type_.values[0]}"
        case IntegerRange() | RealType():
            return f"{path} > 0"
        case TextType():
            return f"{path} == 'ready'"
        case ListType(element=IntegerRange() | RealType()):
            return f"{path}[0] > 0"
        case ListType(element=BooleanType()):
            return f"{path}[0]"
    return None


def _rename(spot: Spot) -> Iterator[Candidate]:
    for path, type_ in _subjects(spot, lambda _: True):
        if spot.is_incoming:
            for name, wanted in spot.open.items():
                if name != path and isinstance(wanted, Type) and feeds(type_, wanted):
                    yield Candidate({"rename": {path: name}})
            if (written := spot.type_name(type_)) is not None:
                name = spot.name(path.replace(".", "_"))
                yield Candidate({"rename": {path: name}}, {name: written})
        else:
            for name, wanted in spot.open.items():
                if name != path and fills(type_, wanted):
                    yield Candidate({"rename": {name: path}})


def _expression(spot: Spot) -> Iterator[Candidate]:
    conditions = [(path, _truth(path, type_)) for path, type_ in _subjects(spot, lambda _: True)]
    if spot.is_incoming:
        for path, condition in conditions:
            if condition is not None:
                name = spot.name(f"{path}_is_so")
                yield Candidate({"expression": {name: condition}}, {name: "bool"})
        return
    for name, type_ in spot.open.items():
        if isinstance(type_, BooleanType):
            yield from (Candidate({"expression": {name: each}}) for _, each in conditions if each is not None)
            yield Candidate({"expression": {name: "true"}})
        elif is_numeric(type_):
            numbers = (path for path, given in _subjects(spot, is_numeric) if fills(given, type_))
            yield from (Candidate({"expression": {name: each}}) for each in (*numbers, "0"))


def _constant(spot: Spot) -> Iterator[Candidate]:
    for name, type_ in spot.open.items():
        yield from (Candidate({"constant": {name: value}}) for value in _values(type_)[:1])


def _discretise(spot: Spot) -> Iterator[Candidate]:
    for path, type_ in _subjects(spot, _has_numbers):
        for name, values, declares in _named(path, spot):
            made: dict[str, object] = {"field": path, "variable": name}
            if isinstance(type_, ListType):
                points = {value: [float(index)] * (type_.length or 1) for index, value in enumerate(values[:-1])}
                made |= {"values": points, "tolerance": 0.1, "otherwise": values[-1]}
            else:
                low = type_.minimum if isinstance(type_, IntegerRange) else 0
                bounds = [None, *(float(low + index) for index in range(1, len(values))), None]
                made["ranges"] = {value: [bounds[index], bounds[index + 1]] for index, value in enumerate(values)}
            yield Candidate({"discretise": made}, declares)


def _has_numbers(type_: FieldType) -> bool:
    return is_numeric(type_.element if isinstance(type_, ListType) else type_)


def _named(path: str, spot: Spot) -> Iterator[tuple[str, tuple[str, ...], dict[str, str]]]:
    """The variables with names that a field could become, with their values, and what must be declared for them."""
    for name, wanted in spot.open.items():
        if isinstance(wanted, EnumerationType) and 1 < len(wanted.values) <= MOST_POINTS:
            yield name, wanted.values, {}
    for enumeration, values in spot.enumerations.items():
        if 1 < len(values) <= MOST_POINTS:
            name = spot.name(f"{path}_{enumeration}")
            yield name, values, {name: enumeration}


def _undiscretise(spot: Spot) -> Iterator[Candidate]:
    for path, type_ in _subjects(spot, lambda each: isinstance(each, EnumerationType)):
        assert isinstance(type_, EnumerationType)
        for name, wanted in spot.open.items():
            axes = (wanted.length or 1) if isinstance(wanted, ListType) else 1
            if _has_numbers(wanted):
                values = {value: [float(index)] * axes for index, value in enumerate(type_.values[:MOST_POINTS])}
                yield Candidate({"undiscretise": {"variable": path, "field": name, "values": values}})


def _map(spot: Spot) -> Iterator[Candidate]:
    for path, type_ in _subjects(spot, lambda each: is_textual(each) or domain(each) is not None or is_numeric(each)):
        given = _values(type_)[:MOST_POINTS]
        if not given:
            continue
        if spot.is_incoming:
            first, *others = map(_key, given[:2])
            values = {first: True, **dict.fromkeys(others, False)}
            name = spot.name(f"{path}_means")
            more = {} if domain(type_) is not None and len(given) <= len(values) else {"otherwise": False}
            yield Candidate({"map": {"field": path, "variable": name, "values": values, **more}}, {name: "bool"})
            continue
        for name, wanted in spot.open.items():
            if (meant := _values(wanted)) and not isinstance(wanted, ListType):
                values_out = {_key(value): meant[index % len(meant)] for index, value in enumerate(given)}
                yield Candidate({"map": {"field": name, "variable": path, "values": values_out}})


def _table(spot: Spot) -> Iterator[Candidate]:
    for path, type_ in _subjects(spot, lambda each: not isinstance(each, ListType) and bool(_values(each))):
        when = _values(type_)[0]
        if spot.is_incoming:
            name = spot.name(f"{path}_is_so")
            rows = [{"when": [when], "gives": [True]}]
            made = {"fields": [path], "variables": [name], "rows": rows, "otherwise": [False]}
            yield Candidate({"table": made}, {name: "bool"})
            continue
        for name, wanted in spot.open.items():
            if (meant := _values(wanted)) and not isinstance(wanted, ListType):
                rows = [{"when": [when], "gives": [meant[0]]}]
                yield Candidate(
                    {"table": {"fields": [path], "variables": [name], "rows": rows, "otherwise": [meant[-1]]}}
                )


def _match(spot: Spot) -> Iterator[Candidate]:
    for path, _ in _subjects(spot, is_textual):
        name = spot.name(f"{path}_is_ready")
        yield Candidate({"match": {"field": path, "variable": name, "equals": "ready"}}, {name: "bool"})


def _member(spot: Spot) -> Iterator[Candidate]:
    for path, type_ in _subjects(spot, lambda each: isinstance(each, ListType)):
        assert isinstance(type_, ListType)
        for item in _values(type_.element)[:1]:
            name = spot.name(f"has_{path}")
            yield Candidate({"member": {"field": path, "item": item, "variable": name}}, {name: "bool"})


def _remember(spot: Spot) -> Iterator[Candidate]:
    for path, type_ in _subjects(spot, lambda each: True):
        narrow = spot.open.get(path, type_)
        if (written := spot.type_name(narrow)) is not None:
            name = spot.name(f"last_{path}")
            yield Candidate({"remember": {"variable": name, "of": path}}, {name: written})


def _filter(spot: Spot) -> Iterator[Candidate]:
    for path, type_ in _subjects(spot, lambda _: True):
        if (condition := _truth(path, type_)) is not None:
            yield Candidate({"filter": condition})
    yield Candidate({"filter": True})


def _timed(kind: str, seconds: float) -> Callable[[Spot], Iterator[Candidate]]:
    def make(spot: Spot) -> Iterator[Candidate]:
        for path, _ in _subjects(spot, lambda _: True):
            yield Candidate({kind: {"fields": [path], "seconds": seconds}})

    return make


def _periodic(kind: str) -> Callable[[Spot], Iterator[Candidate]]:
    return lambda _: iter([Candidate({kind: {"every": 1.0}})])


def _override(spot: Spot) -> Iterator[Candidate]:
    among = spot.leaves if spot.is_incoming else [*spot.open.items(), *spot.leaves]
    for path, type_ in among[:MOST_SUBJECTS]:
        bounds: dict[str, object] | None = None
        if isinstance(type_, RealType):
            bounds = {"between": [0.0, 1.0]}
        elif not isinstance(type_, ListType) and (values := _values(type_)):
            bounds = {"in": values[:MOST_POINTS]}
        if bounds is not None:
            yield Candidate({"override": {"name": spot.name(path), "fields": {path: bounds}, "expires": 60}})


def _fold(spot: Spot) -> Iterator[Candidate]:
    for path in list(spot.fields)[:MOST_SUBJECTS]:
        yield Candidate({"fold": [path]})
    yield Candidate({"fold": []})


def _python(spot: Spot) -> Iterator[Candidate]:
    """The functions in the station's files whose parameters are fields of the record."""
    for path in sorted((spot.folder / FOLDER).rglob("*.py")):
        try:
            functions = [each for each in ast.parse(path.read_bytes()).body if isinstance(each, ast.FunctionDef)]
        except (OSError, ValueError, SyntaxError, RecursionError, MemoryError):
            continue
        file = f"{FOLDER}/{path.relative_to(spot.folder / FOLDER).as_posix()}"
        for function in functions:
            reads = {each.arg: _python_type(spot.fields.get(each.arg)) for each in function.args.args}
            if not function.name.startswith("_") and all(reads.values()):
                name = spot.name(function.name) if spot.is_incoming else next(iter(spot.open), function.name)
                settings = {"file": file, "function": function.name, "reads": reads, "gives": {name: "bool"}}
                yield Candidate({"python": settings}, {name: "bool"} if spot.is_incoming else {})


def _python_type(type_: FieldType | None) -> str | None:
    return None if type_ is None or isinstance(type_, NestedType) else str(type_)


def _values(type_: FieldType) -> list[object]:
    """Some values of a type, as a document has them."""
    match type_:
        case BooleanType():
            return [True, False]
        case EnumerationType():
            return list(type_.values)
        case IntegerRange():
            return list(domain(type_) or (max(type_.minimum, 0), min(type_.maximum, 1)))
        case RealType():
            return [0.0, 1.0]
        case TextType():
            return ["ready", "other"]
        case ListType(element, int(length)):
            return [[value] * length for value in _values(element)]
    return []


def _key(value: object) -> str:
    """A value where a name stands."""
    return str(value).lower() if isinstance(value, bool) else str(value)


_MAKERS: Mapping[str, Callable[[Spot], Iterable[Candidate]]] = {
    "rename": _rename,
    "constant": _constant,
    "expression": _expression,
    "discretise": _discretise,
    "undiscretise": _undiscretise,
    "map": _map,
    "table": _table,
    "match": _match,
    "member": _member,
    "remember": _remember,
    "filter": _filter,
    "debounce": _timed("debounce", 0.1),
    "limit": _periodic("limit"),
    "tick": _periodic("tick"),
    "override": _override,
    "fold": _fold,
    "timeout": _timed("timeout", 1.0),
    "python": _python,
}
