"""Reading a stage backwards by trying: which values of its fields give what is wanted."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import islice, product

from sequence_planner.expressions.types import IntegerRange
from sequence_planner.pipelines.record import FieldType, ListType, RealType, TextType
from sequence_planner.pipelines.stage import NotInvertibleError
from sequence_planner.pipelines.stages.values import domain, fits

MOST_TRIED = 5000


def candidates(type_: FieldType, mentioned: Iterable[object]) -> list[object]:
    """Values of a type worth trying: all of few; else those that are mentioned, and some about them."""
    known = [value for value in mentioned if value is not None]
    if (few := domain(type_)) is not None:
        return list(dict.fromkeys((*(value for value in known if fits(type_, value)), *few)))
    if isinstance(type_, TextType):
        texts = [value for value in known if isinstance(value, str)]
        return [*dict.fromkeys(texts), _other_text(texts)]
    if isinstance(type_, RealType | IntegerRange):
        numbers = [value for value in known if isinstance(value, int | float) and not isinstance(value, bool)]
        around = [number + step for number in numbers for step in (0, 1, -1)]
        return list(dict.fromkeys(value for value in (*numbers, 0, 1, *around) if fits(type_, value)))
    return [[]] if isinstance(type_, ListType) else []


def _other_text(texts: Sequence[str]) -> str:
    """A text that contains none of `texts`, and begins and ends as none of them."""
    tried = ("", "other", "-", "~")
    return next((text for text in tried if not any((known and known in text) or known == text for known in texts)), "·")


def put_at(record: dict[str, object], steps: Sequence[str | int], value: object) -> None:
    """Put `value` into a record under a path of names and indices, with all that must be around it."""
    within: dict[str, object] | list[object] = record
    for step, following in zip(steps, (*steps[1:], None), strict=True):
        inner: object = value
        if following is not None:
            inner = _at(within, step) or ([] if isinstance(following, int) else {})
        if isinstance(within, list) and isinstance(step, int):
            within.extend([None] * (step + 1 - len(within)))
            within[step] = inner
        elif isinstance(within, dict):
            within[str(step)] = inner
        if isinstance(inner, dict | list):
            within = inner


def _at(within: dict[str, object] | list[object], step: str | int) -> object:
    if isinstance(within, dict):
        return within.get(str(step))
    return within[step] if isinstance(step, int) and step < len(within) else None


def solve(
    tried: Mapping[str, Sequence[object]],
    agrees: Callable[[Mapping[str, object]], bool],
    values: dict[str, object],
    gives: Iterable[str],
    complaint: str,
) -> None:
    """Add to `values` the first combination of `tried` that agrees; fields that are in `values` already stay.

    Names in `gives` have there what the stage gives, and say nothing about a field of that name before it.
    Raises `NotInvertibleError` with `complaint` when there is no combination among the first five thousand.
    """
    known = {name: value for name, value in values.items() if value is not None and name not in gives}
    options = [[known[name]] if name in known else list(some) for name, some in tried.items()]
    for combination in islice(product(*options), MOST_TRIED):
        given = dict(zip(tried, combination, strict=True))
        if agrees(given):
            values |= given
            return
    raise NotInvertibleError(complaint)
