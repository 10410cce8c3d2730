"""Ground conditions in the words of a model: its predicates, named sets and relations, and quantifiers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, lru_cache
from itertools import product
from math import prod
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.automaton.lifting.normal_form import (
    ALWAYS,
    NEVER,
    Junction,
    NormalForm,
    ValueLiteral,
    junction,
    negated,
    normal_form,
)
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import Valuation, evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse
from sequence_planner.language.printer import print_expression
from sequence_planner.language.resolver import expand, resolve_predicate
from sequence_planner.language.shorthand.vocabulary import NamedPredicate
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.substitution import rebuilt
from sequence_planner.language.syntax import (
    NOWHERE,
    And,
    Binder,
    Comparison,
    Component,
    Constant,
    Expression,
    ExpressionError,
    Implies,
    Membership,
    Name,
    NamedMembership,
    Not,
    Or,
    Quantified,
    Variable,
    children,
    conjunction,
    conjuncts,
    occurrences,
)
from sequence_planner.language.types import EnumerationType, Value

MOST_KNOWN = 2000  # conditions whose parts are kept
MOST_CALLS = 1024  # of one predicate, each with other values of its parameters
_LEAST_RELATED = 3  # values that are said by their relation to another one


class ToldPart(NamedTuple):
    """A part of a condition in the words of a model, and what it means there, written out. Where that is said of each
    value of a set, `instances` have it for each.
    """

    words: Expression
    condition: Expression
    instances: tuple[tuple[str, Expression], ...] = ()


def phrase(*parts: ToldPart) -> str:
    """Parts of a condition in words."""
    return print_expression(conjunction(*(part.words for part in parts)))


def expansion(parts: Iterable[ToldPart], state: Valuation) -> str | None:
    """Write out what of some parts does not hold in a state; None where they are told as what they mean."""
    told = list(parts)
    if all(part.words == part.condition for part in told):
        return None
    return print_expression(conjunction(*(each for part in told for each in untrue(part.condition, state))))


def untrue(condition: Expression, state: Valuation) -> list[Expression]:
    """The conditions that it is put together of, and that do not hold for certain."""
    return [each for each in conjuncts(condition) if evaluate(each, state) is not True]


class ModelWording:
    """The words of the model that `automaton` was made of."""

    def __init__(self, automaton: Automaton) -> None:
        self._parts: dict[int, tuple[Expression, tuple[ToldPart, ...]]] = {}
        self.indices = automaton.indices
        self.scope = automaton.scope
        self._vocabulary = automaton.vocabulary

    def __bool__(self) -> bool:
        """Return whether there are words for more than variables and values."""
        return bool(self._vocabulary.domains or self._vocabulary.predicates)

    def in_words(self, condition: Expression) -> str:
        """A ground condition as it is told to people."""
        return print_expression(self.lifted(condition))

    def lifted(self, condition: Expression) -> Expression:
        """A ground condition with names for what they stand for. Its text means the same, as `scope` resolves it."""
        return self._lifted(condition) if self else condition

    def told_parts(self, condition: Expression) -> tuple[ToldPart, ...]:
        """The parts of a ground condition that must all hold, those together of which the model speaks together. What
        is asked of the same object again is known.
        """
        known = self._parts.get(id(condition))
        if known is None or known[0] is not condition:
            if len(self._parts) >= MOST_KNOWN:
                self._parts.clear()
            known = self._parts[id(condition)] = condition, tuple(self._told(condition))
        return known[1]

    def lacking(self, condition: Expression, state: Valuation) -> Iterator[ToldPart]:
        """The parts of a condition that do not hold for certain. Of what is said of each value those are told for which
        it does not, unless a predicate has a name for it.
        """
        for part in self.told_parts(condition):
            if evaluate(part.condition, state) is True:
                continue
            left = [(value, each) for value, each in part.instances if evaluate(each, state) is not True]
            if isinstance(part.words, Quantified) and len(left) < len(part.instances):
                yield from self._for_some(part.words, left)
            else:
                yield part

    def _for_some(self, said: Quantified, instances: Sequence[tuple[str, Expression]]) -> list[ToldPart]:
        """What is said of each value, told of some of them."""
        values = tuple(Name((Component(value),)) for value, _ in instances)
        some = replace(said, binders=(replace(said.binders[0], domain=values),))
        together = ToldPart(some, conjunction(*(each for _, each in instances)))
        each = [ToldPart(self.lifted(condition), condition) for _, condition in instances]
        return [together] if len(phrase(together)) < sum(len(phrase(one)) for one in each) else each

    def _told(self, condition: Expression) -> Iterator[ToldPart]:
        for part in conjuncts(self.lifted(condition)):
            if not self:
                yield ToldPart(part, part)
                continue
            meant = simplify(resolve_predicate(parse(print_expression(part)), self.scope))
            yield ToldPart(part, meant, tuple(self._instances(part)))

    def _instances(self, part: Expression) -> Iterator[tuple[str, Expression]]:
        """What `all pair in bolt_pair: …` says of each value; nothing of another part."""
        if isinstance(part, Quantified) and part.quantifier == "all":
            body, (binder,) = parse(print_expression(part.body)), part.binders
            type_ = self._vocabulary.domains[str(binder.domain)]
            for value in type_.values:
                scope = self.scope.binding({binder.word: (value, type_)})
                yield value, simplify(resolve_predicate(body, scope))

    def meaning(self, told: Expression, scope: NameScope | None = None) -> NormalForm | None:
        """The normal form of what is told means; None if it means nothing."""
        try:
            return normal_form(resolve_predicate(told, scope or self.scope))
        except ExpressionError:
            return None

    def _lifted(self, condition: Expression) -> Expression:
        if (form := normal_form(condition)) in (ALWAYS, NEVER):
            return condition
        if (call := self._calls.get(form)) is not None:
            return call
        match condition:
            case And() | Or():
                return self._joined(condition)
            case Not(operand) if not isinstance(form, ValueLiteral):
                return Not(self._lifted(operand))
            case Implies(left, right):
                return Implies(self._lifted(left), self._lifted(right))
        return self._named(form, condition) if isinstance(form, ValueLiteral) else condition

    # Predicates

    @cached_property
    def _calls(self) -> dict[NormalForm, Expression]:
        """Each predicate with the values of its parameters, and its negation, by what it means."""
        found: dict[NormalForm, Expression] = {}
        for predicate in self._vocabulary.predicates.values():
            for form, call in self.calls_of(predicate):
                if form not in (ALWAYS, NEVER):
                    found.setdefault(form, call)
                    found.setdefault(negated(form), Not(call))
        return found

    def calls_of(self, predicate: NamedPredicate) -> Iterator[tuple[NormalForm, Name]]:
        """A predicate with each choice of the values of its parameters, by what it means."""
        domains = [type_.values for type_ in predicate.parameters.values()]
        if prod(map(len, domains)) > MOST_CALLS:
            return
        *path, last = predicate.name.split(".")
        for values in product(*domains):
            try:
                meant = expand(predicate, values, self.scope, NOWHERE)
            except ExpressionError:
                return
            yield normal_form(meant), Name((*map(Component, path), Component(last, values)))

    @cached_property
    def _parts_of_calls(self) -> list[tuple[Junction, Expression]]:
        """Those that can be a part of a longer junction, the longest first."""
        found = [(form, call) for form, call in self._calls.items() if isinstance(form, Junction)]
        return sorted(found, key=lambda each: -len(each[0].parts))

    # Sets and relations

    @cached_property
    def _sets(self) -> dict[frozenset[Value], Name]:
        found: dict[frozenset[Value], Name] = {}
        for name, type_ in self._vocabulary.domains.items():
            found.setdefault(frozenset(type_.values), Name((Component(name),)))
        return found

    @cached_property
    def _partners(self) -> dict[frozenset[Value], tuple[str, list[str], bool] | None]:
        """The values that are related to a single one: the relation, that value, and whether it stands behind; None
        where several are.
        """
        found: dict[frozenset[Value], tuple[str, list[str], bool] | None] = {}
        for name, relation in self._vocabulary.relations.items():
            for is_behind, type_ in ((True, relation.types[1]), (False, relation.types[0])):
                for value in type_.values:
                    pairs = relation.pairs if is_behind else {(b, a) for a, b in relation.pairs}
                    related: frozenset[Value] = frozenset(a for a, b in pairs if b == value)
                    if len(related) < _LEAST_RELATED:
                        continue
                    before = found.get(related, (name, [value], is_behind))
                    is_same = before is not None and before[:2] == (name, [value])
                    found[related] = before if is_same else None
        return found

    def _named(self, literal: ValueLiteral, written: Expression) -> Expression:
        """`literal` by the name of a set, or a relation to a value; else as it is written."""
        variable = Variable(literal.variable, literal.type)
        if not isinstance(literal.type, EnumerationType) or min(len(literal.values), len(literal.others)) < 2:
            return written
        for values, negative in ((literal.values, False), (literal.others, True)):
            if (name := self._sets.get(values)) is not None:
                member = NamedMembership(variable, name)
                return Not(member) if negative else member
        for values, negative in ((literal.values, False), (literal.others, True)):
            if (partner := self._partners.get(values)) is not None:
                relation, (value,), is_behind = partner
                subject = parse(literal.variable)
                if isinstance(subject, Name):
                    inside = subject if len(subject.path) > 1 or subject.path[0].arguments else str(subject)
                    call = Name((Component(relation, (inside, value) if is_behind else (value, inside)),))
                    return Not(call) if negative else call
        return written

    # Conditions that must all hold, and those of which one must

    def _joined(self, condition: And | Or) -> Expression:
        is_all = isinstance(condition, And)
        parts = self._merged(_flat(condition, type(condition)), is_all)
        found: dict[NormalForm, Expression] = {}
        for whole, call in self._parts_of_calls:
            if whole.is_all is is_all and whole.parts <= parts.keys():
                parts = _replaced(parts, whole.parts, whole)
                found[whole] = call
        for form, covered, said in self._compared(parts, is_all):
            parts = _replaced(parts, covered, form)
            found[form] = said
        for domain, type_ in self._spoken_of(parts.values()):
            for form, covered, said in self._quantified(parts, found, is_all, domain, type_):
                parts = _replaced(parts, covered, form)
                found[form] = said
        operands = tuple(found[form] if form in found else self._lifted(part) for form, part in parts.items())
        return operands[0] if len(operands) == 1 else type(condition)(operands)

    def _merged(self, operands: Iterable[Expression], is_all: bool) -> dict[NormalForm, Expression]:
        """The operands by their normal forms, those about one variable of an enumeration together."""
        found: dict[NormalForm, Expression] = {}
        places: dict[str, NormalForm] = {}
        for operand in operands:
            form = normal_form(operand)
            if not isinstance(form, ValueLiteral) or not isinstance(form.type, EnumerationType):
                found.setdefault(form, operand)
            elif (before := places.get(form.variable)) is None:
                found[form], places[form.variable] = operand, form
            else:
                together = junction(is_all, (before, form))
                assert isinstance(together, ValueLiteral)  # else all of it were always so, or never
                found = {
                    (together if each is before else each): (_listed(together) if each is before else part)
                    for each, part in found.items()
                }
                places[form.variable] = together
        return found

    def _compared(
        self, parts: Mapping[NormalForm, Expression], is_all: bool
    ) -> Iterator[tuple[NormalForm, set[NormalForm], Expression]]:
        """Parts about the same two variables that say together how these are related."""
        groups: dict[tuple[Variable, ...], set[NormalForm]] = {}
        for form, part in parts.items():
            if isinstance(form, Junction):
                read = tuple(sorted({Variable(v.name, v.type) for v in occurrences(part)}, key=lambda each: each.name))
                if len(read) == 2 and all(isinstance(each.type, EnumerationType) for each in read):
                    groups.setdefault(read, set()).add(form)
        for (one, other), forms in groups.items():
            if len(forms) < 2 or any(not isinstance(each, Junction | ValueLiteral) for each in forms):
                continue
            whole = junction(is_all, forms)
            said = self._related(one, other, whole)
            if said is not None and self.meaning(parse(print_expression(said))) is not None:
                yield whole, forms, said

    def _related(self, one: Variable, other: Variable, whole: NormalForm) -> Expression | None:
        every = set(product(one.type.domain, other.type.domain))
        pairs = _pairs(whole, one, other, every)
        if pairs is None:
            return None
        equal = {(a, b) for a, b in every if a == b}
        if pairs == equal or pairs == every - equal:
            return Comparison("==" if pairs == equal else "!=", one, other)
        first, second = parse(one.name), parse(other.name)
        for name, relation in self._vocabulary.relations.items():
            for (left, right), related in (
                ((first, second), {pair for pair in every if pair in relation.pairs}),
                ((second, first), {(a, b) for a, b in every if (b, a) in relation.pairs}),
            ):
                if pairs in (related, every - related) and isinstance(left, Name) and isinstance(right, Name):
                    call = Name((Component(name, (left, right)),))
                    return call if pairs == related else Not(call)
        return None

    def _spoken_of(self, parts: Collection[Expression]) -> list[tuple[str, EnumerationType]]:
        """The enumerations and sets about each value of which there is something among the parts."""
        mentioned = set().union(*map(_mentioned, parts)) if len(parts) > 1 else set()
        return [
            (domain, type_)
            for domain, type_ in self._vocabulary.domains.items()
            if 2 <= len(type_.values) <= len(parts) and mentioned.issuperset(type_.values)
        ]

    def _quantified(
        self,
        parts: Mapping[NormalForm, Expression],
        found: Mapping[NormalForm, Expression],
        is_all: bool,
        domain: str,
        type_: EnumerationType,
    ) -> Iterator[tuple[NormalForm, set[NormalForm], Expression]]:
        """Parts that say the same of each value of `domain`."""
        values = type_.values
        for form, part in parts.items():
            if values[0] not in _mentioned(part) or (word := self._word(part, type_)) is None:
                continue
            body = abstracted(found.get(form) or self._lifted(part), values[0], word)
            read = parse(print_expression(body))
            forms = [self.meaning(read, self.scope.binding({word: (value, type_)})) for value in values]
            covered = {each for each in forms if each is not None and each in parts}
            if None in forms or len(covered) != len(values):
                continue
            quantifier = "all" if is_all else "any"
            said = Quantified(quantifier, None, (Binder(word, Name((Component(domain),))),), None, body)
            text, whole = print_expression(said), junction(is_all, covered)
            if self.meaning(parse(text)) == whole and len(text) < sum(
                len(print_expression(parts[each])) for each in covered
            ):
                yield whole, covered, said
                return

    def _parameters(self, name: str) -> Mapping[str, str]:
        """Those of a variable, or of the ability or operation of which it is a flag."""
        return self.indices.get(name) or self.indices.get(name.rpartition(".")[0], {})

    def _word(self, part: Expression, type_: EnumerationType) -> str | None:
        """A word for values of an enumeration, such as a declaration has that is read."""
        domains = self._vocabulary.domains
        families = (self._parameters(without_arguments(each.name)) for each in occurrences(part))
        for parameters in (*families, *self.indices.values()):
            for word, domain in parameters.items():
                if domains.get(domain) == type_:
                    return word
        return None


def abstracted(condition: Expression, value: str, word: str) -> Expression:
    """`condition` with a word in the place of a value, also in the names of variables."""

    def again(part: Expression) -> Expression:
        return abstracted(part, value, word)

    match condition:
        case Constant(found):
            return Name((Component(word),)) if found == value else condition
        case Variable(name):
            return _without(parse(name), value, word) if value in name else condition
        case Name():
            return _without(condition, value, word)
        case NamedMembership(left, domain):
            return NamedMembership(again(left), domain)
        case Quantified(quantifier, number, binders, where, body):
            return Quantified(quantifier, number, binders, None if where is None else again(where), again(body))
        case _:
            return rebuilt(condition, again)


def _without(name: Expression, value: str, word: str) -> Expression:
    def argument(each: str | Name) -> str | Name:
        if isinstance(each, str):
            return word if each == value else each
        inner = _without(each, value, word)
        return inner if isinstance(inner, Name) else each

    if not isinstance(name, Name):
        return name
    return Name(tuple(part._replace(arguments=tuple(map(argument, part.arguments))) for part in name.path))


def _flat(condition: Expression, kind: type[And | Or]) -> Iterator[Expression]:
    if isinstance(condition, kind):
        for operand in condition.operands:
            yield from _flat(operand, kind)
    else:
        yield condition


def _replaced(
    parts: Mapping[NormalForm, Expression], covered: Iterable[NormalForm], form: NormalForm
) -> dict[NormalForm, Expression]:
    """The parts with `form` where the first that it covers stood."""
    left, found = set(covered), dict[NormalForm, Expression]()
    is_new = True
    for each, part in parts.items():
        if each not in left:
            found[each] = part
        elif is_new:
            found[form], is_new = part, False
    return found


def _listed(literal: ValueLiteral) -> Expression:
    """A literal about a variable of an enumeration, with its values."""
    variable = Variable(literal.variable, literal.type)
    inside = [value for value in literal.type.domain if value in literal.values]
    outside = [value for value in literal.type.domain if value in literal.others]
    for sign, values in (("==", inside), ("!=", outside)):
        if len(values) == 1:
            return Comparison(sign, variable, Constant(values[0]))
    if len(inside) <= len(outside):
        return Membership(variable, tuple(map(Constant, inside)))
    return Not(Membership(variable, tuple(map(Constant, outside))))


def _pairs(
    form: NormalForm, one: Variable, other: Variable, every: set[tuple[Value, Value]]
) -> set[tuple[Value, Value]] | None:
    """The values of two variables for which a condition about them holds; None if it is not known."""
    if isinstance(form, ValueLiteral):
        at = 0 if form.variable == one.name else 1
        return {pair for pair in every if pair[at] in form.values}
    if not isinstance(form, Junction):
        return None
    found = set(every) if form.is_all else set()
    for part in form.parts:
        if (pairs := _pairs(part, one, other, every)) is None:
            return None
        found = found & pairs if form.is_all else found | pairs
    return found


def _mentioned(condition: Expression) -> set[str]:
    """The words that stand in it as values, and in names as arguments."""
    found: set[str] = set()
    pending: list[Expression] = [condition]
    while pending:
        part = pending.pop()
        if isinstance(part, Constant):
            found.add(str(part.value))
        elif isinstance(part, Variable) and ("[" in part.name or "(" in part.name):
            name = parse(part.name)
            found |= {str(each) for step in (name.path if isinstance(name, Name) else ()) for each in step.arguments}
        pending += children(part)
    return found


class Same:
    """An automaton, which is compared by its identity: to compare all of it takes long."""

    def __init__(self, automaton: Automaton) -> None:
        self.automaton = automaton

    def __hash__(self) -> int:
        return id(self.automaton)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and other.automaton is self.automaton


def wording_of(automaton: Automaton) -> ModelWording:
    """The words of the model that `automaton` was made of, which are looked for once for each of the last few."""
    return _wording_of(Same(automaton))


@lru_cache(maxsize=4)
def _wording_of(same: Same) -> ModelWording:
    return ModelWording(same.automaton)
