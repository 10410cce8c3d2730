"""Recursive descent from words to the tree, loosest binding first.

expression = disjunction ["implies" expression]
disjunction = conjunction {"or" conjunction}
conjunction = until {"and" until}
until = negation [("U" | "R" | "W") until]                                       (in formulas only)
negation = ("not" | "X" | "N" | "F" | "G") negation | relation                   (the letters in formulas only)
relation = sum [("==" | "!=" | "<" | "<=" | ">" | ">=") sum | "in" ("{" sum {"," sum} "}" | word)]
sum = product {("+" | "-") product}
product = atom {("*" | "/") atom}                                                (`*` and `/` over records only)
atom = "true" | "false" | ["-"] number | name | quantified | "(" expression ")"
     | path | text | "-" atom                                                    (over records only, `path` for `name`)
quantified = quantifier bound ":" expression                                     (not over records)
quantifier = "all" | "any" | "none" | "count" | "exactly" number | "at" ("least" | "most") number
bound = binder {"," binder} ["where" expression];  binder = word {"," word} "in" (word | "{" word {"," word} "}")
name = part {"." part};  part = word ["(" name {"," name} ")" | "[" name {"," name} "]"]
path = word {"." word | "[" sum {"," sum} "]"}
assignment = ["all" bound ":"] name ":=" expression ["if" expression]

The words of quantifiers are names everywhere else, such as in `task == none`: a quantifier is followed by a word or a
number. What it is about goes on as far to the right as it can.

In a formula `U`, `R` and `W` are operators where an operator may stand, that is, after a complete negation. `X`, `N`,
`F` and `G` are operators where a negation begins and what follows can begin an operand: a word, a number, `(`, `not`,
`true` or `false`. Everywhere else the letters are names, such as in `philosopher == R`, `N == 3`, `X and y`, `(X) U y`
or `F(x).done`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, NoReturn, TypeVar

from sequence_planner.language.lexer import (
    COLON,
    GUARDS,
    INFIX_LETTERS,
    KEYWORDS,
    PREFIX_LETTERS,
    RECORDS,
    Dialect,
    Token,
    tokens,
)
from sequence_planner.language.syntax import (
    And,
    ArgumentWord,
    Arithmetic,
    Assignment,
    BinaryTemporal,
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
    RecordConstant,
    Selection,
    Span,
    UnaryTemporal,
    first_temporal,
)
from sequence_planner.texts.late import message

if TYPE_CHECKING:
    from sequence_planner.texts.message import Message

T = TypeVar("T")

# What reads a tree descends into it: deeper ones than any person writes would exhaust the stack.
MOST_NESTED = 30
MOST_OPERATIONS = 50

_RELATIONS = frozenset({"==", "!=", "<", "<=", ">", ">="})
_PRODUCTS = frozenset({"*", "/"})
_OPERATORS = _PRODUCTS | {"+", "-"}
_OPERAND_BEGINS = frozenset({"name", "number", "text", "(", "not", "true", "false"})

QUANTIFIERS = frozenset({"all", "any", "none", "count"})

# What is expected somewhere, where it is no sign.
WANTED: Mapping[str, Callable[[], Message]] = {
    "name": lambda: message("token.name"),
    "number": lambda: message("token.number"),
    "field": lambda: message("token.field"),
    "end": lambda: message("token.end"),
    "each value": lambda: message("token.each-value"),
    "name or value": lambda: message("token.name-or-value"),
    "field or value": lambda: message("token.field-or-value"),
    "value or parameter": lambda: message("token.value-or-parameter"),
    "a named set": lambda: message("token.named-set"),
    "an enumeration or a named set": lambda: message("token.set"),
    "the name of a set": lambda: message("token.set-name"),
    "a value": lambda: message("token.value"),
    "in": lambda: message("token.as-in", sign="in", example="all p in poses: …"),
    "{": lambda: message("token.as-in", sign="{", example="pose in {home, above}"),
    ": or where": lambda: message("list.or", most="`:`", last="`where`"),
    ", or )": lambda: message("list.or", most="`,`", last="`)`"),
    ", or ]": lambda: message("list.or", most="`,`", last="`]`"),
    ", or }": lambda: message("list.or", most="`,`", last="`}`"),
}

# Quantifiers of other languages.
_FOREIGN_QUANTIFIERS = {
    "forall": "all",
    "every": "all",
    "each": "all",
    "exists": "any",
    "some": "any",
    "no": "none",
    "one": "exactly 1",
    "sum": "count",
    "number": "count",
}

# Words of other languages, where an operator or an operand is missing.
_FOREIGN = {word: word for word in KEYWORDS} | {"is": "==", "equals": "==", "xor": "!=", "then": "implies"}
_LETTERS = {
    "until": "U",
    "releases": "R",
    "next": "X",
    "eventually": "F",
    "finally": "F",
    "always": "G",
    "globally": "G",
}


def parse(text: str) -> Expression:
    """The tree of one predicate. Raises `ExpressionError` with the place of the first word that does not fit."""
    return _predicate(str(text))


def parse_assignment(text: str) -> Assignment:
    """The tree of one action such as `bolts := tightened if pose == home`. Raises `ExpressionError`."""
    return _assignment(str(text))


def parse_formula(text: str) -> Expression:
    """The tree of one formula of LTL over finite traces, such as `not bad U good`. Raises `ExpressionError`."""
    return _Parser(text, temporal=True).whole(_Parser.expression)


def parse_calculation(text: str) -> Expression:
    """The tree of one expression over records, such as `joints[0] * 2 > force`. Raises `ExpressionError`."""
    return _Parser(str(text), dialect=RECORDS).whole(_Parser.expression)


def can_go_on(text: str, action: bool = False, temporal: bool = False) -> bool:
    """Return whether a predicate, an `action` or a `temporal` formula can begin with `text`, or be it."""
    try:
        _Parser(text, temporal).whole(_Parser.assignment if action else _Parser.expression)
    except ExpressionError as error:
        return error.span.start >= len(text.rstrip())
    return True


# An ability's texts are read once for all of its instances.


@lru_cache(4096)
def _predicate(text: str) -> Expression:
    return _ordinary(text, _Parser.expression)


@lru_cache(4096)
def _assignment(text: str) -> Assignment:
    return _ordinary(text, _Parser.assignment)


def _ordinary(text: str, rule: Callable[[_Parser], T]) -> T:
    """`text` read without temporal operators; if it makes sense only with them, that is what the error says."""
    try:
        return _Parser(text).whole(rule)
    except ExpressionError as error:
        raise _misplaced_temporal(text, rule) or error from None


def _misplaced_temporal(text: str, rule: Callable[[_Parser], T]) -> ExpressionError | None:
    try:
        tree = _Parser(text, temporal=True).whole(rule)
    except ExpressionError:
        return None
    parts = (tree.value, tree.condition) if isinstance(tree, Assignment) else (tree,)
    for part in parts:
        if isinstance(part, Expression) and (formula := first_temporal(part)) is not None:
            return temporal_refused(formula.operator, formula.span)
    return None


def temporal_refused(operator: str, span: Span) -> ExpressionError:
    """The complaint about a temporal operator in an ordinary predicate or an action."""
    return ExpressionError(message("wrong.temporal", operator=operator), span)


def _wanted(what: str) -> str:
    """What is expected, as people are told of it."""
    return WANTED[what]() if what in WANTED else what


class _Parser:
    def __init__(self, text: str, temporal: bool = False, dialect: Dialect = GUARDS) -> None:
        self._tokens = tokens(text, dialect)
        self._next = 0
        self._token = self._tokens[0]
        self._temporal = temporal
        self._over_records = dialect is RECORDS
        self._depth = 0
        self._operations = 0

    def whole(self, rule: Callable[[_Parser], T]) -> T:
        result = rule(self)
        if self._token.kind != "end":
            self._no_operator("end")
        return result

    # Words

    def _advance(self) -> Token:
        token = self._token
        self._next += 1
        self._token = self._tokens[self._next]
        return token

    def _expect(self, kind: str, what: str) -> Token:
        if self._token.kind != kind:
            self._unfit(what)
        return self._advance()

    def _since(self, start: int) -> Span:
        return Span(start, self._tokens[self._next - 1].end)

    def _deeper(self, opening: Token) -> None:
        self._depth += 1
        if self._depth > MOST_NESTED:
            raise ExpressionError(message("wrong.nested", most=MOST_NESTED), opening.span)

    def _nested(self, rule: Callable[[], Expression], opening: Token) -> Expression:
        self._deeper(opening)
        result = rule()
        self._depth -= 1
        return result

    # What does not fit

    def _unfit(self, what: str) -> NoReturn:
        token = self._token
        hint = ""
        if token.kind == "if":
            hint = message("hint.if-in-actions")
        elif token.kind in KEYWORDS and what == "name":
            hint = message("hint.word-of-language", word=token.text)
        raise ExpressionError(
            message("wrong.expected", wanted=_wanted(what), found=token.as_found, hint=hint), token.span
        )

    def _no_operator(self, end: str) -> NoReturn:
        """Something else than an operator, or what ends the expression, stands behind an expression."""
        token, after = self._token, self._tokens[self._next + 1 :]
        last = self._tokens[self._next - 1]
        for word in (token, last) if token.kind in _OPERAND_BEGINS else ():
            meant = _FOREIGN.get(word.text.lower()) or (self._temporal and _LETTERS.get(word.text.lower()))
            if word.kind == "name" and meant:
                raise ExpressionError(message("wrong.foreign", word=word.text, meant=meant), word.span)
        if token.kind == ":":
            raise ExpressionError(COLON, token.span)
        if last.text.lower() == "for" and token.text in QUANTIFIERS:
            raise ExpressionError(message("wrong.foreign", word=last.text, meant=f"{token.text} …: …"), last.span)
        if token.kind == "name" and after[0].kind == "in" and last.text.lower() in _FOREIGN_QUANTIFIERS:
            meant = _FOREIGN_QUANTIFIERS[last.text.lower()]
            raise ExpressionError(message("wrong.foreign", word=last.text, meant=meant), last.span)
        hint = ""
        if "where" in (token.text, last.text):
            hint = message("hint.where-before-colon")
        elif last.text in QUANTIFIERS and token.kind == "name":
            hint = message("hint.quantifier", word=last.text)
        elif token.kind in _RELATIONS or token.kind == "in":
            hint = message("hint.no-chain")
        elif token.kind == ":=":
            hint = message("hint.compares")
        elif token.kind == "if":
            hint = message("hint.if-once")
        elif token.kind == "not" and after[0].kind == "in":
            hint = message("hint.write", what="not x in {...}")
        elif token.kind == "." and last.kind == "number" and not self._over_records:
            hint = message("hint.integers")
        elif self._temporal and last.text in INFIX_LETTERS and self._tokens[self._next - 2].text in PREFIX_LETTERS:
            name = self._tokens[self._next - 2].text
            hint = message("hint.if-a-name", name=name, what=f"({name}) {last.text} {token.text}")
        raise ExpressionError(
            message("wrong.expected-operator", end=_wanted(end), found=token.as_found, hint=hint), token.span
        )

    # Rules

    def assignment(self) -> Assignment:
        start = self._token.start
        binders: tuple[Binder, ...] = ()
        where: Expression | None = None
        if self._token.text == "all" and self._begins_quantifier():
            self._advance()
            binders, where = self._bound()
        target = self.name()
        self._expect(":=", "`:=`")
        value = self.expression()
        condition = None
        if self._token.kind == "if":
            self._advance()
            condition = self.expression()
        if where is not None:
            condition = where if condition is None else And((where, condition), where.span)
        return Assignment(target, value, condition, self._since(start), binders)

    def expression(self) -> Expression:
        start = self._token.start
        left = self.disjunction()
        if self._token.kind == "implies":
            return Implies(left, self._nested(self.expression, self._advance()), self._since(start))
        return left

    def disjunction(self) -> Expression:
        start = self._token.start
        first = self.conjunction()
        if self._token.kind != "or":
            return first
        parts = [first]
        while self._token.kind == "or":
            self._advance()
            parts.append(self.conjunction())
        return Or(tuple(parts), self._since(start))

    def conjunction(self) -> Expression:
        start = self._token.start
        operand = self.until if self._temporal else self.negation
        first = operand()
        if self._token.kind != "and":
            return first
        parts = [first]
        while self._token.kind == "and":
            self._advance()
            parts.append(operand())
        return And(tuple(parts), self._since(start))

    def until(self) -> Expression:
        start = self._token.start
        left = self.negation()
        if self._token.kind == "name" and self._token.text in INFIX_LETTERS:
            letter = self._advance()
            return BinaryTemporal(letter.text, left, self._nested(self.until, letter), self._since(start))
        return left

    def negation(self) -> Expression:
        token = self._token
        if token.kind == "not":
            return Not(self._nested(self.negation, self._advance()), self._since(token.start))
        if self._temporal and token.text in PREFIX_LETTERS and self._is_prefix():
            letter = self._advance()
            # Brackets right behind a letter count in its place: canonical text has them, where its tree is no deeper.
            operand = self.negation() if self._token.kind == "(" else self._nested(self.negation, letter)
            return UnaryTemporal(token.text, operand, self._since(token.start))
        return self.relation()

    def _is_prefix(self) -> bool:
        """Return whether the letter at hand is an operator: an operand follows, and not the arguments of
        `F(x).done`.
        """
        following = iter(self._tokens[self._next + 1 :])
        first = next(following)
        if first.kind != "(":
            return first.kind in _OPERAND_BEGINS
        closing = next(token.kind for token in following if token.kind not in {"name", ","})
        return closing != ")" or next(following).kind != "."

    def relation(self) -> Expression:
        start = self._token.start
        left = self.sum()
        kind = self._token.kind
        if kind in _RELATIONS:
            self._advance()
            return Comparison(kind, left, self.sum(), self._since(start))
        if kind == "in":
            self._advance()
            if self._token.kind == "name" and not self._over_records:
                return NamedMembership(left, self._domain("a named set"), self._since(start))
            return Membership(left, self._options(), self._since(start))
        return left

    def _options(self) -> tuple[Expression, ...]:
        self._expect("{", "{")
        options = self._sums()
        self._expect("}", ", or }")
        return options

    def _sums(self) -> tuple[Expression, ...]:
        sums = [self.sum()]
        while self._token.kind == ",":
            self._advance()
            sums.append(self.sum())
        return tuple(sums)

    def sum(self) -> Expression:
        start = self._token.start
        left = self.atom()
        return self._arithmetic(left, start, _OPERATORS) if self._token.kind in _OPERATORS else left

    def _arithmetic(self, left: Expression, start: int, operators: frozenset[str]) -> Expression:
        """`left` with the operations behind it, of which products bind tighter."""
        while self._token.kind in operators:
            operator = self._advance()
            self._operations += 1
            if self._operations > MOST_OPERATIONS:
                raise ExpressionError(message("wrong.operations", most=MOST_OPERATIONS), operator.span)
            begin = self._token.start
            right = self.atom()
            if operator.kind not in _PRODUCTS:
                right = self._arithmetic(right, begin, _PRODUCTS)
            left = Arithmetic(operator.text, left, right, self._since(start))
        return left

    def atom(self) -> Expression:
        token = self._token
        kind = token.kind
        if kind == "name":
            if self._over_records:
                return self.path()
            return self.quantified() if self._begins_quantifier() else self.name()
        if kind in ("true", "false"):
            return Constant(kind == "true", self._advance().span)
        if kind == "number":
            return self._number(1, token.start)
        if kind == "-":
            return self._negative(self._advance())
        if kind == "text":
            return RecordConstant(self._advance().text[1:-1].replace("''", "'"), token.span)
        if kind != "(":
            self._unfit("field or value" if self._over_records else "name or value")
        inner = self._nested(self.expression, self._advance())
        if self._token.kind != ")":
            self._no_operator("`)`")
        self._advance()
        return inner

    def _begins_quantifier(self) -> bool:
        """Return whether the word at hand is a quantifier, and no name."""
        word = self._token.text
        following = self._tokens[self._next + 1]
        if word == "exactly":
            return following.kind == "number"
        if word == "at":
            return following.text in ("least", "most")
        if word not in QUANTIFIERS or following.kind != "name":
            return False
        behind = self._tokens[self._next + 2].kind
        # `none` is a usual name of a value, behind which an operator may be missing.
        return behind in ("in", ",") or (behind == "end" and word != "none")

    def quantified(self) -> Expression:
        opening = self._advance()
        quantifier, number = opening.text, None
        if quantifier == "at":
            quantifier = f"at {self._advance().text}"
        if quantifier not in QUANTIFIERS:
            number = int(self._expect("number", "number").text)
        binders, where = self._bound()
        body = self._nested(self.expression, opening)
        if self._token.kind in _RELATIONS or self._token.kind == "in":
            self._no_operator("end")  # the body goes on as far as it can: this would compare it once more
        return Quantified(quantifier, number, binders, where, body, self._since(opening.start))

    def _bound(self) -> tuple[tuple[Binder, ...], Expression | None]:
        """Return what a quantifier is about: its words with their values, and what chooses among these."""
        binders: list[Binder] = []
        while not binders or self._token.kind == ",":
            if binders:
                self._advance()
            words = [self._expect("name", "each value")]
            while self._token.kind == ",":
                self._advance()
                words.append(self._expect("name", "name"))
            self._expect("in", "in")
            domain = self._domain("an enumeration or a named set") if self._token.kind != "{" else self._values()
            binders += [Binder(word.text, domain, word.span) for word in words]
        where = None
        if self._token.text == "where":
            where = self._nested(self.expression, self._advance())
        self._expect(":", "`:`" if where is not None else ": or where")
        return tuple(binders), where

    def _values(self) -> tuple[Name, ...]:
        self._expect("{", "`{`")
        values = [self._word("a value")]
        while self._token.kind == ",":
            self._advance()
            values.append(self._word("a value"))
        self._expect("}", ", or }")
        return tuple(values)

    def _word(self, what: str) -> Name:
        token = self._expect("name", what)
        return Name((Component(token.text),), token.span)

    def _domain(self, what: str) -> Name:
        """An enumeration or a set; one that belongs to a resource has the name of that before it."""
        start = self._token.start
        parts = [Component(self._expect("name", what).text)]
        while self._token.kind == ".":
            self._advance()
            parts.append(Component(self._expect("name", "the name of a set").text))
        return Name(tuple(parts), self._since(start))

    def _negative(self, sign: Token) -> Expression:
        if not self._over_records or self._token.kind == "number":
            return self._number(-1, sign.start)
        nothing = Constant(0, Span(sign.start, sign.start))
        return Arithmetic("-", nothing, self._nested(self.atom, sign), self._since(sign.start))

    def _number(self, sign: int, start: int) -> Expression:
        token = self._expect("number", "number")
        if token.text.isdigit():
            return Constant(sign * int(token.text), self._since(start))
        real = sign * float(token.text)
        if not math.isfinite(real):
            raise ExpressionError(message("wrong.large-number"), token.span)
        return RecordConstant(real, self._since(start))

    def path(self) -> Expression:
        start, depth = self._token.start, self._depth
        path: Expression = Name((Component(self._advance().text),), self._since(start))
        while self._token.kind in (".", "[", "("):
            self._deeper(opening := self._advance())
            at: str | tuple[Expression, ...]
            if opening.kind == ".":
                at = self._expect("name", "field").text
            else:
                at = self._sums()
                closing = "]" if opening.kind == "[" else ")"
                self._expect(closing, f"`{closing}`")
            path = Selection(path, at, self._since(start), opening.kind == "(")
        self._depth = depth
        return path

    def name(self) -> Name:
        start = self._token.start
        parts = [self.component()]
        while self._token.kind == ".":
            self._advance()
            parts.append(self.component())
        return Name(tuple(parts), self._since(start))

    def component(self) -> Component:
        word = self._expect("name", "name").text
        opening = self._token.kind
        if opening not in ("(", "["):
            return Component(word)
        closing = ")" if opening == "(" else "]"
        arguments: list[str | Name] = []
        while not arguments or self._token.kind == ",":
            self._advance()
            arguments.append(self._argument())
        self._expect(closing, f", or {closing}")
        return Component(word, tuple(arguments), opening == "[")

    def _argument(self) -> str | Name:
        if self._token.kind != "name":
            self._unfit("value or parameter")
        if self._tokens[self._next + 1].kind in (",", ")", "]"):
            word = self._advance()
            return ArgumentWord(word.text, word.span)
        self._depth += 1
        if self._depth > MOST_NESTED:
            raise ExpressionError(message("wrong.nested", most=MOST_NESTED), self._token.span)
        name = self.name()
        self._depth -= 1
        return name
