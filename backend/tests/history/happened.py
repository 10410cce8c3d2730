# ruff: noqa: ANN401 - what annotations are is no type
"""Random happenings of a station, and all that they may hold."""

from __future__ import annotations

from typing import Any, get_args, get_type_hints

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from core.choices import made_by
from core.random_expressions import predicate
from core.random_stations import automaton
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.execution.events import Event
from sequence_planner.language.syntax import Expression, Not, UnaryTemporal, Variable
from sequence_planner.planning.problem import Proof

HAPPENINGS: tuple[type, ...] = get_args(Event)
SECONDS = st.floats(-1e12, 1e12, allow_nan=False)


@st.composite
def happening(draw: DrawFn) -> tuple[Automaton, Any]:
    """A station, and something that may happen there."""
    station = draw(made_by(automaton))
    return station, draw(value(draw(st.sampled_from(HAPPENINGS)), station))


def value(form: Any, station: Automaton) -> SearchStrategy[Any]:
    """Any value of a type; predicates are in the names of the station."""
    variables = [Variable(name, type_) for name, type_ in station.types.items()]
    plain = made_by(lambda choices: predicate(choices, variables))
    temporal = st.tuples(st.sampled_from("FGXN"), plain).map(lambda both: UnaryTemporal(*both))
    expression = st.one_of(plain, temporal, temporal.map(Not))
    return st.from_type(form) if form in (str, int) else _resolved(form, expression)


def _resolved(form: type, expression: SearchStrategy[Expression]) -> SearchStrategy[Any]:
    with_expressions = {Expression: expression, float: SECONDS, Proof | None: st.none(), Proof: st.none()}

    def of(form: Any) -> SearchStrategy[Any]:
        if form in with_expressions:
            return with_expressions[form]
        arguments = get_args(form)
        if arguments:
            return _compound(form, arguments, of)
        names = getattr(form, "__match_args__", None)
        if names is None or not hasattr(form, "__dataclass_fields__"):
            return st.from_type(form)
        hints = get_type_hints(form)
        return st.fixed_dictionaries({name: of(hints[name]) for name in names}).map(lambda all_: form(**all_))

    return of(form)


def _compound(form: Any, arguments: tuple[Any, ...], of: Any) -> SearchStrategy[Any]:
    from types import NoneType, UnionType  # noqa: PLC0415
    from typing import Union, get_origin  # noqa: PLC0415

    origin = get_origin(form)
    if origin in (Union, UnionType):
        rest = tuple(each for each in arguments if each is not NoneType)
        if len(rest) < len(arguments):
            return st.one_of(st.none(), of(Union[rest]))  # noqa: UP007
        return st.one_of(*map(of, rest))
    if origin is frozenset:
        return st.frozensets(of(arguments[0]), max_size=3)
    if origin is tuple and Ellipsis in arguments:
        return st.lists(of(arguments[0]), max_size=3).map(tuple)
    if origin is tuple:
        return st.tuples(*map(of, arguments))
    return st.dictionaries(of(arguments[0]), of(arguments[1]), max_size=3)
