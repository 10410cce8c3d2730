"""What the documents of a station can hold at each place, by their JSON Schemas: names, their values, what they are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import PurePosixPath
from typing import Any, NamedTuple

from sequence_planner.model.json_schema import FILES, schema_of
from sequence_planner.model.paths import has_scenarios, type_of
from sequence_planner.model.yaml.reader import EntryPath

Schema = Mapping[str, Any]


class DeclaredName(NamedTuple):
    """A name that an entry may have; one that `holds` others has a mapping or a list behind it."""

    name: str
    description: str
    holds: bool


class DocumentSchemas:
    """The schemas of all files; each is made when it is first asked for."""

    def entry_names(self, file: str, path: EntryPath) -> list[DeclaredName]:
        """The names that the mapping at `path` may have; none where they are free."""
        return [
            DeclaredName(name, self._description(file, inner), self._holds(file, inner))
            for schema in self._at(file, path)
            for name, inner in schema.get("properties", {}).items()
        ]

    def listed_values(self, file: str, path: EntryPath) -> list[str]:
        """The values among which the one at `path` is."""
        found: dict[str, None] = {}
        for schema in self._at(file, path):
            listed = [*schema.get("enum", ()), *([schema["const"]] if "const" in schema else ())]
            if schema.get("type") == "boolean" and not listed:
                listed = [True, False]
            found |= dict.fromkeys(str(each).lower() if isinstance(each, bool) else str(each) for each in listed)
        return list(found)

    def description(self, file: str, path: EntryPath) -> str:
        """What the entry at `path` is; empty where its name is free."""
        if not path:
            return ""
        name = path[-1]
        for schema in self._at(file, path[:-1]):
            if (inner := schema.get("properties", {}).get(name)) is not None:
                return self._description(file, inner)
        return ""

    def _at(self, file: str, path: EntryPath) -> list[Schema]:
        name = schema_name(file)
        if name is None:
            return []
        found = list(self._meant(name, _schema(name)))
        for step in path:
            found = [each for schema in found for inner in _inner(schema, step) for each in self._meant(name, inner)]
        return found

    def _meant(self, name: str, schema: Schema) -> Iterator[Schema]:
        """A schema with those that it refers to or consists of."""
        if (reference := schema.get("$ref")) is not None:
            yield from self._meant(name, _schema(name)["$defs"][reference.rpartition("/")[2]])
        for part in ("anyOf", "oneOf", "allOf"):
            for each in schema.get(part, ()):
                yield from self._meant(name, each)
        yield schema

    def _description(self, file: str, schema: Schema) -> str:
        name = schema_name(file)
        assert name is not None
        return next((each["description"] for each in (schema, *self._meant(name, schema)) if "description" in each), "")

    def _holds(self, file: str, schema: Schema) -> bool:
        name = schema_name(file)
        assert name is not None
        kinds = {each.get("type") for each in self._meant(name, schema)} - {None}
        return bool(kinds) and kinds <= {"object", "array"}


def schema_name(file: str) -> str | None:
    """The schema of a file of a station, or None for what is no document."""
    at = PurePosixPath(file)
    if at.suffix != ".yaml":
        return None
    if at.parts[:1] == ("resources",):
        return "instance"
    if has_scenarios(file):
        return "tests"
    return "type" if type_of(file) is not None else at.stem if at.stem in FILES else None


@cache
def _schema(name: str) -> Schema:
    return schema_of(name)


def _inner(schema: Schema, step: str | int) -> Iterator[Schema]:
    if isinstance(step, int):
        if isinstance(items := schema.get("items"), dict):
            yield items
        yield from schema.get("prefixItems", ())[step : step + 1]
        return
    named = schema.get("properties", {})
    if step in named:
        yield named[step]
    elif isinstance(others := schema.get("additionalProperties"), dict):
        yield others
