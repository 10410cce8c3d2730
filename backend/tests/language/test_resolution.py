"""Names become variables and values, types are checked, and what is wrong is said at its place."""

from __future__ import annotations

import pytest

from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse, parse_assignment
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.resolver import resolve_assignment, resolve_predicate
from sequence_planner.language.syntax import Constant, ExpressionError, occurrences
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange

from .marking import assert_refused

POSE = EnumerationType(("unknown", "home", "above"))
TARGET = EnumerationType(("home", "above", "gripping"))
SCOPE = NameScope(
    {
        "robot.pose": POSE,
        "robot.target": TARGET,
        "robot.moving": BOOLEAN,
        "robot.busy": BOOLEAN,
        "busy": BOOLEAN,
        "robot.move(home).executing": BOOLEAN,
        "robot.move(above).executing": BOOLEAN,
        "nutrunner.moving": BOOLEAN,
        "bolts[home]": EnumerationType(("empty", "placed")),
        "home": BOOLEAN,
        "gripping": EnumerationType(("open", "shut")),
        "count": IntegerRange(0, 3),
        "balance": IntegerRange(-2, 2),
    },
    ("robot.move(home).", "robot."),
    {"position": ("home", TARGET), "where": ("unknown", POSE)},
)


def resolved(text: str) -> str:
    return print_expression(resolve_predicate(parse(text), SCOPE))


def resolved_action(text: str) -> str:
    return print_assignment(resolve_assignment(parse_assignment(text), SCOPE))


@pytest.mark.parametrize(
    ("text", "means"),
    [
        ("moving", "robot.moving"),  # of the own resource first
        ("busy", "robot.busy"),  # and not the station's
        ("nutrunner.moving", "nutrunner.moving"),
        ("executing", "robot.move(home).executing"),  # of the own ability first
        ("move(above).executing", "robot.move(above).executing"),
        ("move(position).executing", "robot.move(home).executing"),
        ("bolts[position] == placed", "bolts[home] == placed"),
        ("home", "home"),  # a variable, where no value is meant
        ("target == position", "robot.target == home"),
        ("position == target", "home == robot.target"),
        ("pose == target", "robot.pose == robot.target"),
        ("target == where", "robot.target == unknown"),  # never, but its enumerations have values in common
        ("pose in {home, position, target}", "robot.pose in {home, home, robot.target}"),
        ("count + balance - 1 >= -3", "count + balance - 1 >= -3"),
        ("count == balance + 5", "count == balance + 5"),
        ("moving == not home", None),
        ("(moving and home) == true", "(robot.moving and home) == true"),
    ],
)
def test_names_and_values(text: str, means: str | None) -> None:
    if means is None:
        with pytest.raises(ExpressionError, match="expected a name, a value"):
            resolved(text)
    else:
        assert resolved(text) == means


def test_a_word_beside_an_enumeration_is_a_value_on_either_side() -> None:
    for text in ("pose == home", "home == pose"):
        comparison = resolve_predicate(parse(text), SCOPE)
        assert [variable.name for variable in occurrences(comparison)] == ["robot.pose"]
        assert Constant("home") in (getattr(comparison, "left", None), getattr(comparison, "right", None))


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ("‹poze› == home", "unknown variable `poze`; did you mean `pose`?"),
        ("above == ‹poze›", "unknown variable `poze`; did you mean `pose`?"),
        ("‹xyz› == qrs", "unknown variable `xyz`"),
        ("pose == ‹hom›", "unknown variable or value `hom`; did you mean `home`?"),
        ("pose in {home, ‹abov›}", "unknown variable or value `abov`; did you mean `above`?"),
        ("‹pos› in {home}", "unknown variable `pos`; did you mean `pose`?"),
        ("‹nutruner.moving›", "unknown variable `nutruner.moving`; did you mean `nutrunner.moving`?"),
        ("not ‹positon› and home", "unknown variable `positon`; did you mean `position`?"),
        ("‹bolts› == placed", "unknown variable `bolts`; did you mean `bolts[home]`?"),
        ("‹bolts(home)› == placed", "unknown variable `bolts(home)`; did you mean `bolts[home]`?"),
        ("‹bolts[where]› == placed", "unknown variable `bolts[where]`; did you mean `bolts[home]`?"),
        ("‹pose›", "expected a truth value, found one of {unknown, home, above}"),
        ("moving and ‹count›", "expected a truth value, found an integer in 0..3"),
        ("‹1›", "expected a truth value, found the integer 1; write true"),
        ("not ‹position›", "expected a truth value, found one of {home, above, gripping}"),
        ("count == ‹7›", "cannot compare an integer in 0..3 with the integer 7"),
        ("7 == ‹count›", "cannot compare the integer 7 with an integer in 0..3"),
        ("count < ‹balance + 6›", "cannot compare an integer in 0..3 with an integer in 4..8"),
        ("count in {1, ‹9›}", "cannot compare an integer in 0..3 with the integer 9"),
        ("count == ‹true›", "cannot compare an integer in 0..3 with a truth value"),
        ("moving == ‹count›", "cannot compare a truth value with an integer in 0..3"),
        ("pose == ‹gripping›", "cannot compare one of {unknown, home, above} with one of {open, shut}"),
        ("pose == ‹moving›", "cannot compare one of {unknown, home, above} with a truth value"),
        (
            "‹pose < above›",
            "`<` compares integers, not one of {unknown, home, above}, unless their enumeration is `ordered: true`",
        ),
        ("home or (‹moving >= home›)", "`>=` compares integers, not a truth value"),
        ("count + ‹moving› == 1", "`+` needs integers, found a truth value"),
        ("target == ‹gripping›", "`gripping` is both a value and a variable here: rename one of them"),
        ("‹gripping› == target", "`gripping` is both a value and a variable here: rename one of them"),
        ("target in {home, ‹gripping›}", "`gripping` is both a value and a variable here: rename one of them"),
    ],
)
def test_what_means_nothing(example: str, message: str) -> None:
    assert_refused(resolved, example, message)


@pytest.mark.parametrize(
    ("text", "means"),
    [
        ("target := position", "robot.target := home"),
        ("pose := target if target in {home, above}", "robot.pose := robot.target if robot.target in {home, above}"),
        ("target := pose", "robot.target := robot.pose"),  # whether that fits is not for the action alone to say
        ("count := count + 1 if count < 3", "count := count + 1 if count < 3"),
        ("count := balance", "count := balance"),
        ("count := 3 if balance > 0", "count := 3 if balance > 0"),
        ("balance := count - 2", "balance := count - 2"),
        ("moving := pose == home", "robot.moving := robot.pose == home"),
        ("bolts[position] := placed if pose == position", "bolts[home] := placed if robot.pose == home"),
    ],
)
def test_actions(text: str, means: str) -> None:
    assert resolved_action(text) == means


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ("‹pos› := home", "unknown variable `pos`; did you mean `pose`?"),
        ("‹position› := home", "`position` is a parameter: only variables are written"),
        ("pose := ‹hom›", "unknown variable or value `hom`; did you mean `home`?"),
        ("bolts[home] := ‹pose›", "expected one of {empty, placed}, found one of {unknown, home, above}"),
        ("target := ‹where›", "expected one of {home, above, gripping}, found one of {unknown, home, above}"),
        ("target := ‹gripping›", "`gripping` is both a value and a variable here: rename one of them"),
        ("count := ‹count + 4›", "expected an integer in 0..3, found an integer in 4..7"),
        ("count := ‹-1›", "expected an integer in 0..3, found the integer -1"),
        ("count := ‹balance - 3›", "expected an integer in 0..3, found an integer in -5..-1"),
        ("count := ‹moving›", "expected an integer in 0..3, found a truth value"),
        ("moving := ‹1›", "expected a truth value, found the integer 1; write true"),
        ("count := 1 if ‹count›", "expected a truth value, found an integer in 0..3"),
        ("count := 1 if ‹mving›", "unknown variable `mving`; did you mean `moving`?"),
    ],
)
def test_actions_that_mean_nothing(example: str, message: str) -> None:
    assert_refused(resolved_action, example, message)
