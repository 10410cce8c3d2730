"""Examples in which ‹ and › mark the place of an error."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sequence_planner.language.syntax import ExpressionError, Span


def unmarked(example: str) -> tuple[str, Span]:
    """The text of an example without its marks, and the span between them."""
    before, rest = example.split("‹")
    inside, after = rest.split("›")
    return before + inside + after, Span(len(before), len(before) + len(inside))


def assert_refused(read: Callable[[str], object], example: str, message: str) -> None:
    """`read` refuses the text of `example` with `message`, at its mark."""
    text, span = unmarked(example)
    with pytest.raises(ExpressionError) as caught:
        read(text)
    assert (caught.value.message, caught.value.span) == (message, span)
