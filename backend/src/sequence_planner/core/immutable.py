"""Immutable values: what `dataclasses.dataclass(frozen=True)` makes of a class, in less of the time that imports take.

A planner is also started for a single question, and its time then begins with its imports. The standard library
compiles seven methods for each class, and imports `inspect` for itself; here three are compiled, and only for a class
of which there are values. Type checkers know these classes by `dataclass_transform` (PEP 681).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, cast, dataclass_transform

T = TypeVar("T")
ImmutableType = TypeVar("ImmutableType", bound="Immutable")


class _Uncompared:
    def __init__(self, default: object) -> None:
        self.default = default


def uncompared(*, default: T) -> T:
    """The default of a field that takes no part in comparison, hash and representation."""
    return cast(T, _Uncompared(default))


class _DataclassFields:
    """The attributes that the functions of `dataclasses` ask a class for, made when one of them does."""

    def __get__(self, value: object, cls: type[Immutable]) -> dict[str, Any]:
        from dataclasses import make_dataclass  # noqa: PLC0415

        fields: dict[str, Any] = vars(make_dataclass(cls.__name__, cls.__annotations__.items()))["__dataclass_fields__"]
        type.__setattr__(cls, "__dataclass_fields__", fields)
        return fields


@dataclass_transform(frozen_default=True, field_specifiers=(uncompared,))
class Immutable:
    """A value. The annotated names of a class are its fields, in this order; what the class assigns is their default.

    Two values are equal if they are of one class and their fields are equal. An assignment to a field raises
    AttributeError, a class that is derived from one with fields TypeError.
    """

    __match_args__: ClassVar[tuple[str, ...]] = ()
    __dataclass_fields__ = _DataclassFields()
    _compared: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if cls.__match_args__:
            raise TypeError(f"{cls.__qualname__} cannot be derived from a class that has fields")
        fields = tuple(cls.__annotations__)
        aside = {name for name in fields if isinstance(cls.__dict__.get(name), _Uncompared)}
        for name in aside:
            setattr(cls, name, cls.__dict__[name].default)
        type.__setattr__(cls, "__match_args__", fields)
        cls._compared = tuple(name for name in fields if name not in aside)

    # Of the next three a class gets its own when the first of its values is made, or taken from a pickle and compared.

    def __init__(self, *values: object, **named: object) -> None:
        _compile_methods(type(self))
        type(self).__init__(self, *values, **named)

    def __eq__(self, other: object) -> bool:
        _compile_methods(type(self))
        return type(self).__eq__(self, other)

    def __hash__(self) -> int:
        _compile_methods(type(self))
        return hash(self)

    def __repr__(self) -> str:
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in self._compared)})"

    def __deepcopy__(self: ImmutableType, memo: object) -> ImmutableType:
        return self  # nobody can tell a copy from it

    def __getstate__(self) -> dict[str, Any]:
        # What is found of a value is kept with it, and may be found just as another thread makes a pickle of it.
        return vars(self).copy()

    if not TYPE_CHECKING:  # which would take any assignment for right

        def __setattr__(self, name: str, value: object) -> None:
            raise AttributeError(f"{type(self).__qualname__}.{name} cannot be assigned: values are immutable")

        def __delattr__(self, name: str) -> None:
            raise AttributeError(f"{type(self).__qualname__}.{name} cannot be deleted: values are immutable")


def replace(value: ImmutableType, /, **changes: object) -> ImmutableType:
    """A value like this one but for the fields in `changes`. Raises TypeError for a name that is no field."""
    return type(value)(**{name: getattr(value, name) for name in value.__match_args__} | changes)


_METHODS = """
def __init__(self{parameters}):
    {assignments}

def __eq__(self, other):
    return ({own}) == ({others}) if other.__class__ is self.__class__ else NotImplemented

def __hash__(self):
    return hash(({own}))
"""


def _compile_methods(cls: type[Immutable]) -> None:
    """Give it methods without loops: values are made and compared so often that common ones would be too slow."""
    fields, compared = cls.__match_args__, cls._compared
    source = _METHODS.format(
        parameters="".join(f", {name}=_class.{name}" if name in cls.__dict__ else f", {name}" for name in fields),
        assignments="; ".join(f"_assign(self, {name!r}, {name})" for name in fields) or "pass",
        own="".join(f"self.{name}, " for name in compared),
        others="".join(f"other.{name}, " for name in compared),
    )
    methods: dict[str, Any] = {}
    exec(source, {"_class": cls, "_assign": object.__setattr__}, methods)
    for name, method in methods.items():
        method.__qualname__ = f"{cls.__qualname__}.{name}"
        type.__setattr__(cls, name, method)
