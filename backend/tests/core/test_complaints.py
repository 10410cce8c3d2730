"""What pydantic finds wrong is told without its own words for who has found it."""

from __future__ import annotations

from typing import Annotated

import pytest
from pydantic import AfterValidator, BaseModel, Field, ValidationError

from sequence_planner.core.data_models import complained, in_a_line


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
        ("x", "expected an integer"),
    ],
)
def test_what_a_validator_says_is_told_as_it_says_it(value: object, told: str) -> None:
    with pytest.raises(ValidationError) as error:
        Counted.model_validate({"number": value})
    (details,) = error.value.errors()
    assert complained(details) == told
    assert in_a_line(error.value) == f"number: {told}"


class Named(BaseModel):
    name: Annotated[str, Field(min_length=1)]


def test_nothing_is_said_of_python() -> None:
    with pytest.raises(ValidationError) as error:
        Named.model_validate({"name": "\ud800"})
    assert in_a_line(error.value).endswith("without half of a surrogate pair")
    with pytest.raises(ValidationError) as error:
        Named.model_validate("x", from_attributes=True)
    assert in_a_line(error.value) == "it: expected an object with named members"
