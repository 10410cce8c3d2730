"""The things that all documents have in common: parts with nothing beside what is declared, and the values they
share.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import Enum
from typing import Annotated, TypeVar

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Discriminator, Field, Tag, model_validator

from sequence_planner.core.data_models import DataModel
from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.language.names.scope import ENDS, STEPS
from sequence_planner.language.parser import QUANTIFIERS
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message


class DocumentPart(DataModel):
    """Base of all parts: nothing beside what is declared."""

    # What stands beneath a field is read when a schema is made (`json_schema`): here it would take time at each start.
    model_config = ConfigDict(allow_inf_nan=False, strict=True)


T = TypeVar("T")


def _given(value: object) -> object:
    if value is None:
        raise ValueError(message("form.nothing"))
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
Seconds = Annotated[float, Field(ge=0, le=86_400, json_schema_extra={"unit": "s"})]


# Texts for people.


def _said(text: SourceText) -> SourceText:
    if not text.strip():
        raise ValueError(message("form.empty-text"))
    return text


SaidText = Annotated[SourceText, AfterValidator(_said)]


class WordsDocument(DocumentPart):
    """A text for people in several languages."""

    en: Given[SaidText] = None
    """English, which is told where a language has no text of its own."""
    sv: Given[SaidText] = None
    """Swedish."""

    @model_validator(mode="after")
    def _says_something(self) -> WordsDocument:
        if not self.model_fields_set:
            raise ValueError(message("form.no-language"))
        return self


def _form_of_words(content: object) -> str | None:
    if isinstance(content, dict | WordsDocument):
        return "words"
    return "text" if isinstance(content, str) else None


Words = Annotated[
    Annotated[SaidText, Tag("text")] | Annotated[WordsDocument, Tag("words")],
    Discriminator(_form_of_words, "words", "a text, or one for each language: `{en: …, sv: …}`"),
]


def by_language(text: Words | None) -> dict[str, SourceText]:
    """A text for people by its language; one that is written in none in particular is under the empty one."""
    if text is None:
        return {}
    if isinstance(text, SourceText):
        return {"": text}
    return {language: said for language in type(text).model_fields if (said := getattr(text, language)) is not None}


def words_of(text: Words | None) -> Mapping[str, str]:
    """The same without the places at which it is written."""
    return {language: str(said) for language, said in by_language(text).items()}


def main_text(text: Words | None) -> SourceText | None:
    """A text for people as it stands in records and names: in English, or else in the first language that there is."""
    said = by_language(text)
    return said.get("en") or next(iter(said.values()), None)
