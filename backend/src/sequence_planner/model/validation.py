"""The account of what is wrong with the form of a document, said in its own words.

pydantic finds it; here its findings get their place in the file, and those about one entry become one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import reduce
from typing import Any, cast

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from sequence_planner.core.data_models import complained, expectation
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import Place
from sequence_planner.model.source import Finding
from sequence_planner.model.yaml.reader import EntryPath, YamlDocument
from sequence_planner.texts.message import message

# What a mapping is called in a document.
_IN_DOCUMENTS = dict.fromkeys(("dict", "mapping", "model"), "names")
# How a text begins that YAML takes for a mapping because of its colon.
_QUANTIFIER = re.compile(r"(?:all|any|none|count|exactly \d+|at (?:least|most) \d+) +\w+ *(?:, *\w+ *)* in +\w*")


def findings_of(error: ValidationError, document: YamlDocument, at: EntryPath, kind: type[BaseModel]) -> list[Finding]:
    """The findings of `error`, which came of reading the entry of `document` at `at` as a `kind`."""
    findings: list[Finding] = []
    expected: dict[tuple[Place, str], dict[str, None]] = {}
    every = error.errors()
    unquoted = {
        each["loc"][:-1]
        for each in every
        if each["type"] == "extra_forbidden" and _QUANTIFIER.match(str(each["loc"][-1]))
    }
    for details in every:
        if details["type"] == "missing" and details["loc"][:-1] in unquoted:
            continue  # it is meant as a text, and that is told
        path = (*at, *_path(details["loc"], _content_at(document, at)))
        if said := _misplaced(details, document, at, kind) or _said(details, kind):
            about_name = details["type"] in ("extra_forbidden", "missing")
            findings.append(Finding(document.place(path) if about_name else document.place_of_value(path), said))
        elif not _is_looked_into(details, every):
            place = document.place_of_value(path)
            # Each branch of a union complains; together they say what would be right.
            found = shown(details["input"])
            if quotes := _needs_quotes(details["input"]):
                found = f"{found}{quotes}"
            expected.setdefault((place, found), {})[_expectation(details)] = None
    merged = [
        Finding(place, message("wrong.expected", wanted=_either(wants), found=found, hint=""))
        for (place, found), wants in expected.items()
    ]
    return [*findings, *merged]


def complaint(error: ValidationError, kind: type[BaseModel]) -> str:
    """Say what is wrong with something that was read as a `kind` and has no place in a file, in one line."""
    said: dict[str, None] = {}
    expected: dict[str, dict[str, None]] = {}
    for details in error.errors():
        if (words := _said(details, kind)) is not None:
            said[words] = None
        else:
            expected.setdefault(shown(details["input"]), {})[_expectation(details)] = None
    return "; ".join([*said, *(f"expected {' or '.join(wants)}, found {found}" for found, wants in expected.items())])


def members(errors: Iterable[Mapping[str, Any]], body: object) -> list[tuple[str, str]]:
    """The places of errors in a request with such a `body`, as in `body.mode`, each with what is wrong there."""
    found = []
    for details in errors:
        *around, name = details["loc"] or ("",)
        near = ""
        if details["type"] == "extra_forbidden":
            near = suggestion(str(name), [field for kind in _parts_in(body) for field in _fields_at(kind, around[1:])])
        found.append((".".join(map(str, details["loc"])), f"{complained(details)}{near}"))
    return found


def _path(loc: Sequence[str | int], content: object) -> Iterable[str | int]:
    """The entries that lead to what is wrong, without the names of the branches of unions between them."""
    for step in loc[:-1]:
        try:
            content = cast(Any, content)[step]
        except (KeyError, IndexError, TypeError):
            continue
        yield str(step) if isinstance(step, str) else step
    yield from loc[-1:]


def _content_at(document: YamlDocument, path: EntryPath) -> object:
    """Return what stands at an entry; None where there is none."""
    content: Any = document.content
    for step in path:
        try:
            content = content[step]
        except (KeyError, IndexError, TypeError):
            return None
    return content


def _said(details: ErrorDetails, kind: type[BaseModel]) -> str | None:
    """The whole message for an error that is not about the type of a value."""
    name = str(details["loc"][-1]) if details["loc"] else ""
    match details["type"]:
        case "extra_forbidden" if _QUANTIFIER.match(name):
            return f"this is a mapping, and a condition is a text{_quotes_around(name)}"
        case "extra_forbidden":
            hint = suggestion(name, _fields_at(kind, details["loc"][:-1]))
            return message("wrong.unknown-key", name=name, hint=hint)
        case "missing":
            is_entry = isinstance(details["loc"][-1], int)
            return message("wrong.missing-entry") if is_entry else message("wrong.missing-key", name=name)
        case "value_error" | "assertion_error":
            return complained(details)
    return None


def _misplaced(details: ErrorDetails, document: YamlDocument, at: EntryPath, kind: type[BaseModel]) -> str | None:
    """The message for a key that would be right with another indentation."""
    *around, name = details["loc"] or ("",)
    if details["type"] == "extra_forbidden":
        name = str(name)
        what = message("wrong.unknown-key", name=name, hint="")
        above, held = _entry_above(document, (*at, *around), name)
        is_free = above is not None and not (isinstance(held, dict) and name in held)
        if is_free and name in _fields_within(kind, (*around, str(above))):
            return message("wrong.indent-further", what=what, owner=str(above))
    elif details["input"] is None and isinstance(name, str) and name not in _fields_at(kind, around):
        what = message("wrong.empty-key", name=name)
    else:
        return None
    for end in reversed(range(len(around))):
        if name in _fields_at(kind, around[:end]):
            whose = (*at, *around)[: len(at) + end]
            if not whose:
                return message("wrong.indent-fully", what=what)
            return message("wrong.indent-less", what=what, owner=str(whose[-1]))
    return None


def _entry_above(document: YamlDocument, path: EntryPath, name: str) -> tuple[str | None, object]:
    """The entry that stands above `name` in the mapping at `path`, if it could hold others."""
    content = _content_at(document, path)
    names = list(content) if isinstance(content, dict) else []
    if name not in names[1:]:
        return None, None
    above = names[names.index(name) - 1]
    held = cast(dict[str, object], content)[above]
    return (str(above), held) if held is None or isinstance(held, dict) else (None, None)


def _is_looked_into(details: ErrorDetails, every: Iterable[ErrorDetails]) -> bool:
    """Return whether another branch of the union has taken this mapping for what it is, and says what is wrong in
    it.
    """
    here = details["loc"][:-1]
    return isinstance(details["input"], dict) and any(
        each["loc"][: len(here)] == here and len(each["loc"]) > len(details["loc"]) for each in every
    )


def _either(wants: Iterable[str]) -> str:
    return reduce(lambda most, last: message("list.or", most=most, last=last), wants)


def _expectation(details: ErrorDetails) -> str:
    return expectation(details, _IN_DOCUMENTS)


def shown(value: object) -> str:
    """Say what was found, in a few words."""
    match value:
        case None:
            return message("shown.nothing")
        case bool():
            return str(value).lower()
        case str() | int() | float():
            text = str(value)
            return f"`{text if len(text) <= 60 else text[:57] + '...'}`"
        case list():
            return message("shown.list" if value else "shown.empty-list")
    return message("shown.empty-mapping" if value == {} else "shown.mapping")


def _needs_quotes(content: object) -> str:
    """Say what to do about a condition or an action that YAML took for a mapping because of its colon."""
    name = str(next(iter(content), "")) if isinstance(content, dict) else ""
    return _quotes_around(name) if _QUANTIFIER.match(name) else ""


def _quotes_around(beginning: str) -> str:
    written = _QUANTIFIER.match(beginning)
    return f': put quotes around a text with a colon, as in "{written[0] if written else beginning}: …"'


def _fields_at(kind: type[BaseModel], path: Iterable[str | int]) -> list[str]:
    """The names that the part of a document at `path` may have."""
    parts: list[Any] = [kind]
    for step in path:
        parts = [inner for part in parts for inner in _inner(part, step)]
    return [field.alias or name for part in parts for name, field in part.model_fields.items()]


def _fields_within(kind: type[BaseModel], path: tuple[str | int, ...]) -> list[str]:
    """The names that what an entry at `path` holds may have; none where that is no document part."""
    *around, name = path
    parts: list[Any] = [kind]
    for step in around:
        parts = [inner for part in parts for inner in _inner(part, step)]
    fields = [field for part in parts for each, field in part.model_fields.items() if name == (field.alias or each)]
    inner = [each for field in fields for each in _parts_in(field.annotation)]
    return [field.alias or name for part in inner for name, field in part.model_fields.items()]


def _inner(part: type[BaseModel], step: str | int) -> list[Any]:
    """The document parts to which one step from `part` can lead."""
    for name, field in part.model_fields.items():
        if step == (field.alias or name):
            return _parts_in(field.annotation)
    return [part]  # a key or an index of the container just stepped into


def _parts_in(annotation: object) -> list[Any]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for argument in getattr(annotation, "__args__", ()) for found in _parts_in(argument)]
