"""Immutable values beside frozen dataclasses: whoever uses the one cannot tell it from the other."""

from __future__ import annotations

import dataclasses
import pickle
import subprocess
import sys
from collections.abc import Mapping
from functools import cached_property
from typing import Any

import pytest
from hypothesis import given

from sequence_planner.core.immutable import Immutable, replace, uncompared
from sequence_planner.language.syntax import And, Constant, Not, Span, Variable
from sequence_planner.language.types import BOOLEAN
from sequence_planner.planning.problem import Goal, PlanTick
from support.examples import examples

from .choices import Choices, made_by

Fields = tuple[tuple[Any, ...], dict[str, Any]]


class Value(Immutable):
    """One with a field of each sort."""

    name: str
    parts: tuple[object, ...] = ()
    counts: Mapping[str, int] = {}
    note: str = uncompared(default="none")

    @property
    def size(self) -> int:
        return len(self.parts)


@dataclasses.dataclass(frozen=True)
class Reference:
    """The same by the standard library."""

    name: str
    parts: tuple[object, ...] = ()
    counts: Mapping[str, int] = dataclasses.field(default_factory=dict)
    note: str = dataclasses.field(default="none", compare=False, repr=False)


class Other(Immutable):
    name: str
    parts: tuple[object, ...] = ()


class Nothing(Immutable):
    pass


def arguments(choices: Choices) -> Fields:
    """Some fields by position and some by name, at times too few, twice, or too many."""
    fields: dict[str, tuple[Any, ...]] = {
        "name": ("a", "b"),
        "parts": ((), (1,), (1, [])),
        "counts": ({}, {"x": 1}),
        "note": ("none", "some"),
        "unknown": (0,),
    }
    positions = tuple(choices.pick(values) for values in list(fields.values())[: choices.number(0, 5)])
    left = [name for name in list(fields)[:4] if choices.chance(3)]
    return positions, {name: choices.pick(fields[name]) for name in left}


def made(kind: type[Value | Reference], fields: Fields) -> object:
    """The value, or the kind of error."""
    try:
        return kind(*fields[0], **fields[1])
    except TypeError:
        return TypeError


@given(made_by(arguments), made_by(arguments))
@examples(500)
def test_it_is_made_compared_and_shown_like_a_frozen_dataclass(one: Fields, other: Fields) -> None:
    values, references = [made(Value, each) for each in (one, other)], [made(Reference, each) for each in (one, other)]
    assert [value is TypeError for value in values] == [reference is TypeError for reference in references]
    if TypeError in values:
        return
    assert (values[0] == values[1]) == (references[0] == references[1])
    for value, reference in zip(values, references, strict=True):
        assert repr(value) == repr(reference).replace("Reference", "Value")
        assert vars(value) == vars(reference)
        assert pickle.loads(pickle.dumps(value)) == value


def test_equal_values_hash_alike_and_what_is_not_compared_takes_no_part() -> None:
    one, other = Constant(True, Span(0, 4)), Constant(True, Span(7, 11))
    assert one == other
    assert hash(one) == hash(other)
    assert {Not(one): 1}[Not(other)] == 1
    with pytest.raises(TypeError, match="unhashable"):
        hash(Value("a"))


def test_values_of_different_classes_are_different() -> None:
    assert Value("a") != Other("a")
    assert And((Constant(True),)) != Constant(True)
    assert Nothing() == Nothing()
    assert Nothing() != Value("a")


def test_nothing_of_it_can_be_changed() -> None:
    value = Value("a")
    with pytest.raises(AttributeError, match=r"Value\.name cannot be assigned"):
        value.name = "b"  # type: ignore[misc]
    with pytest.raises(AttributeError, match=r"Value\.note cannot be deleted"):
        del value.note
    with pytest.raises(AttributeError, match=r"Value\.unknown"):
        value.unknown = 1  # type: ignore[attr-defined]
    assert value == Value("a")


def test_a_value_like_another_but_for_some_fields() -> None:
    goal = Goal("done", Variable("x", BOOLEAN), priority=2)
    assert replace(goal, at=3) == Goal("done", Variable("x", BOOLEAN), at=3, priority=2)
    assert dataclasses.replace(goal, at=3) == replace(goal, at=3)
    assert replace(Constant(True, Span(0, 4)), value=False).span == Span(0, 4)
    with pytest.raises(TypeError, match="unknown"):
        replace(goal, unknown=1)


def test_it_is_matched_by_its_fields() -> None:
    match PlanTick(("e",), ()):
        case PlanTick((effect,), ()):
            assert effect == "e"
        case _:
            pytest.fail("it is not matched")


def test_a_missing_field_is_named_with_the_class() -> None:
    with pytest.raises(TypeError, match=r"Value\.__init__\(\) missing 1 required positional argument: 'name'"):
        Value()  # type: ignore[call-arg]


def test_a_class_with_fields_has_none_derived_from_it() -> None:
    with pytest.raises(TypeError, match="cannot be derived"):
        type("More", (Value,), {"__annotations__": {"more": "int"}})


def test_a_pickled_value_is_compared_and_hashed_before_any_other_is_made() -> None:
    pickled = pickle.dumps((PlanTick(("e",), ()), PlanTick(("e",), ())))
    code = f"import pickle; one, other = pickle.loads({pickled!r}); assert one == other"
    subprocess.run((sys.executable, "-c", code), check=True, timeout=60)


def test_the_planner_is_imported_without_the_slow_parts_of_the_standard_library() -> None:
    """Its import counts in the time of each single plan: see the measurements."""
    code = "import sys, sequence_planner.planning.planner; print(*sys.modules)"
    ended = subprocess.run((sys.executable, "-c", code), check=True, timeout=60, capture_output=True, text=True)
    assert not {"dataclasses", "inspect", "logging", "numpy", "pydantic"} & set(ended.stdout.split())


class _Asks:
    """Something of which a pickle is made; meanwhile something is found of the value that has it."""

    def __init__(self) -> None:
        self.owner: _Owner | None = None

    def __reduce__(self) -> tuple[type[_Asks], tuple[()]]:
        if self.owner is not None:
            assert self.owner.found == 1
        return _Asks, ()


class _Owner(Immutable):
    """A value with something that is found of it."""

    part: _Asks
    name: str

    @cached_property
    def found(self) -> int:
        """One."""
        return len(self.name)


def test_something_is_found_of_a_value_while_a_pickle_is_made_of_it() -> None:
    part = _Asks()
    part.owner = owner = _Owner(part, "x")
    again = pickle.loads(pickle.dumps(owner))
    assert (again.name, again.found) == ("x", 1)
