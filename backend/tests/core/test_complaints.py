"""What pydantic finds wrong is told without its own words for who has found it."""

from __future__ import annotations

from typing import Annotated

import pytest
from pydantic import AfterValidator, BaseModel, ValidationError

from sequence_planner.complaints import complained, in_a_line


def _even(value: int) -> int:
    if value % 2:
        raise ValueError("this has to be even, as 2 is")
    if not value:
        raise AssertionError("this has to be something, as 2 is")
    return value


class Counted(BaseModel):
    number: Annotated[int, AfterValidator(_even)]


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (3, "this has to be even, as 2 is"),
        (0, "this has to be something, as 2 is"),
        ("x", "Input should be a valid integer, unable to parse string as an integer"),
    ],
)
def test_what_a_validator_says_is_told_as_it_says_it(value: object, told: str) -> None:
    with pytest.raises(ValidationError) as error:
        Counted.model_validate({"number": value})
    (details,) = error.value.errors()
    assert complained(details) == told
    assert in_a_line(error.value) == f"number: {told}"
