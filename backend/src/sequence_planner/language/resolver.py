"""From names to variables and values, with types checked, and with all that is written for short written out.

Names mean what `language.names.scope` finds; one beside a value of an enumeration may also be one of its values.

Quantifiers become conjunctions, disjunctions and the like over the values of their words; named sets, relations, maps,
predicates and the functions of ordered enumerations what they stand for. Where an index or an argument is a variable,
there is a case for each of its values. What has no value, as what comes before the first, makes its comparison false.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import TYPE_CHECKING, TypeVar

from sequence_planner.language.evaluator import RELATIONS
from sequence_planner.language.names.scope import ENDS, STEPS, NameScope, require_usable, unknown_name
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.parser import temporal_refused
from sequence_planner.language.shorthand.cases import (
    BY_CASES,
    Cases,
    Count,
    Dependent,
    alternatives_of,
    by_value,
    counted,
    disjunction,
    distributed,
    mapped,
    related,
    require_few,
    truth_of,
)
from sequence_planner.language.shorthand.misuse import decided_by_number, hint_of_truth, not_among, unfit, unordered
from sequence_planner.language.shorthand.vocabulary import NamedPredicate
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.substitution import placed_at
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    Arithmetic,
    Assignment,
    BinaryTemporal,
    Binder,
    CircleError,
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
    RecordConstant,
    Selection,
    Span,
    UnaryTemporal,
    UnusableError,
    Variable,
    conjunction,
    first_temporal,
)
from sequence_planner.language.types import (
    BOOLEAN,
    BooleanType,
    EnumerationType,
    IntegerRange,
    Type,
    contains,
    described,
    overlap,
)
from sequence_planner.texts.late import message

if TYPE_CHECKING:
    from sequence_planner.texts.message import Message

T = TypeVar("T")

# An argument that has no name.
_A_VALUE = ""

# What a comparison is with its sides exchanged.
MIRRORED = {"==": "==", "!=": "!=", "<": ">", "<=": ">=", ">": "<", ">=": "<="}


def resolve_predicate(expression: Expression, scope: NameScope) -> Expression:
    """`expression` with all names resolved, checked to be a truth value. Raises `ExpressionError`."""
    return _truth(expression, scope)


def resolve_formula(formula: Expression, scope: NameScope) -> Expression:
    """A formula of LTL over finite traces with all names resolved. Raises `ExpressionError`."""

    def part(inner: Expression) -> Expression:
        return resolve_formula(inner, scope)

    span = formula.span
    match formula:
        case Not(operand):
            return Not(part(operand), span)
        case And(operands):
            return And(tuple(map(part, operands)), span)
        case Or(operands):
            return Or(tuple(map(part, operands)), span)
        case Implies(left, right):
            return Implies(part(left), part(right), span)
        case UnaryTemporal(operator, operand):
            return UnaryTemporal(operator, part(operand), span)
        case BinaryTemporal(operator, left, right):
            return BinaryTemporal(operator, part(left), part(right), span)
        case Quantified():
            return _quantified(formula, scope, resolve_formula)
    if (inside := first_temporal(formula)) is not None:
        raise ExpressionError(message("wrong.temporal-inside", operator=inside.operator), inside.span)
    return resolve_predicate(formula, scope)


def resolve_assignments(action: Assignment, scope: NameScope) -> tuple[Assignment, ...]:
    """An action with all names resolved, one for each choice of its binders' values. Raises `ExpressionError`."""
    if not action.binders:
        return (resolve_assignment(action, scope),)
    single = Assignment(action.target, action.value, action.condition, action.span)
    found = []
    for bound in _bindings(action.binders, None, scope, action.span):
        condition = None if action.condition is None else resolve_predicate(action.condition, bound)
        if condition is None or simplify(condition) != FALSE:
            found.append(resolve_assignment(single, bound))
    return tuple(found)


def resolve_assignment(action: Assignment, scope: NameScope) -> Assignment:
    """An action with all names resolved. Raises `ExpressionError`, also when no value it can have is in the target's
    domain; whether each it has where it is taken is, `fitting` says.
    """
    if not isinstance(action.target, Name):
        raise TypeError("the action is resolved already")
    if str(action.target) in scope.parameters:
        raise ExpressionError(message("wrong.written-parameter", name=str(action.target)), action.target.span)
    target = _target(action.target, scope)
    value = _written(action.value, scope, target.type)
    condition = None if action.condition is None else resolve_predicate(action.condition, scope)
    return Assignment(target, value, condition, action.span)


def _target(name: Name, scope: NameScope) -> Variable:
    """The variable that an action writes; one of an array may be told by a name that has a value there."""
    if (found := scope.find(name)) is not None:
        return found
    if _predicate(name, scope) is not None:
        raise ExpressionError(message("wrong.written-predicate", name=str(name)), name.span)
    if isinstance(dependent := _dynamic(name, scope), tuple) and isinstance(dependent[0], Variable):
        return dependent[0]
    if dependent is not None:
        raise ExpressionError(message("wrong.which-variable", name=str(name)), name.span)
    raise unknown_name(name, scope, ())


def expression_type(expression: Expression, scope: NameScope) -> Type:
    """The type of an expression with names. Raises `ExpressionError`."""
    return _typed(expression, scope, None)[1]


def _truth(expression: Expression, scope: NameScope) -> Expression:
    resolved, found = _typed(expression, scope, BOOLEAN)
    if not isinstance(found, BooleanType):
        raise unfit(BOOLEAN, found, expression)
    return truth_of(resolved, expression.span) if isinstance(resolved, BY_CASES) else resolved


def _written(expression: Expression, scope: NameScope, expected: Type) -> Expression:
    resolved, found = _typed(expression, scope, expected)
    if isinstance(resolved, BY_CASES):
        if not isinstance(found, BooleanType):
            raise ExpressionError(message("wrong.depends", name=print_name(expression)), expression.span)
        resolved = truth_of(resolved, expression.span)
    fits = contains(expected, resolved.value) if isinstance(resolved, Constant) else overlap(found, expected)
    if not fits:
        raise unfit(expected, found, expression)
    return resolved


def _typed(expression: Expression, scope: NameScope, expected: Type | None) -> tuple[Dependent, Type]:
    span = expression.span
    match expression:
        case Constant(value):
            if isinstance(value, bool):
                return expression, BOOLEAN
            if isinstance(value, int):
                return expression, IntegerRange(value, value)
            return expression, EnumerationType((value,))
        case Name():
            return _named(expression, scope, expected)
        case Variable(_, type_):
            return expression, type_
        case Not(operand):
            return Not(_truth(operand, scope), span), BOOLEAN
        case And(operands):
            return And(tuple(_truth(o, scope) for o in operands), span), BOOLEAN
        case Or(operands):
            return Or(tuple(_truth(o, scope) for o in operands), span), BOOLEAN
        case Implies(left, right):
            return Implies(_truth(left, scope), _truth(right, scope), span), BOOLEAN
        case Comparison(operator, left, right):
            return _comparison(operator, left, right, span, scope), BOOLEAN
        case Membership(left, options):
            subject, type_ = _typed(left, scope, None)
            members = tuple(_comparable(option, type_, scope) for option in options)
            return _membership(subject, members, span), BOOLEAN
        case NamedMembership(left, domain):
            return _named_membership(left, domain, span, scope), BOOLEAN
        case Quantified():
            if expression.quantifier == "count":
                return _count(expression, scope)
            return _quantified(expression, scope, resolve_predicate), BOOLEAN
        case Arithmetic("+" | "-" as operator, left, right):
            return _arithmetic(operator, left, right, span, scope)
        case Arithmetic() | RecordConstant() | Selection():
            raise ExpressionError(message("wrong.over-records"), span)
        case UnaryTemporal(operator) | BinaryTemporal(operator):
            raise temporal_refused(operator, span)


def _membership(subject: Dependent, members: tuple[Dependent, ...], span: Span) -> Expression:
    """That the subject is one of `members`."""

    def build(one: Expression, *others: Expression) -> Expression:
        return Membership(one, others, span)

    if not any(isinstance(member, BY_CASES) for member in members):
        return truth_of(distributed((subject, *members), span, build), span)
    # A member without a value is none; the others count all the same.
    parts = (distributed((subject, each), span, lambda a, b: Comparison("==", a, b, span)) for each in members)
    return disjunction([truth_of(part, span) for part in parts], span)


def _named_membership(left: Expression, domain: Name, span: Span, scope: NameScope) -> Expression:
    type_ = _domain(domain, scope)
    if (
        isinstance(left, Name)
        and left.is_word
        and str(left) not in scope.parameters
        and scope.find(left) is None
        and str(left) in type_.values
    ):
        subject: Dependent = Constant(str(left), left.span)
    else:
        subject, found = _typed(left, scope, None)
        if not overlap(found, type_):
            raise _incomparable(found, type_, domain.span)
    return _membership(subject, tuple(Constant(value, domain.span) for value in type_.values), span)


def _domain(name: Name, scope: NameScope) -> EnumerationType:
    """The values of a named set or enumeration."""
    domains = scope.vocabulary.domains
    word = str(name)
    if (full := scope.vocabulary.domain_named(word, scope.prefixes)) is None:
        require_usable(word, name.span, scope)
        is_value = any(word in type_.values for type_ in domains.values())
        hint = message("hint.single-value", value=word) if is_value else suggestion(word, domains)
        raise ExpressionError(message("wrong.no-set", name=word, hint=hint), name.span)
    return domains[full]


# Quantifiers.

_Resolve = Callable[[Expression, NameScope], Expression]


def _bindings(
    binders: tuple[Binder, ...], where: Expression | None, scope: NameScope, span: Span
) -> Iterator[NameScope]:
    """The scope of each choice of values that `where` lets through for certain or in some states."""
    types: dict[str, EnumerationType] = {}
    for binder in binders:
        types[binder.word] = _bound_type(binder, {**types}, scope)
    copies = 1
    for type_ in types.values():
        copies *= len(type_.values)
    require_few(copies * scope.copies, span)
    for values in product(*(type_.values for type_ in types.values())):
        chosen = {word: (value, type_) for (word, type_), value in zip(types.items(), values, strict=True)}
        yield scope.binding(chosen, copies)


def _bound_type(binder: Binder, before: Mapping[str, EnumerationType], scope: NameScope) -> EnumerationType:
    word = binder.word
    if isinstance(binder.domain, Name):
        type_ = _domain(binder.domain, scope)
    else:
        type_ = EnumerationType(tuple(map(str, binder.domain)))
        known = dict.fromkeys(value for domain in scope.vocabulary.domains.values() for value in domain.values)
        for value in binder.domain:
            if str(value) not in known:
                raise ExpressionError(
                    message("wrong.not-a-value", value=str(value), hint=suggestion(str(value), known)), value.span
                )
    if word in before or word in scope.parameters:
        raise ExpressionError(message("wrong.word-taken", word=word), binder.span)
    if (hidden := scope.find(Name((Component(word),)))) is not None:
        raise ExpressionError(message("wrong.word-hides-variable", word=word, variable=hidden.name), binder.span)
    if any(word in domain.values for domain in (type_, *scope.vocabulary.domains.values())):
        raise ExpressionError(message("wrong.word-hides-value", word=word), binder.span)
    return type_


def _instances(quantified: Quantified, scope: NameScope, resolve: _Resolve) -> Iterator[tuple[Expression, Expression]]:
    """What `where` and the body say for each choice of values that is not left out in every state."""
    for bound in _bindings(quantified.binders, quantified.where, scope, quantified.span):
        chosen = TRUE if quantified.where is None else simplify(resolve_predicate(quantified.where, bound))
        if chosen != FALSE:
            yield chosen, resolve(quantified.body, bound)


def _quantified(quantified: Quantified, scope: NameScope, resolve: _Resolve) -> Expression:
    """A quantifier written out; its body is resolved with `resolve`."""
    span = quantified.span
    instances = list(_instances(quantified, scope, resolve))
    if (decided := decided_by_number(quantified, scope.vocabulary, scope.prefixes)) is not None and not decided.always:
        raise ExpressionError(decided.message, span)
    if quantified.quantifier == "all":
        parts = [body if chosen == TRUE else Implies(chosen, body, span) for chosen, body in instances]
        return parts[0] if len(parts) == 1 else And(tuple(parts), span) if parts else TRUE
    parts = [conjunction(chosen, body) for chosen, body in instances]
    match quantified.quantifier:
        case "any":
            return disjunction(parts, span)
        case "none":
            return conjunction(*(Not(part, span) for part in parts))
        case "exactly":
            return counted("==", quantified.number or 0, parts, span)
        case "at least":
            return counted(">=", quantified.number or 0, parts, span)
        case "at most":
            return counted("<=", quantified.number or 0, parts, span)
    raise ExpressionError(message("wrong.count"), span)


def _count(quantified: Quantified, scope: NameScope) -> tuple[Dependent, Type]:
    """The number of choices for which the body holds, case by case."""
    conditions = tuple(conjunction(*instance) for instance in _instances(quantified, scope, resolve_predicate))
    return Count(conditions, quantified.span), IntegerRange(0, len(conditions))


# Names for short: predicates, relations, maps, and the order of an enumeration.


def _for_short(name: Name, scope: NameScope) -> tuple[Dependent, Type] | None:
    """The meaning of a name that is no variable, or None if it has none."""
    if (predicate := _predicate(name, scope)) is not None:
        return _expanded(name, predicate, scope), BOOLEAN
    head = name.path[-1]
    if head.arguments and not any(part.arguments for part in name.path[:-1]):
        vocabulary = scope.vocabulary
        if head.indexed and (table := _declared(name, vocabulary.maps, scope)) is not None:
            _require_arguments(name, head.name, (_A_VALUE,))
            argument = _argument_of(name, 0, table.source, scope)
            return mapped(argument, table.table, name.span), table.target
        if not head.indexed and (relation := _declared(name, vocabulary.relations, scope)) is not None:
            _require_arguments(name, head.name, (_A_VALUE, _A_VALUE))
            first, second = (_argument_of(name, index, type_, scope) for index, type_ in enumerate(relation.types))
            return related(first, second, relation.pairs, name.span), BOOLEAN
        if len(name.path) == 1 and not head.indexed and (head.name in STEPS or head.name in ENDS):
            return _in_order(name, scope)
    return _dynamic(name, scope)


def _predicate(name: Name, scope: NameScope) -> NamedPredicate | None:
    if any(part.arguments for part in name.path[:-1]) or name.path[-1].indexed:
        return None
    return _declared(name, scope.vocabulary.predicates, scope)


def _declared(name: Name, table: Mapping[str, T], scope: NameScope) -> T | None:
    """What a name stands for in a table of names for short, under one of the prefixes or as it is."""
    if not table:
        return None
    skeleton = ".".join(part.name for part in name.path)
    found = (table.get(prefix + skeleton) for prefix in (*scope.prefixes, ""))
    return next((each for each in found if each is not None), None)


def _expanded(name: Name, predicate: NamedPredicate, scope: NameScope) -> Expression:
    """What a predicate says about its arguments."""
    _require_arguments(name, predicate.name, tuple(predicate.parameters))
    cases = [_argument_of(name, index, type_, scope) for index, type_ in enumerate(predicate.parameters.values())]

    def instance(*values: Expression) -> Dependent:
        words = tuple(str(value.value) for value in values if isinstance(value, Constant))
        if any(word not in type_.values for word, type_ in zip(words, predicate.parameters.values(), strict=True)):
            return FALSE  # a parameter of a larger enumeration, with a value that the predicate is not about
        return placed_at(expand(predicate, words, scope, name.span), name.span)

    return truth_of(distributed(cases, name.span, instance), name.span)


def expand(predicate: NamedPredicate, words: tuple[str, ...], scope: NameScope, span: Span) -> Expression:
    """What a predicate says for these values of its parameters. Raises `ExpressionError`, placed at `span`."""
    vocabulary = scope.vocabulary
    key = predicate.name, words
    if (known := vocabulary.expanded.get(key)) is not None:
        return known
    if predicate.name in vocabulary.expanding:
        circle = (*vocabulary.expanding[vocabulary.expanding.index(predicate.name) :], predicate.name)
        raise CircleError(circle, span)
    parameters = {
        parameter: (word, type_) for (parameter, type_), word in zip(predicate.parameters.items(), words, strict=True)
    }
    own = NameScope(scope.variables, predicate.prefixes, parameters, vocabulary)
    vocabulary.expanding.append(predicate.name)
    try:
        found = simplify(resolve_predicate(predicate.body, own))
    except CircleError as error:
        raise CircleError(error.circle, span) from None
    except ExpressionError as error:
        raise UnusableError(message("wrong.means-nothing-as", name=predicate.name, why=error.message), span) from None
    finally:
        vocabulary.expanding.pop()
    vocabulary.expanded[key] = found
    return found


def _require_arguments(name: Name, declared: str, wanted: tuple[str, ...]) -> None:
    found = len(name.path[-1].arguments)
    if found != len(wanted):
        raise ExpressionError(
            message("wrong.arguments", name=declared, wanted=_how_many(wanted), found=found), name.span
        )


def _how_many(wanted: tuple[str, ...]) -> Message:
    if not wanted:
        return message("arguments.none")
    if wanted[0] == _A_VALUE:
        return message("arguments.count", count=len(wanted))
    return message("arguments.named", count=len(wanted), names=", ".join(wanted))


def _argument_of(name: Name, index: int, type_: EnumerationType, scope: NameScope) -> Dependent:
    """An argument of a predicate, relation or map, which must have a value in common with `type_`."""
    written = name.argument(index)
    word = str(written)
    is_known = word in type_.values or word in scope.parameters or scope.find(written) is not None
    wrong = not_among(word, name, type_, scope.vocabulary, scope.prefixes) if written.is_word and not is_known else None
    if wrong is not None:
        raise ExpressionError(wrong, written.span)
    found = _comparable(written, type_, scope)
    return by_value(found, name.span) if not isinstance(found, Constant) else found


def _in_order(name: Name, scope: NameScope) -> tuple[Dependent, Type]:
    """`previous(x)`, `next(x)`, `first(set)` and `last(set)`."""
    head = name.path[0]
    vocabulary = scope.vocabulary
    if head.name in ENDS:
        _require_arguments(name, head.name, (_A_VALUE,))
        set_name = name.argument(0)
        domain = _domain(set_name, scope)
        if (order := vocabulary.order_of(domain)) is None:
            raise unordered(str(set_name), domain, set_name.span)
        values = [value for value in order.values if value in domain.values]
        return Constant(values[ENDS[head.name]], name.span), domain
    _require_arguments(name, head.name, (_A_VALUE,))
    written = name.argument(0)
    value, type_ = _value_of_argument(written, scope)
    if not isinstance(type_, EnumerationType) or (order := vocabulary.order_of(type_)) is None:
        raise unordered(str(written), type_, written.span)
    step = STEPS[head.name]
    neighbours = zip(order.values, order.values[1:], strict=False)
    table = dict(neighbours if step > 0 else ((after, before) for before, after in neighbours))
    return mapped(by_value(value, name.span), table, name.span), order


def _value_of_argument(written: Name, scope: NameScope) -> tuple[Dependent, Type]:
    """The value of an argument that may also be a value of some ordered enumeration."""
    if written.is_word and str(written) not in scope.parameters and scope.find(written) is None:
        for order in scope.vocabulary.ordered:
            if str(written) in order.values:
                return Constant(str(written), written.span), EnumerationType((str(written),))
    return _typed(written, scope, None)


def _dynamic(name: Name, scope: NameScope) -> tuple[Dependent, Type] | None:
    """A variable or flag with an index or argument that has a value itself: `bolts[previous(pair)]`, `bolts[pose]`."""
    for position, part in enumerate(name.path):
        for index, argument in enumerate(part.arguments):
            cases = _index_cases(argument, name.span, scope)
            if cases is None:
                continue
            found: list[tuple[Expression, Expression]] = []
            type_: Type | None = None
            some = not cases
            for condition, word in cases:
                arguments = (*part.arguments[:index], word, *part.arguments[index + 1 :])
                component = Component(part.name, arguments, part.indexed)
                inner = Name((*name.path[:position], component, *name.path[position + 1 :]), name.span)
                variable = scope.find(inner)
                value = _dynamic(inner, scope) if variable is None else (variable, variable.type)
                if value is None:
                    continue
                some, type_ = True, value[1] if type_ is None else type_
                found += [(conjunction(condition, c), v) for c, v in alternatives_of(value[0])]
                require_few(len(found), name.span)
            if not some:
                return None
            if len(found) == 1 and found[0][0] == TRUE:
                return found[0][1], type_ or BOOLEAN
            return Cases(tuple(found)), type_ or _any_type(name, scope)
    return None


def _any_type(name: Name, scope: NameScope) -> Type:
    """The type of the variables that bear the name, where there is none for this index."""
    words = [part.name for part in name.path]
    for prefix in (*scope.prefixes, ""):
        start = prefix + ".".join(words)
        for other, type_ in scope.variables.items():
            if other.startswith((f"{start}[", f"{start}(")):
                return type_
    raise unknown_name(name, scope, ())


def _index_cases(argument: str | Name, span: Span, scope: NameScope) -> tuple[tuple[Expression, str], ...] | None:
    """The values of an index with the condition of each; None for a word that is a value, or nothing known."""
    if isinstance(argument, str):
        if argument in scope.parameters:
            return None
        argument = Name((Component(argument),), span)
        variable = scope.find(argument)
        if variable is None or not isinstance(variable.type, EnumerationType):
            return None
    value, type_ = _typed(argument, scope, None)
    if not isinstance(type_, EnumerationType):
        return None
    cases = by_value(value, span)
    return tuple(
        (condition, str(each.value)) for condition, each in alternatives_of(cases) if isinstance(each, Constant)
    )


def print_name(expression: Expression) -> str:
    """An expression as it may be named in a sentence."""
    return str(expression) if isinstance(expression, Name) else "this"


def _named(name: Name, scope: NameScope, expected: Type | None) -> tuple[Dependent, Type]:
    word = str(name)
    if word in scope.parameters:
        value, type_ = scope.parameters[word]
        return Constant(value, name.span), type_
    variable = scope.find(name)
    values = _names(expected) if expected is not None else ()
    if word in values:
        if variable is not None and isinstance(variable.type, EnumerationType):
            raise ExpressionError(message("wrong.value-and-variable", name=word), name.span)
        return Constant(word, name.span), EnumerationType((word,))
    if variable is None:
        if (found := _for_short(name, scope)) is not None:
            return found
        raise unknown_name(name, scope, values)
    return variable, variable.type


def _names(type_: Type) -> tuple[str, ...]:
    return type_.values if isinstance(type_, EnumerationType) else ()


def _comparison(operator: str, left: Expression, right: Expression, span: Span, scope: NameScope) -> Expression:
    # A bare word may be a value whose enumeration only the other side tells, so the side that stands alone goes first.
    swapped = _needs_enumeration(left, scope, right)
    first, second = (right, left) if swapped else (left, right)
    if operator not in ("==", "!="):
        return _ordering(operator, first, second, swapped, span, scope)
    subject, type_ = _typed(first, scope, None)
    other = _comparable(second, type_, scope)
    return _compared(operator, *((other, subject) if swapped else (subject, other)), span)


def _ordering(
    operator: str, first: Expression, second: Expression, swapped: bool, span: Span, scope: NameScope
) -> Expression:
    """A comparison of integers, or of values of an ordered enumeration."""
    subject, type_ = _typed(first, scope, None)
    order = scope.vocabulary.order_of(type_)
    other = _comparable(second, order or type_, scope)
    if order is None:
        if not isinstance(type_, IntegerRange):
            id_ = "wrong.compares-integers" if not isinstance(type_, EnumerationType) else "wrong.compares-ordered"
            raise ExpressionError(message(id_, operator=operator, type=described(type_)), span)
        return _compared(operator, *((other, subject) if swapped else (subject, other)), span)
    relation, place = RELATIONS[operator], order.values.index

    def build(a: Expression, b: Expression) -> Dependent:
        assert isinstance(a, Constant)
        assert isinstance(b, Constant)
        known = a.value in order.values and b.value in order.values
        return Constant(known and relation(place(str(a.value)), place(str(b.value))), span)

    sides = (other, subject) if swapped else (subject, other)
    left, right = (by_value(side, span) for side in sides)
    return truth_of(
        distributed((left,), span, lambda a: truth_of(distributed((right,), span, lambda b: build(a, b)), span)), span
    )


def _compared(operator: str, left: Dependent, right: Dependent, span: Span) -> Expression:
    if isinstance(left, BY_CASES) or isinstance(right, BY_CASES):
        for side, other, sign in ((left, right, operator), (right, left, MIRRORED[operator])):
            if isinstance(side, Count) and isinstance(other, Constant):
                return counted(sign, int(other.value), side.conditions, span)
        return truth_of(distributed((left, right), span, lambda a, b: Comparison(operator, a, b, span)), span)
    return Comparison(operator, left, right, span)


def _needs_enumeration(word: Expression, scope: NameScope, other: Expression) -> bool:
    """Return whether `word`, left of a comparison, is to be read as a value of what stands on the `other` side."""
    if not isinstance(word, Name) or str(word) in scope.parameters:
        return False
    if scope.type_of(word) is None:
        unknown = isinstance(other, Name) and str(other) not in scope.parameters and scope.type_of(other) is None
        # With two unknown words, the one to complain about is the one that is nobody's value.
        return not unknown or (_is_a_value(word, scope) and not _is_a_value(other, scope))
    type_ = scope.type_of(other) if isinstance(other, Name) else None
    return isinstance(type_, EnumerationType) and str(word) in type_.values


def _is_a_value(word: Expression, scope: NameScope) -> bool:
    return any(str(word) in _names(type_) for type_ in scope.variables.values())


def _comparable(expression: Expression, type_: Type, scope: NameScope) -> Dependent:
    """`expression` resolved beside something of `type_`, with which it must have a value in common."""
    resolved, found = _typed(expression, scope, type_)
    # A parameter counts with all its values, so that an ability means the same for each of them.
    if not overlap(found, type_):
        raise _incomparable(type_, found, expression.span, hint_of_truth(type_, found))
    return resolved


def _incomparable(one: Type, other: Type, span: Span, hint: str = "") -> ExpressionError:
    return ExpressionError(message("wrong.compared", one=described(one), other=described(other), hint=hint), span)


def _arithmetic(
    operator: str, left: Expression, right: Expression, span: Span, scope: NameScope
) -> tuple[Dependent, Type]:
    parts = [_typed(side, scope, None) for side in (left, right)]
    for side, (_, type_) in zip((left, right), parts, strict=True):
        if not isinstance(type_, IntegerRange):
            raise ExpressionError(message("wrong.needs-integers", operator=operator, type=described(type_)), side.span)
    (a, range_a), (b, range_b) = parts
    assert isinstance(range_a, IntegerRange)
    assert isinstance(range_b, IntegerRange)
    if operator == "+":
        result = IntegerRange(range_a.minimum + range_b.minimum, range_a.maximum + range_b.maximum)
    else:
        result = IntegerRange(range_a.minimum - range_b.maximum, range_a.maximum - range_b.minimum)
    return distributed((a, b), span, lambda one, other: Arithmetic(operator, one, other, span)), result
