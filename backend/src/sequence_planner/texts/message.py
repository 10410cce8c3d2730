"""A text for people: English as a string, and what it says and with which arguments, for readers of other languages."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final, Self, overload

from typing_extensions import TypeAliasType

from sequence_planner.texts.catalogue import TEXTS

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic.json_schema import JsonSchemaValue
    from pydantic_core import CoreSchema

# `{name}`, `{name|waits|wait}` for what is said of one and of several, or `{name^}` where a sentence begins with it.
PLACE: Final = re.compile(r"\{(\w+)(?:\|([^|}]*)\|([^|}]*))?(\^)?\}")
_NAMED = 3  # of a list so many are named, and the others counted

Item = TypeAliasType("Item", "str | int | float | Message | Sentence | Wording")
Argument = TypeAliasType("Argument", "Item | Sequence[Item]")


class Message(str):
    """The text `id` of the catalogue, with `arguments` in its places. As a string it is in English."""

    id: str
    arguments: Mapping[str, Argument]

    def __new__(cls, id: str, arguments: Mapping[str, Argument] | None = None) -> Self:
        """Make it, and its English."""
        given = arguments or {}
        made = super().__new__(
            cls, "".join([part if isinstance(part, str) else part.filled(given) for part in _parts(id)])
        )
        made.id, made.arguments = id, given
        return made

    def __reduce__(self) -> tuple[type[Self], tuple[str, Mapping[str, Argument]]]:
        """Let other processes have it."""
        return type(self), (self.id, self.arguments)

    def sent(self) -> dict[str, object]:
        """What is sent of it, and kept: an object with `id` and `arguments`."""
        return {"id": self.id, "arguments": {name: _sent(each) for name, each in self.arguments.items()}}

    @classmethod
    def __get_pydantic_core_schema__(cls, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Return how that is read and written."""
        from pydantic_core import core_schema  # noqa: PLC0415 - most who say something send nothing

        fields = {
            "id": core_schema.typed_dict_field(core_schema.str_schema()),
            "arguments": core_schema.typed_dict_field(handler.generate_schema(Mapping[str, Argument]), required=False),
        }
        written = core_schema.typed_dict_schema(fields, cls_name=cls.__name__, extra_behavior="forbid")
        made = core_schema.no_info_after_validator_function(lambda one: cls(one["id"], one.get("arguments")), written)
        return core_schema.union_schema(
            [core_schema.is_instance_schema(cls), made],
            mode="left_to_right",
            ref=cls.__name__,
            serialization=core_schema.plain_serializer_function_ser_schema(cls.sent),
        )

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """Return what the object is like."""
        made: Any = schema["choices"][1]
        return handler(made["schema"]) | {"title": cls.__name__, "description": cls.__doc__}


class Title(str):
    """What a part of the model is called, in the words of who has written it: by language, and as a string as it stands
    in records.
    """

    __slots__ = ("words",)
    words: Mapping[str, str]

    def __new__(cls, text: str, words: Mapping[str, str]) -> Self:
        """Make it; `text` is one of the `words`."""
        made = super().__new__(cls, text)
        made.words = words
        return made

    def __reduce__(self) -> tuple[type[Self], tuple[str, Mapping[str, str]]]:
        """Let other processes have it."""
        return type(self), (str(self), self.words)


@dataclass(frozen=True)
class Wording:
    """A text in the words of who has written the model, by language."""

    words: Mapping[str, str]

    def __str__(self) -> str:
        """Return it in English, or in the first language that there is."""
        return self.words.get("en") or next(iter(self.words.values()), "")


@dataclass(frozen=True)
class Sentence(Wording):
    """What people are told in sentences, by language, and programs as it is `written` in the model's language."""

    written: str

    def __str__(self) -> str:
        """Return it as it is written."""
        return self.written

    def __hash__(self) -> int:
        return hash(self.written)


@dataclass(frozen=True)
class _Place:
    """A place of a text: for an argument, with a capital letter where it `begins`, or for what is said of `one` and of
    `several`.
    """

    name: str
    one: str | None
    several: str | None
    begins: str | None

    def filled(self, arguments: Mapping[str, Argument]) -> str:
        argument = arguments[self.name]
        if self.one is None or self.several is None:
            told = in_english(argument)
            return f"{told[:1].upper()}{told[1:]}" if self.begins else told
        assert isinstance(argument, int | float | Sequence) and not isinstance(argument, str)
        return self.one if (argument if isinstance(argument, int | float) else len(argument)) == 1 else self.several


@cache
def _parts(id: str, /) -> tuple[str | _Place, ...]:
    """What a text of the catalogue is made of."""
    text, end, found = TEXTS[id], 0, list[str | _Place]()
    for place in PLACE.finditer(text):
        found += [text[end : place.start()], _Place(*place.groups())]
        end = place.end()
    return (*found, text[end:])


@cache
def places(id: str, /) -> tuple[str, ...]:
    """The names of the arguments that a text of the catalogue has a place for."""
    return tuple(dict.fromkeys(part.name for part in _parts(id) if isinstance(part, _Place)))


def message(id: str, /, **arguments: Argument) -> Message:
    """A text of the catalogue, with what stands in its places."""
    return Message(id, arguments)


def in_english(argument: Argument) -> str:
    """An argument in English."""
    if isinstance(argument, float):
        return f"{argument:g}"
    if isinstance(argument, Sequence) and not isinstance(argument, str):
        return listed(argument)
    return str(argument)


def listed(items: Collection[Item]) -> str:
    """As in `a, b and c`, or with how many others there are; in English."""
    every = [in_english(item) for item in items]
    if len(every) > _NAMED + 1:
        every = [*every[:_NAMED], str(message("list.more", count=len(every) - _NAMED))]
    return str(message("list.and", most=", ".join(every[:-1]), last=every[-1])) if len(every) > 1 else "".join(every)


@overload
def joined(items: Iterable[str]) -> str: ...


@overload
def joined(items: Iterable[Item]) -> Item: ...


def joined(items: Iterable[Item]) -> Item:
    """All of them with semicolons between; of which there has to be one."""
    first, *others = items
    for each in others:
        first = message("list.semicolon", first=first, second=each)
    return first


def quoted(titles: Collection[str]) -> list[Item]:
    """Titles, each in the quotes of the language."""
    return [message("quoted", title=title) for title in titles]


def all_titles(titles: Iterable[str]) -> str:
    """Titles with commas between, in each language in which one of them is written."""
    every = list(titles)
    languages = sorted({language for each in every if isinstance(each, Title) for language in each.words})
    told = ", ".join(every)
    if not languages:
        return told
    said = {
        language: ", ".join(each.words.get(language, each) if isinstance(each, Title) else each for each in every)
        for language in languages
    }
    return Title(told, said)


# All that is waited for in one sentence: things that come, and what is to be so.

_CLAUSES = frozenset(("waits.sake", "waits.nearest"))


def waits_in_one(conditions: Iterable[Message]) -> Message | None:
    """Say what is waited for; None where it is nothing, or not what somebody waits for."""
    until, things = list[Item](), list[Item]()
    for each in conditions:
        if not each.id.startswith("waits."):
            return None
        if each.id == "waits.condition":
            said = each.arguments["condition"]
            assert isinstance(said, Sentence)
            until.append(said)
        else:
            (until if each.id in _CLAUSES else things).append(each)
    if until and things:
        return message("sentence.both", what=things, conditions=until)
    if until:
        return message("sentence.until", conditions=until)
    return message("sentence.for", what=things) if things else None


def awaiting(conditions: Collection[Message]) -> Message:
    """Say in one clause what something waits for, as in `which {waits}`; of which there has to be one."""
    return waits_in_one(conditions) or message("sentence.for", what=list(conditions))


def _sent(argument: Argument) -> object:
    match argument:
        case Message():
            return argument.sent()
        case Sentence():
            return {"words": dict(argument.words), "written": argument.written}
        case Wording() | Title():
            return {"words": dict(argument.words)}
        case str() | int() | float():
            return argument
    return [_sent(each) for each in argument]


# What was written down as a string is told again as what it said.


def as_it_was(said: str, *beginnings: str) -> Message:
    """Return what was said, of which a record may have the English alone: one of the texts whose ids begin so, or
    itself.
    """
    if isinstance(said, Message):
        return said
    for id_ in _beginning(beginnings):
        if found := _pattern(id_).fullmatch(said):
            return Message(id_, {name: _read(text, beginnings) for name, text in found.groupdict().items()})
    return message("as-it-was", text=said)


def _read(text: str, beginnings: tuple[str, ...]) -> Item:
    """An argument as it was written: a number, another text, or words."""
    if re.fullmatch(r"-?\d+(\.\d+)?", text):
        return float(text) if "." in text else int(text)
    told = as_it_was(text, *beginnings)
    return text if told.id == "as-it-was" else told


@cache
def _beginning(beginnings: tuple[str, ...]) -> tuple[str, ...]:
    """The texts whose ids begin so and that have words of their own, those with the most first."""
    own = {id_: PLACE.sub("", text) for id_, text in TEXTS.items() if beginnings and id_.startswith(beginnings)}
    return tuple(
        sorted((id_ for id_, words in own.items() if any(map(str.isalpha, words))), key=lambda id_: -len(own[id_]))
    )


@cache
def _pattern(id: str, /) -> re.Pattern[str]:
    """What a text looks like with some arguments or other."""
    said, pattern = set[str](), ""
    for part in _parts(id):
        if isinstance(part, str):
            pattern += re.escape(part)
        elif part.one is not None and part.several is not None:
            pattern += f"(?:{re.escape(part.one)}|{re.escape(part.several)})"
        else:
            pattern += f"(?P={part.name})" if part.name in said else f"(?P<{part.name}>.+?)"
            said.add(part.name)
    return re.compile(pattern, re.DOTALL)
