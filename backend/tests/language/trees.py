"""Random trees: as they come from the parser, and as they are after names have been resolved."""

from __future__ import annotations

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from sequence_planner.language.lexer import INFIX_LETTERS, KEYWORDS, PREFIX_LETTERS
from sequence_planner.language.syntax import (
    And,
    Arithmetic,
    Assignment,
    BinaryTemporal,
    Comparison,
    Component,
    Constant,
    Expression,
    Implies,
    Membership,
    Name,
    Not,
    Or,
    UnaryTemporal,
    Variable,
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value

RELATIONS = ("==", "!=", "<", "<=", ">", ">=")

PREFIXES, INFIXES = sorted(PREFIX_LETTERS), sorted(INFIX_LETTERS)

_words = st.one_of(
    st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,6}", fullmatch=True).filter(lambda word: word not in KEYWORDS),
    st.sampled_from([*PREFIXES, *INFIXES]),
)


@st.composite
def _components(draw: DrawFn) -> Component:
    arguments = tuple(draw(st.lists(_words, max_size=2)))
    return Component(draw(_words), arguments, bool(arguments) and draw(st.booleans()))


def _is_no_formula(name: Name) -> bool:
    """Whether the name is not one like `F(x)`, which in a formula says that `x` comes to hold."""
    first = name.path[0]
    return len(name.path) > 1 or first.name not in PREFIX_LETTERS or not first.arguments or first.indexed


names: SearchStrategy[Name] = (
    st.lists(_components(), min_size=1, max_size=3).map(tuple).map(Name).filter(_is_no_formula)
)


def _compound(parts: SearchStrategy[Expression]) -> SearchStrategy[Expression]:
    several = st.lists(parts, min_size=2, max_size=3).map(tuple)
    return st.one_of(
        parts.map(Not),
        several.map(And),
        several.map(Or),
        st.builds(Implies, parts, parts),
        st.builds(Comparison, st.sampled_from(RELATIONS), parts, parts),
        st.builds(Membership, parts, st.lists(parts, min_size=1, max_size=3).map(tuple)),
        st.builds(Arithmetic, st.sampled_from("+-"), parts, parts),
    )


# What the grammar allows; much of it has no type.
written: SearchStrategy[Expression] = st.recursive(
    st.one_of(names, st.builds(Constant, st.one_of(st.booleans(), st.integers(-999_999, 999_999)))),
    _compound,
    max_leaves=12,
)


def _formulas(atoms: SearchStrategy[Expression], leaves: int) -> SearchStrategy[Expression]:
    """Formulas of which a good part is temporal, over `atoms`."""
    return st.recursive(
        atoms,
        lambda parts: st.one_of(
            st.builds(UnaryTemporal, st.sampled_from(PREFIXES), parts),
            st.builds(BinaryTemporal, st.sampled_from(INFIXES), parts, parts),
            parts.map(Not),
            st.lists(parts, min_size=2, max_size=3).map(tuple).map(And),
            st.lists(parts, min_size=2, max_size=3).map(tuple).map(Or),
            st.builds(Implies, parts, parts),
        ),
        max_leaves=leaves,
    )


# Formulas as the parser yields them: the letters are also names, and temporal formulas stand wherever brackets can.
_inside = st.one_of(names, st.sampled_from([*PREFIXES, *INFIXES]).map(lambda word: Name((Component(word),))))
written_formulas = _formulas(st.one_of(_inside, written, _compound(_formulas(_inside, 3))), 8)
written_assignments = st.builds(Assignment, names, written, st.none() | written)

POSE = EnumerationType(("unknown", "home", "above"))
TARGET = EnumerationType(("home", "above"))
STATE = EnumerationType(("empty", "placed"))
VARIABLES: dict[str, Type] = {
    "robot.pose": POSE,
    "robot.target": TARGET,
    "bolts[left]": STATE,
    "bolts[right]": STATE,
    "robot.move(home).executing": BOOLEAN,
    "idle": BOOLEAN,
    "count": IntegerRange(0, 3),
    "balance": IntegerRange(-2, 1),
}
_families: tuple[tuple[str, ...], ...] = (
    ("robot.pose", "robot.target"),
    ("bolts[left]", "bolts[right]"),
    ("count", "balance"),
    ("robot.move(home).executing", "idle"),
)

valuations: SearchStrategy[dict[str, Value | None]] = st.fixed_dictionaries(
    {name: st.sampled_from((None, *type_.domain)) for name, type_ in VARIABLES.items()}
)


def _variable(name: str) -> Variable:
    return Variable(name, VARIABLES[name])


@st.composite
def _relations(draw: DrawFn, folds: bool) -> Expression:
    family = draw(st.sampled_from(_families))
    subject = _variable(draw(st.sampled_from(family)))
    values: list[Expression] = [Constant(value) for value in subject.type.domain]
    others: list[Expression] = [*values, *map(_variable, family)]
    left: Expression = subject
    if folds and draw(st.booleans()):  # a parameter stands here
        left = draw(st.sampled_from(values))
    if draw(st.booleans()):
        return Membership(left, tuple(draw(st.lists(st.sampled_from(others), min_size=1, max_size=3))))
    right = draw(st.sampled_from(others))
    if not isinstance(subject.type, IntegerRange):
        sides = draw(st.permutations([left, right]))
        return Comparison(draw(st.sampled_from(("==", "!="))), sides[0], sides[1])
    # The sum stands on the left: a constant on the right must be a value the left can have.
    if draw(st.booleans()):
        return Comparison(draw(st.sampled_from(RELATIONS)), left, Arithmetic(draw(st.sampled_from("+-")), right, left))
    return Comparison(draw(st.sampled_from(RELATIONS)), left, right)


def _predicates(folds: bool) -> SearchStrategy[Expression]:
    flags = st.sampled_from(_families[-1]).map(_variable)
    atoms = st.one_of(flags, _relations(folds), st.booleans().map(Constant))
    return st.recursive(
        atoms,
        lambda parts: st.one_of(
            parts.map(Not),
            st.lists(parts, min_size=2, max_size=3).map(tuple).map(And),
            st.lists(parts, min_size=2, max_size=3).map(tuple).map(Or),
            st.builds(Implies, parts, parts),
            st.builds(Comparison, st.sampled_from(("==", "!=")), parts, parts),
        ),
        max_leaves=10,
    )


# Resolved predicates as a person can write them, and as they are once parameters have been replaced by values.
predicates = _predicates(folds=False)
predicates_with_parameters = _predicates(folds=True)

# Resolved formulas, and traces of valuations to read them over.
formulas = _formulas(st.one_of(st.sampled_from(_families[-1]).map(_variable), predicates), 6)
formulas_with_parameters = _formulas(
    st.one_of(st.sampled_from(_families[-1]).map(_variable), st.booleans().map(Constant)), 8
)
traces = st.lists(valuations, min_size=1, max_size=5)
