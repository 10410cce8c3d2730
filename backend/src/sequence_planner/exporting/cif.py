"""A plain automaton in the language CIF 3 of Eclipse ESCET, for its data-based supervisor synthesis.

One plant automaton with one location has all variables and edges; what is forbidden is a requirement. Sources: the
language reference of CIF, "Lexical syntax", and "Specifications supported by data-based synthesis".
"""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.plain.steps import plain_transitions
from sequence_planner.automaton.structure import Automaton
from sequence_planner.automaton.transitions import Transition
from sequence_planner.exporting.cif_expressions import Writer, cases_of_copies, offset
from sequence_planner.exporting.cif_words import identifier
from sequence_planner.exporting.names import different, word
from sequence_planner.expressions.syntax import (
    TRUE,
    Comparison,
    Constant,
    Expression,
    Not,
    Variable,
    conjunction,
    conjuncts,
)
from sequence_planner.expressions.types import EnumerationType, IntegerRange, Type


def cif_text(automaton: Automaton) -> str:
    """The CIF specification of a plain automaton, in ASCII. Goals are left out: CIF has none."""
    return "\n".join(_Specification(automaton).lines()) + "\n"


class _Specification:
    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._transitions = plain_transitions(automaton)
        types = list(dict.fromkeys(v.type for v in automaton.variables.values() if isinstance(v.type, EnumerationType)))
        owners = {type_: n for n, v in reversed(list(automaton.variables.items())) if (type_ := v.type) in types}
        # All names are in one scope, so that none hides another. A tuple says what each one names.
        parts = [("automaton", automaton.name)]
        parts += [("variable", name) for name in automaton.variables]
        parts += [("event", event_of(name)) for name in self._transitions]
        parts += [("enumeration", f"{word(owners[type_])}_values") for type_ in types]
        parts += [("literal", f"{word(owners[type_])}_{value}") for type_ in types for value in type_.values]
        self._names = different(parts, lambda part: identifier(part[1]))
        self._types = {type_: self._names["enumeration", f"{word(owners[type_])}_values"] for type_ in types}
        literals = {
            type_: {value: self._names["literal", f"{word(owners[type_])}_{value}"] for value in type_.values}
            for type_ in types
        }
        self._variables = {name: self._names["variable", name] for name in automaton.variables}
        self._writer = Writer(self._variables, literals)
        self._literals = literals

    def lines(self) -> Iterator[str]:
        """The lines of the text."""
        automaton = self._automaton
        yield f"// {_ascii(automaton.title)}"
        for (kind, name), found in self._names.items():
            if found != name and kind in ("variable", "event"):
                yield f"// {found}: {_ascii(name)}"
        yield from self._moved()
        for type_, name in self._types.items():
            yield f"enum {name} = {', '.join(self._literals[type_].values())};"
        for event, controllable in {event_of(n): t.controllable for n, t in self._transitions.items()}.items():
            yield f"{'controllable' if controllable else 'uncontrollable'} {self._names['event', event]};"
        yield ""
        yield f"plant automaton {self._names['automaton', automaton.name]}:"
        yield from (f"  {line}" for line in self._declarations())
        for specification in automaton.specifications.values():
            yield f"  // {_ascii(specification.title)}"
            yield f"  requirement invariant {self._writer.predicate(Not(specification.forbidden)).text};"
        yield "  location:"
        yield f"    initial{self._where(automaton.initial)};"
        yield f"    marked{self._where(automaton.rest)};"
        for name, transition in self._transitions.items():
            yield from (f"    {line}" for line in self._edges(self._names["event", event_of(name)], transition))
        yield "end"

    def _moved(self) -> Iterator[str]:
        for name, variable in self._automaton.variables.items():
            if by := offset(variable.type):
                yield f"// {self._variables[name]} is {by} more than the value, which can be negative"

    def _declarations(self) -> Iterator[str]:
        """The variables; with several initial states, a predicate says which values these have."""
        for name, variable in self._automaton.variables.items():
            of_one = f"= {self._writer.literal(variable.type, variable.initial)}"
            initial = of_one if self._automaton.initial is None else "in any"
            yield f"disc {self._type(variable.type)} {self._variables[name]} {initial};"

    def _type(self, type_: Type) -> str:
        if isinstance(type_, IntegerRange):
            return f"int[{type_.minimum + offset(type_)}..{type_.maximum + offset(type_)}]"
        return self._types[type_] if isinstance(type_, EnumerationType) else "bool"

    def _where(self, predicate: Expression | None) -> str:
        return "" if predicate is None else f" {self._writer.predicate(predicate).text}"

    def _edges(self, event: str, transition: Transition) -> Iterator[str]:
        """One edge, or one for each value of what is copied to a variable of another enumeration."""
        actions = [(a.target, a.value) for a in transition.actions if isinstance(a.target, Variable)]
        for has, written in cases_of_copies(actions):
            equal = (Comparison("==", variable, Constant(value)) for variable, value in has)
            guard = conjunction(*conjuncts(transition.guard), *equal)
            updates = [
                f"{self._variables[to.name]} := "
                + self._writer.value(Constant(written[to.name]) if to.name in written else value, to.type)
                for to, value in actions
            ]
            when = "" if guard == TRUE else f" when {self._writer.predicate(guard).text}"
            do = f" do {', '.join(updates)}" if updates else ""
            yield f"edge {event}{when}{do};"


def _ascii(text: str) -> str:
    """Text for a comment: one line, and no sign that a file in CIF cannot have."""
    return " ".join(text.split()).encode("ascii", "backslashreplace").decode("ascii")
