"""What is written for short means what it says: quantifiers, sets, orders, relations, maps and predicates."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.resolver import resolve_assignments, resolve_formula, resolve_predicate
from sequence_planner.language.shorthand.cases import MOST_CASES
from sequence_planner.language.shorthand.vocabulary import NamedPredicate, ValueMap, ValueRelation, Vocabulary
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import (
    And,
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
)
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from support.examples import examples

from .marking import assert_refused

PAIR = EnumerationType(("p1", "p2", "p3"))
POSE = EnumerationType(("unknown", "home", "a", "b"))
NAMED = EnumerationType(("home", "a", "b"))
FREE = EnumerationType(("home", "a"))
STATE = EnumerationType(("empty", "placed", "tight"))
TOOL = EnumerationType(("none", "big", "small"))
DOMAINS = {"pair": PAIR, "pose": POSE, "named": NAMED, "free": FREE, "state": STATE, "tool": TOOL}
NEAR = frozenset({("home", "a"), ("a", "home"), ("a", "b"), ("b", "a"), ("home", "home")})
TOOLS: Mapping[str, Value] = {"unknown": "none", "home": "none", "a": "big", "b": "small"}
VARIABLES: dict[str, Type] = {
    **{f"bolts[{pair}]": STATE for pair in PAIR.values},
    "at": POSE,
    "goal": NAMED,
    "tool": TOOL,
    "chosen": PAIR,
    "n": IntegerRange(0, 3),
    "robot.ready": BOOLEAN,
    "robot.at": POSE,
}
VOCABULARY = Vocabulary(
    DOMAINS,
    (PAIR,),
    {"near": ValueRelation((POSE, POSE), NEAR)},
    {"tool_for": ValueMap(POSE, TOOL, TOOLS)},
    {
        each.name: each
        for each in (
            NamedPredicate("all_tight", {}, parse("all q in pair: bolts[q] == tight")),
            NamedPredicate("is_at", {"p": NAMED}, parse("at == p or goal == p")),
            NamedPredicate("robot.is_ready", {}, parse("ready and at != unknown"), ("robot.",)),
            NamedPredicate("broken", {}, parse("bolts[p9] == tight")),
            NamedPredicate("chicken", {}, parse("not egg")),
            NamedPredicate("egg", {}, parse("chicken")),
        )
    },
)
SCOPE = NameScope(VARIABLES, vocabulary=VOCABULARY)


def meaning(text: str) -> str:
    return print_expression(simplify(resolve_predicate(parse(text), SCOPE)))


@pytest.mark.parametrize(
    ("short", "long"),
    [
        ("all q in pair: bolts[q] == tight", "bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight"),
        ("any q in pair where q != p2: bolts[q] == tight", "bolts[p1] == tight or bolts[p3] == tight"),
        ("none q in {p1, p3}: bolts[q] == tight", "not bolts[p1] == tight and not bolts[p3] == tight"),
        ("all q in pair where q < p1: bolts[q] == tight", "true"),
        ("any q in pair where q > p3: bolts[q] == tight", "false"),
        ("all q in pair where n == 1: bolts[q] == tight", "n == 1 implies bolts[p1] == tight"),
        ("at least 3 q in pair: bolts[q] == tight", "bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight"),
        ("at most 0 q in {p1}: bolts[q] == tight", "not bolts[p1] == tight"),
        (
            "(count q in pair: bolts[q] == tight) > 2",
            "bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight",
        ),
        ("all q, r in {p1, p2} where q < r: bolts[q] == bolts[r]", "bolts[p1] == bolts[p2]"),
        ("any q in {p1, p2}, s in {tight}: bolts[q] == s", "bolts[p1] == tight or bolts[p2] == tight"),
        ("n == 1 and any q in {p1}: n == 2 or n == 3", "n == 1 and (n == 2 or n == 3)"),
        ("at in free", "at in {home, a}"),
        ("bolts[previous(p3)] == tight", "bolts[p2] == tight"),
        ("bolts[previous(p1)] == tight", "false"),
        ("bolts[previous(p1)] != tight", "false"),
        ("chosen == first(pair) or chosen == last(pair)", "chosen == p1 or chosen == p3"),
        ("chosen < p3", "chosen in {p1, p2}"),
        ("p2 <= chosen", "chosen in {p2, p3}"),
        ("next(chosen) == p3", "chosen == p2"),
        ("near(at, home)", "at in {home, a}"),
        (
            "near(goal, at)",
            "goal == home and at in {home, a} or goal == a and at in {home, b} or goal == b and at == a",
        ),
        ("tool_for[a] == tool", "big == tool"),
        ("tool_for[at] == big", "at == a"),
        ("tool_for[goal] in {big, small}", "goal == home and none in {big, small}"),
        ("all_tight", "bolts[p1] == tight and bolts[p2] == tight and bolts[p3] == tight"),
        ("is_at(home)", "at == home or goal == home"),
        ("robot.is_ready", "robot.ready and robot.at != unknown"),
        ("bolts[chosen] == tight and n == 0", "n == 0"),
    ],
)
def test_it_is_written_out(short: str, long: str) -> None:
    resolved = resolve_predicate(parse(short), SCOPE)
    for valuation in valuations(limit=400):
        assert evaluate(resolved, valuation) is _short(parse(short), valuation, {})
    if (
        short.endswith(("bolts[q] == tight", "at in free", "home)", "== p3", "< p3", "is_ready"))
        and "where n" not in short
    ):
        assert meaning(short) == long


def test_a_quantifier_in_a_formula_and_an_action() -> None:
    formula = resolve_formula(parse_formula("all q in {p1, p2}: F (bolts[q] == tight)"), SCOPE)
    assert print_expression(formula) == "F (bolts[p1] == tight) and F (bolts[p2] == tight)"
    actions = resolve_assignments(parse_assignment("all q in pair where q > p1: bolts[q] := placed if n == 1"), SCOPE)
    assert [print_assignment(each) for each in actions] == [
        "bolts[p2] := placed if p2 > p1 and n == 1".replace("p2 > p1", "true"),
        "bolts[p3] := placed if p3 > p1 and n == 1".replace("p3 > p1", "true"),
    ]


# An independent reading: of the tree as it was parsed, in one state, without writing anything out.


class _NothingError(Exception):
    """There is no such value."""


def _short(tree: Expression, state: Mapping[str, Value | None], bound: Mapping[str, str]) -> bool:
    """Whether a condition holds."""
    try:
        return bool(_value(tree, state, bound))
    except _NothingError:
        return False


def _value(tree: Expression, state: Mapping[str, Value | None], bound: Mapping[str, str]) -> Value:
    match tree:
        case Constant(value):
            return value
        case Name(path):
            return _named(path, state, bound)
        case Not(operand):
            return not _short(operand, state, bound)
        case And(operands):
            return all(_short(each, state, bound) for each in operands)
        case Or(operands):
            return any(_short(each, state, bound) for each in operands)
        case Implies(left, right):
            return not _short(left, state, bound) or _short(right, state, bound)
        case Comparison(sign, left, right):
            return _compare(sign, _value(left, state, bound), _value(right, state, bound))
        case Membership(left, options):
            subject = _value(left, state, bound)
            return any(_same(subject, each, state, bound) for each in options)
        case NamedMembership(left, domain):
            return _value(left, state, bound) in DOMAINS[str(domain)].values
        case Quantified(quantifier, number, binders, where, body):
            words = [each.word for each in binders]
            domains = [
                DOMAINS[str(each.domain)].values if isinstance(each.domain, Name) else tuple(map(str, each.domain))
                for each in binders
            ]
            choices = [{**bound, **dict(zip(words, values, strict=True))} for values in product(*domains)]
            chosen = [each for each in choices if where is None or _short(where, state, each)]
            found = sum(_short(body, state, each) for each in chosen)
            needed = number or 0
            return {
                "all": found == len(chosen),
                "any": found > 0,
                "none": found == 0,
                "exactly": found == needed,
                "at least": found >= needed,
                "at most": found <= needed,
                "count": found,
            }[quantifier]
    raise AssertionError(tree)


def _same(subject: Value, option: Expression, state: Mapping[str, Value | None], bound: Mapping[str, str]) -> bool:
    try:
        return _value(option, state, bound) == subject
    except _NothingError:
        return False


def _compare(sign: str, left: Value, right: Value) -> bool:
    if sign in ("==", "!="):
        return (left == right) is (sign == "==")
    a, b = (PAIR.values.index(each) if isinstance(each, str) else each for each in (left, right))
    return {"<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b}[sign]


def _named(path: tuple[Component, ...], state: Mapping[str, Value | None], bound: Mapping[str, str]) -> Value:
    head = path[-1]
    words = [_argument(each, state, bound) for each in head.arguments] if head.name not in ("first", "last") else []
    match head.name:
        case "first" | "last":
            values = DOMAINS[str(head.arguments[0])].values
            return values[0] if head.name == "first" else values[-1]
        case "previous" | "next":
            place = PAIR.values.index(words[0]) + (1 if head.name == "next" else -1)
            if not 0 <= place < len(PAIR.values):
                raise _NothingError
            return PAIR.values[place]
        case "near":
            return (words[0], words[1]) in NEAR
        case "tool_for":
            return TOOLS[words[0]]
        case "all_tight":
            return all(state[f"bolts[{pair}]"] == "tight" for pair in PAIR.values)
        case "is_at":
            return words[0] in NAMED.values and words[0] in (state["at"], state["goal"])
        case "is_ready":
            return state["robot.ready"] is True and state["robot.at"] != "unknown"
    if not head.arguments and head.name in bound:
        return bound[head.name]
    full = ".".join(part.name for part in path) + (f"[{words[0]}]" if words else "")
    found = state.get(full, head.name)
    assert found is not None
    return found


def _argument(argument: str | Name, state: Mapping[str, Value | None], bound: Mapping[str, str]) -> str:
    path = argument.path if isinstance(argument, Name) else (Component(argument),)
    return str(_named(path, state, bound))


def valuations(limit: int) -> list[dict[str, Value | None]]:
    """States, evenly spread over all there are."""
    domains = [type_.domain for type_ in VARIABLES.values()]
    count = 1
    for domain in domains:
        count *= len(domain)
    found = []
    for step in range(limit):
        number = step * count // limit + step % 7
        state: dict[str, Value | None] = {}
        for name, domain in zip(VARIABLES, domains, strict=True):
            number, place = divmod(number, len(domain))
            state[name] = domain[place]
        found.append(state)
    return found


# Texts, built from the inside: `words` are those that quantifiers around have bound to pairs.

_PAIRS = ("p1", "p2", "p3", "chosen", "first(pair)", "last(pair)")
_POSES = ("home", "a", "b", "at", "goal", "robot.at")


def _pairs(words: tuple[str, ...]) -> SearchStrategy[str]:
    plain = st.sampled_from((*_PAIRS, *words))
    return st.one_of(plain, st.builds("{}({})".format, st.sampled_from(("previous", "next")), plain))


def _conditions(words: tuple[str, ...], depth: int) -> SearchStrategy[str]:
    pairs, poses = _pairs(words), st.sampled_from(_POSES)
    atoms: list[SearchStrategy[str]] = [
        st.builds("bolts[{}] {} {}".format, pairs, st.sampled_from(("==", "!=")), st.sampled_from(STATE.values)),
        st.builds("bolts[{}] == bolts[{}]".format, pairs, pairs),
        st.builds(
            "{} {} {}".format,
            st.sampled_from(("chosen", *words)),
            st.sampled_from(("==", "!=", "<", "<=", ">", ">=")),
            pairs,
        ),
        st.builds("near({}, {})".format, poses, poses),
        st.builds("tool_for[{}] {} {}".format, poses, st.sampled_from(("==", "!=")), st.sampled_from(("big", "tool"))),
        st.builds("{} in {}".format, st.sampled_from(("at", "goal")), st.sampled_from(("free", "named", "{home, b}"))),
        st.builds("is_at({})".format, poses),
        st.sampled_from(("all_tight", "robot.is_ready", "n == 2")),
    ]
    if depth == 0:
        return st.one_of(atoms)
    inner = _conditions(words, depth - 1)
    word = "qrs"[depth % 3] + str(depth)
    bound = (*words, word)
    domains = st.sampled_from(("pair", "{p1, p3}"))
    body, where = _conditions(bound, depth - 1), _conditions(bound, 0)
    quantifiers = st.sampled_from(("all", "any", "none", "exactly 1", "at least 2", "at most 1"))
    chosen = st.one_of(st.just(""), where.map(" where {}".format))
    return st.one_of(
        *atoms,
        st.builds("not ({})".format, inner),
        st.builds("({}) {} ({})".format, inner, st.sampled_from(("and", "or", "implies")), inner),
        st.builds("{} {} in {}{}: {}".format, quantifiers, st.just(word), domains, chosen, body),
        st.builds(
            "(count {} in {}{}: {}) {} {}".format,
            st.just(word),
            domains,
            chosen,
            body,
            st.sampled_from(("==", "!=", "<", "<=", ">", ">=")),
            st.sampled_from(("0", "1", "2", "3", "n")),
        ),
    )


_STATES = valuations(24)


@given(_conditions((), 2))
@examples(300)
def test_it_means_what_it_says_in_each_state(text: str) -> None:
    tree = parse(text)
    assert parse(print_expression(tree)) == tree
    try:
        resolved = resolve_predicate(tree, SCOPE)
    except ExpressionError as error:
        # A literal may be none of what it stands beside, or it has no partner anywhere: that is told.
        assert error.message.startswith(("cannot compare", "unknown")) or str(MOST_CASES) in error.message
        return
    simple = simplify(resolved)
    for state in _STATES:
        said = _short(tree, state, {})
        assert evaluate(resolved, state) is said
        assert evaluate(simple, state) is said


BEFORE = "`where` stands before the colon, as in all p in poses where p != home: …"
NEVER = "so this never holds: write a smaller number"
CANNOT_POSE = "cannot compare one of {unknown, home, a, b} with one of {none, big, small}"
NO_ORDER = "`{}` is one of {}, which has no order: declare its enumeration with `ordered: true`"


def _condition(text: str) -> object:
    return resolve_predicate(parse(text), SCOPE)


def _action(text: str) -> object:
    return resolve_assignments(parse_assignment(text), SCOPE)


@pytest.mark.parametrize(
    ("read", "example", "message"),
    [
        (
            _condition,
            "all q in ‹pairs›: bolts[q] == tight",
            "there is no set `pairs`: `in` needs values in braces, an enumeration or a named set; did you mean `pair`?",
        ),
        (
            _condition,
            "at in ‹home›",
            "there is no set `home`: `in` needs values in braces, an enumeration or a named set; "
            "write {home} for a single value",
        ),
        (_condition, "all q in pair: bolts[q] == ‹tigt›", "unknown variable or value `tigt`; did you mean `tight`?"),
        (_condition, "all ‹at› in pair: true", "`at` hides the variable `at`: take another word"),
        (_condition, "all ‹p1› in pair: true", "`p1` hides the value `p1`: take another word"),
        (
            _condition,
            "all q in pair: any ‹q› in pair: true",
            "`q` stands for something else here already: take another word",
        ),
        (_condition, "all q in {p1, ‹p7›}: true", "`p7` is no value; did you mean `p3`?"),
        (
            _condition,
            "any q in pair: bolts[q] == tight ‹where› q < p3",
            f"expected an operator or the end, found `where`; {BEFORE}",
        ),
        (_condition, "any q in pair: where ‹q› < p3: n == 1", f"expected an operator or the end, found `q`; {BEFORE}"),
        (_condition, "any q in pair ‹bolts›[q] == tight", "expected `:` or `where`, found `bolts`"),
        (
            _condition,
            "all q in pair: n == 1 ‹==› true",
            "expected an operator or the end, found `==`; comparisons do not chain: join two with and",
        ),
        (_condition, "‹for› all q in pair: true", "`for` has no meaning here; write all …: …"),
        (_condition, "‹exists› q in pair: true", "`exists` has no meaning here; write any"),
        (_condition, "‹count q in pair: bolts[q] == tight›", "expected a truth value, found an integer in 0..3"),
        (
            _condition,
            "‹all q in pair, r in pair, s in pair, t in pair, u in pair, v in pair, w in pair, x in pair: true›",
            f"this stands for more than {MOST_CASES} cases: split it up",
        ),
        (_condition, "‹is_at›", "`is_at` has 1 argument (p), found 0"),
        (_condition, "‹is_at(home, a)›", "`is_at` has 1 argument (p), found 2"),
        (_condition, "‹all_tight(home)›", "`all_tight` has no argument, found 1"),
        (_condition, "is_at(‹tool›)", "cannot compare one of {home, a, b} with one of {none, big, small}"),
        (_condition, "is_at(‹hom›)", "unknown variable or value `hom`; did you mean `home`?"),
        (_condition, "is_at(‹p1›)", "`is_at` is about one of {home, a, b}, and `p1` is none of them"),
        (
            _condition,
            "is_at(‹free›)",
            "`free` is a set, and one value stands here: write `all f in free: is_at(f)`",
        ),
        (_condition, "near(home, ‹unknwon›)", "unknown variable or value `unknwon`; did you mean `unknown`?"),
        (_condition, "n == 1 and near(at, ‹tool›)", CANNOT_POSE),
        (_condition, "near(at, next(‹tool›))", NO_ORDER.format("tool", "{none, big, small}")),
        (
            _condition,
            "tool_for[‹p2›] == big",
            "`tool_for` is about one of {unknown, home, a, b}, and `p2` is none of them",
        ),
        (_condition, "‹tool_for(at)› == big", "`tool_for` is a map: write `tool_for[at]`"),
        (_condition, "‹tool_for(at, big)›", "`tool_for` is a map: write `tool_for[at] == big`"),
        (_condition, "‹tool_for› == big", "`tool_for` is a map: write `tool_for[…]`"),
        (_condition, "‹near[home]› == a", "`near` is a relation between two values: write `near(home, …)`"),
        (_condition, "‹near[home, a]›", "`near` is a relation between two values: write `near(home, a)`"),
        (_condition, "‹near›", "`near` is a relation between two values: write `near(…, …)`"),
        (_condition, "‹is_at[home]›", "`is_at` is a predicate: write `is_at(home)`"),
        (_condition, "‹at least 4 q in pair: bolts[q] == tight›", f"there are 3 values of `pair`, {NEVER}"),
        (_condition, "n == 1 and ‹exactly 4 q in pair: bolts[q] == tight›", f"there are 3 values of `pair`, {NEVER}"),
        (_condition, "‹exactly 3 q in {p1, p3}: bolts[q] == tight›", f"there are 2 values of these, {NEVER}"),
        (_condition, "‹exactly 2 q in {p1}: bolts[q] == tight›", f"there is 1 value of these, {NEVER}"),
        (_condition, "‹at least 7 q in pair, r in {p1, p3}: n == 1›", f"there are 6 choices of values, {NEVER}"),
        (
            _condition,
            "all r in pair: ‹at least 4 q in pair where q < r: n == 1›",
            f"there are 3 values of `pair`, {NEVER}",
        ),
        (_condition, "‹near(at)›", "`near` has 2 arguments, found 1"),
        (
            _condition,
            "previous(‹at›) == home",
            "`at` is one of {unknown, home, a, b}, which has no order: declare its enumeration with `ordered: true`",
        ),
        (
            _condition,
            "first(‹tool›) == none",
            "`tool` is one of {none, big, small}, which has no order: declare its enumeration with `ordered: true`",
        ),
        (
            _condition,
            "‹at < home›",
            "`<` compares integers, not one of {unknown, home, a, b}, unless their enumeration is `ordered: true`",
        ),
        (_condition, "‹broken›", "`broken` means nothing: unknown variable `bolts[p9]`; did you mean `bolts[p3]`?"),
        (_condition, "‹chicken›", "predicates need each other in a circle: chicken → egg → chicken"),
        (_action, "‹all_tight› := true", "`all_tight` is a predicate, and only variables are written"),
        (
            _action,
            "‹bolts[chosen]› := tight",
            "which variable `bolts[chosen]` is depends on the state: write `all word in set where …: …`",
        ),
        (
            _action,
            "tool := ‹tool_for[at]›",
            "`tool_for[at]` depends on the state: give the ability a parameter for the case, and let its condition say "
            "which case it is",
        ),
    ],
)
def test_slips(read: Callable[[str], object], example: str, message: str) -> None:
    assert_refused(read, example, message)
