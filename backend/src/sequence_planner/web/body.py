"""What requests have in common: bodies with nothing undeclared, names that people give, identifiers."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path
from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from sequence_planner.identity.names import LONGEST_NAME, clean_name
from sequence_planner.identity.refusal import IdentityRefused
from sequence_planner.journal.entry import LONGEST_REASON


class Body(BaseModel):
    """Base of all bodies: nothing beside what is declared."""

    model_config = ConfigDict(extra="forbid")


class NothingBody(Body):
    """Nothing more is to be said."""


def _name(text: str) -> str:
    try:
        return clean_name(text)
    except IdentityRefused as refused:
        raise ValueError(refused.detail) from None


Name = Annotated[str, Field(min_length=1, max_length=LONGEST_NAME), AfterValidator(_name)]
Reason = Annotated[str | None, Field(max_length=LONGEST_REASON)]
Identifier = Annotated[str, Path(max_length=200)]
