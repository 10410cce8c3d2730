"""What an engineer is told who writes something wrongly: one row for each kind of slip, with the place marked."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from sequence_planner.language import parser
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment, parse_formula
from sequence_planner.language.resolver import resolve_assignment, resolve_formula, resolve_predicate
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange

from .marking import assert_refused

BOLT = EnumerationType(("empty", "placed"))
SCOPE = NameScope(
    {
        "robot.pose": EnumerationType(("unknown", "home", "above")),
        "robot.target": EnumerationType(("home", "above")),
        "robot.moving": BOOLEAN,
        "robot.move_to_position(home).executing": BOOLEAN,
        "robot.move_to_position(above).executing": BOOLEAN,
        "nutrunner.tool_is_idle": BOOLEAN,
        "nutrunner.run_nut.enabled": BOOLEAN,
        "nutrunner.run_nut.executing": BOOLEAN,
        "bolts[left]": BOLT,
        "bolts[right]": BOLT,
        "ready": BOOLEAN,
        "count": IntegerRange(0, 3),
    },
    ("robot.",),
)
TEMPORAL = (
    "is a temporal operator here: temporal operators stand only in `local` formulas of operations and in goals of "
    "plain automata"
)
NO_CHAIN = "comparisons do not chain: join two with and"


@pytest.mark.parametrize(
    ("example", "message"),
    [
        # Operators of other languages
        ("ready ‹&&› moving", "`&&` has no meaning here; write and"),
        ("ready ‹||› moving", "`||` has no meaning here; write or"),
        ("‹!›moving", "`!` has no meaning here; write not"),
        ("‹~›moving", "`~` has no meaning here; write not"),
        ("ready ‹->› moving", "`->` has no meaning here; write implies"),
        ("ready ‹=>› moving", "`=>` has no meaning here; write implies (or >= between integers)"),
        ("ready ‹<=>› moving", "`<=>` has no meaning here; write =="),
        ("pose ‹=› home", "`=` has no meaning here; write == (or := in an action)"),
        ("pose ‹===› home", "`===` has no meaning here; write =="),
        ("pose ‹<>› home", "`<>` has no meaning here; write !="),
        ("pose ‹!==› home", "`!==` has no meaning here; write !="),
        ("count ‹=<› 2", "`=<` has no meaning here; write <="),
        ("count ‹*› 2 == 2", "`*` has no meaning here; write a sum with + and -"),
        ("pose‹:› home", "`:` has no meaning here; write := in an action, == in a condition"),
        ("pose == ‹'›home'", "`'` has no meaning here; write values without quotes"),
        ('pose == ‹"›home"', '`"` has no meaning here; write values without quotes'),
        ("count == 1‹.›5", "expected an operator or the end, found `.`; numbers are integers"),
        # Words of other languages
        ("ready ‹AND› moving", "`AND` has no meaning here; write and"),
        ("‹NOT› ready", "`NOT` has no meaning here; write not"),
        ("(ready ‹Or› moving)", "`Or` has no meaning here; write or"),
        ("pose ‹is› home", "`is` has no meaning here; write =="),
        ("ready ‹xor› moving", "`xor` has no meaning here; write !="),
        ("‹TRUE›", "unknown variable `TRUE`; write true"),
        ("pose == ‹False›", "unknown variable or value `False`; write false"),
        (
            "‹if› ready then moving",
            "expected a name, a value or `(`, found `if`; `if` stands only in actions, a condition says a implies b",
        ),
        # Brackets and order
        ("(ready or moving‹›", "expected an operator or `)`, found the end of the text"),
        ("ready or moving‹)›", "expected an operator or the end, found `)`"),
        ("pose in {home, above‹›", "expected `,` or `}`, found the end of the text"),
        ("pose in ‹[›home, above]", "expected `{`, as in `pose in {home, above}`, found `[`"),
        ("pose ‹not› in {home}", "expected an operator or the end, found `not`; write not x in {...}"),
        ("bolts[left ‹==› placed", "expected `,` or `]`, found `==`"),
        ("‹in› == 3", "expected a name, a value or `(`, found `in`"),
        ("robot.‹not›", "expected a name, found `not`; `not` is a word of the language"),
        ("1 < count ‹<› 3", f"expected an operator or the end, found `<`; {NO_CHAIN}"),
        ("pose == target ‹==› home", f"expected an operator or the end, found `==`; {NO_CHAIN}"),
        ("ready ‹if› moving", "expected an operator or the end, found `if`; `if` stands once, at the end of an action"),
        ("pose ‹:=› home", "expected an operator or the end, found `:=`; a condition compares with =="),
        # Types and domains
        ("count == ‹7›", "cannot compare an integer in 0..3 with the integer 7"),
        ("ready == ‹pose›", "cannot compare a truth value with one of {unknown, home, above}"),
        ("ready == ‹1›", "cannot compare a truth value with the integer 1; write true"),
        ("‹count› and ready", "expected a truth value, found an integer in 0..3"),
        ("‹pose›", "expected a truth value, found one of {unknown, home, above}"),
        (
            "‹pose < above›",
            "`<` compares integers, not one of {unknown, home, above}, unless their enumeration is `ordered: true`",
        ),
        ("count + ‹ready› == 2", "`+` needs integers, found a truth value"),
        # Names
        ("pose == ‹hoem›", "unknown variable or value `hoem`; did you mean `home`?"),
        ("pose == ‹robot.home›", "unknown variable or value `robot.home`; did you mean `home`?"),
        ("‹home›", "unknown variable `home`; a value stands beside its variable, as in `pose == home`"),
        (
            "not ‹placed›",
            "unknown variable `placed`; a value stands beside its variable, as in `bolts[left] == placed`",
        ),
        ("‹Ready›", "unknown variable `Ready`; did you mean `ready`?"),
        ("‹nutruner.tool_is_idle›", "unknown variable `nutruner.tool_is_idle`; did you mean `nutrunner.tool_is_idle`?"),
        ("‹tool_is_idle›", "unknown variable `tool_is_idle`; did you mean `nutrunner.tool_is_idle`?"),
        (
            "‹nutrunner.run_nut.executng›",
            "unknown variable `nutrunner.run_nut.executng`; did you mean `nutrunner.run_nut.executing`?",
        ),
        (
            "‹nutrunner.run_nut›",
            "unknown variable `nutrunner.run_nut`; write nutrunner.run_nut.enabled or nutrunner.run_nut.executing",
        ),
        (
            "‹move_to_position(hom).executing›",
            "unknown variable `move_to_position(hom).executing`; did you mean `move_to_position(home).executing`?",
        ),
        (
            "‹move_to_position.executing›",
            "unknown variable `move_to_position.executing`; did you mean `move_to_position(…).executing`, as in "
            "`move_to_position(home).executing`?",
        ),
        ("‹bolts(left)› == placed", "unknown variable `bolts(left)`; did you mean `bolts[left]`?"),
        # Formulas out of place
        ("ready and ‹F moving›", f"`F` {TEMPORAL}"),
        ("‹not moving U (pose == home)›", f"`U` {TEMPORAL}"),
    ],
)
def test_slips_in_a_condition(example: str, message: str) -> None:
    assert_refused(lambda text: resolve_predicate(parse(text), SCOPE), example, message)


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ("pose ‹=› home", "`=` has no meaning here; write == (or := in an action)"),
        ("pose ‹==› home", "expected `:=`, found `==`"),
        ("count ‹+=› 1", "`+=` has no meaning here; write n := n + 1"),
        ("count‹++›", "`++` has no meaning here; write n := n + 1"),
        ("‹true› := ready", "expected a name, found `true`; `true` is a word of the language"),
        ("‹psoe› := home", "unknown variable `psoe`; did you mean `pose`?"),
        ("pose := ‹hoem›", "unknown variable or value `hoem`; did you mean `home`?"),
        (
            "target := ‹unknown›",
            "unknown variable or value `unknown`; write one of home, above",
        ),
        ("count := ‹7›", "expected an integer in 0..3, found the integer 7"),
        ("count := ‹count + 9›", "expected an integer in 0..3, found an integer in 9..12"),
        ("ready := ‹0›", "expected a truth value, found the integer 0; write false"),
        ("ready := not ‹pose›", "expected a truth value, found one of {unknown, home, above}"),
        ("bolts[left] := ‹pose›", "expected one of {empty, placed}, found one of {unknown, home, above}"),
        ("ready := ‹G moving›", f"`G` {TEMPORAL}"),
    ],
)
def test_slips_in_an_action(example: str, message: str) -> None:
    assert_refused(lambda text: resolve_assignment(parse_assignment(text), SCOPE), example, message)


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ("moving ‹until› ready", "`until` has no meaning here; write U"),
        ("‹always› ready", "`always` has no meaning here; write G"),
        ("G (‹eventually› ready)", "`eventually` has no meaning here; write F"),
        ("G (‹redy› or moving)", "unknown variable `redy`; did you mean `ready`?"),
        ("moving U ‹pose›", "expected a truth value, found one of {unknown, home, above}"),
    ],
)
def test_slips_in_a_formula(example: str, message: str) -> None:
    assert_refused(lambda text: resolve_formula(parse_formula(text), SCOPE), example, message)


def test_what_is_expected_is_said_in_every_language() -> None:
    """A sign stands in quotes; what is no sign is a text of the catalogue."""
    source = ast.parse(Path(parser.__file__).read_text(encoding="utf-8"))
    places = {"_expect": 1, "_unfit": 0, "_no_operator": 0, "_domain": 0, "_word": 0}
    wanted = {
        each.value
        for call in ast.walk(source)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr in places
        for what in [call.args[places[call.func.attr]]]
        for each in ([what.body, what.orelse] if isinstance(what, ast.IfExp) else [what])
        if isinstance(each, ast.Constant) and isinstance(each.value, str)
    }
    assert len(wanted) > 10
    assert {what for what in wanted if re.fullmatch("`[^a-z]+`", what) is None} <= parser.WANTED.keys()
