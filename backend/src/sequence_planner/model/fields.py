"""The things that all documents have in common: parts with nothing beside what is declared, and the values they
share.
"""

from __future__ import annotations

import re
from enum import Enum
from typing import Annotated, TypeVar

from pydantic import BeforeValidator, ConfigDict, Field

from sequence_planner.core.data_models import DataModel
from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.language.parser import QUANTIFIERS
from sequence_planner.language.resolver import ENDS, STEPS
from sequence_planner.model.source import SourceText


class DocumentPart(DataModel):
    """Base of all parts: nothing beside what is declared."""

    # What stands beneath a field is read when a schema is made (`json_schema`): here it would take time at each start.
    model_config = ConfigDict(allow_inf_nan=False, strict=True)


T = TypeVar("T")


def _given(value: object) -> object:
    if value is None:
        raise ValueError("there is nothing here: write a value, or leave the key out")
    return value


# What is known of each ability: the names of its conditions, which others may use.
FLAGS = ("enabled", "executing", "finished")

# Words that a text would take for something else where a name for something longer can stand.
RESERVED = frozenset({*STEPS, *ENDS, *QUANTIFIERS, "exactly", "where"})
OPERATION = "operation"  # what names of operations begin with in expressions
SHORT = ("predicate", "relation", "map")
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def fault_of_name(name: str, kind: str) -> str | None:
    """Say why a part of a model cannot have a name, by its `kind`, such as `set`; return None where it can."""
    if name in KEYWORDS:
        fault = "is a word of the language"
    elif not _IDENTIFIER.fullmatch(name):
        return f"`{name}` is no name: use letters, digits and `_`, and no digit first"
    elif name in FLAGS and kind in ("variable", "parameter", *SHORT):
        fault = "is a flag of every ability"
    elif name in RESERVED and kind in SHORT:
        fault = "is a word of quantifiers and orders"
    elif name == "bool" and kind in ("enumeration", "set"):
        fault = "is a type already"
    elif name == OPERATION and kind == "resource":
        fault = "stands for the operations in expressions"
    else:
        return None
    return f"`{name}` {fault}: take another name"


# What may be left out, and is not left empty: a key without a value says nothing.
Given = Annotated[T | None, BeforeValidator(_given)]


class TextUse(Enum):
    """Marks what a text of a document is, for those who look into it: all others are names and texts for people."""

    CONDITION = "condition"
    ACTION = "action"
    TYPE = "type"  # an enumeration, or another type of a variable


# A predicate is a text of the guard language; YAML itself reads a bare `true` as a truth value.
Predicate = Annotated[SourceText | bool, TextUse.CONDITION]
Action = Annotated[SourceText, TextUse.ACTION]
TypeName = Annotated[SourceText, TextUse.TYPE]
Seconds = Annotated[float, Field(ge=0, le=86_400)]
