"""JSON Schemas of a station's files, with which editors complete and check what is typed.

A file names its own in its first line: `# yaml-language-server: $schema=../../docs/schemas/station.schema.json`.
They know the form of the documents; what names and conditions mean, `sequence-planner check` says.
"""

from __future__ import annotations

import ast
import inspect
import json
import re
import sys
import textwrap
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from sequence_planner.model.documents import (
    AbilityDocument,
    OperationDocument,
    ResourceDocument,
    SpecificationDocument,
    StationDocument,
    WorkMasterDocument,
)
from sequence_planner.model.efa_document import PlainDocument
from sequence_planner.model.fields import DocumentPart
from sequence_planner.model.mimic.documents import MimicDocument
from sequence_planner.model.scenarios.documents import ACTS, EXPECTATIONS, ScenarioDocument, ScenarioStepDocument
from sequence_planner.model.sequences import KINDS, SequenceDocument, SequencePart
from sequence_planner.model.shifts.documents import ShiftDocument
from sequence_planner.model.stages.registry import StageDocument
from sequence_planner.model.types.composed import InstanceDocument, TypeDocument
from sequence_planner.model.types.packages import PackageDocument

# The files of a station, and plain automata, by the names of their schemas: what each holds, and what it is called.
FILES: Mapping[str, tuple[Any, str]] = {
    "station": (StationDocument, "station.yaml"),
    "resource": (ResourceDocument, "resources/<name>.yaml"),
    "instance": (InstanceDocument, "resources/<name>.yaml with a type"),
    "type": (TypeDocument, "types/<name>.yaml"),
    "package": (PackageDocument, "packages/<name>/package.yaml"),
    "operations": (dict[str, OperationDocument | SequenceDocument], "operations.yaml"),
    "specifications": (dict[str, SpecificationDocument], "specifications.yaml"),
    "work_masters": (dict[str, WorkMasterDocument], "work_masters.yaml"),
    "mimic": (MimicDocument, "mimic.yaml"),
    "tests": (dict[str, ScenarioDocument], "tests/<name>.yaml"),
    "shifts": (dict[str, ShiftDocument], "shifts.yaml"),
    "efa": (PlainDocument, "*.efa.json"),
}


class _Generator(GenerateJsonSchema):
    """Without the titles that only repeat a key."""

    def field_title_should_be_set(self, schema: object) -> bool:
        """A key says it."""
        return False

    def function_before_schema(self, schema: core_schema.BeforeValidatorFunctionSchema) -> JsonSchemaValue:
        """Describe what may be left out so that it is not left empty."""
        inner = schema["schema"]
        return (
            self.generate_inner(inner["schema"])
            if inner["type"] == "nullable"
            else super().function_before_schema(schema)
        )

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        """Without the defaults of what may be left out."""
        return (
            self.generate_inner(schema["schema"])
            if schema.get("default", 0) is None
            else super().default_schema(schema)
        )

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        """A document part; its title in words, and how many keys it has where that is more than their names say."""
        made = super().model_schema(schema)
        words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", schema["cls"].__name__.removesuffix("Document"))
        made["title"] = words.capitalize()
        for part in schema["cls"].__mro__:
            for name, text in _written_beneath(part) if issubclass(part, DocumentPart) else ():
                made["properties"][schema["cls"].model_fields[name].alias or name]["description"] = text
        if schema["cls"] is StageDocument:
            made |= {"minProperties": 1, "maxProperties": 1}
        if schema["cls"] is ScenarioStepDocument:
            made["oneOf"] = [{"required": [key]} for key in (*ACTS, *EXPECTATIONS)]
        if issubclass(schema["cls"], SequencePart):
            instead = ["operations", "orders"] if schema["cls"] is WorkMasterDocument else []
            made["anyOf" if instead else "oneOf"] = [{"required": [key]} for key in (*KINDS, *instead)]
        if schema["cls"] is AbilityDocument:
            made["if"] = {"not": {"required": ["until"]}}
            made["then"] = {"properties": {"finish": {"required": ["when"]}}}
        if schema["cls"] is SpecificationDocument:
            kinds = [key for key in made["properties"] if key not in ("title", "parameters", "while")]
            made["oneOf"] = [{"required": [key]} for key in kinds]
            made["dependentRequired"] = {"never": ["while"], "while": ["never"]}
        return made


def _written_beneath(part: type) -> Iterator[tuple[str, str]]:
    """The fields of a class, each with the text beneath it."""
    (definition,) = ast.parse(textwrap.dedent(inspect.getsource(part))).body
    assert isinstance(definition, ast.ClassDef)
    for above, below in pairwise(definition.body):
        match above, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                yield name, inspect.cleandoc(text)


def schema_of(name: str) -> dict[str, Any]:
    """The schema of one of `FILES`."""
    content, title = FILES[name]
    made = TypeAdapter(content).json_schema(schema_generator=_Generator)
    if name in ("instance", "type"):
        kept = _partial(made, made["$defs"], set())
        made = _with_parameters(kept) if name == "type" else kept
    return {"$schema": _Generator.schema_dialect, **made, "title": title}


def _partial(schema: Any, of: dict[str, Any], done: set[str]) -> Any:  # noqa: ANN401 (a schema of any form)
    """Let anything be left out that the other half, an instance or its type, may have: all but what is in lists."""
    if (reference := schema.get("$ref", "").rpartition("/")[2]) and reference not in done | {"ParameterDocument"}:
        done.add(reference)
        _partial(of[reference], of, done)
    for key in ("required", "if", "then"):
        schema.pop(key, None)
    within = schema.get("additionalProperties")
    for each in (*schema.get("properties", {}).values(), *schema.get("anyOf", ()), *([within] if within else ())):
        _partial(each, of, done)
    return schema


def _with_parameters(schema: Any) -> Any:  # noqa: ANN401
    """Let the name of a parameter stand where a number may."""
    if isinstance(schema, list):
        return [_with_parameters(each) for each in schema]
    if not isinstance(schema, dict):
        return schema
    if schema.get("type") not in ("number", "integer"):
        return {key: _with_parameters(each) for key, each in schema.items()}
    about = {key: schema[key] for key in ("description", "default") if key in schema}
    number = {key: each for key, each in schema.items() if key not in about}
    return {**about, "anyOf": [number, {"type": "string"}]}


def write_schemas(folder: Path) -> None:
    """Write `<name>.schema.json` for each of `FILES`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in FILES:
        text = json.dumps(schema_of(name), indent=2, ensure_ascii=False)
        (folder / f"{name}.schema.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    write_schemas(Path(sys.argv[1]))
