"""The schemas for editors: as published, they accept every document that we have and refuse usual mistakes."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from sequence_planner.model.json_schema import FILES, schema_of
from sequence_planner.model.yaml.reader import read_text
from support.places import DOCS, MODELS, REPOSITORY, STATIONS

SCHEMAS = DOCS / "schemas"
FOLDERS = [path.parent for folder in (MODELS, STATIONS) for path in sorted(folder.glob("*/station.yaml"))]
DOCUMENTS = [
    path for station in FOLDERS for below in ("", "resources/", "types/") for path in station.glob(f"{below}*.yaml")
]
PAGE = (DOCS / "model.md").read_text(encoding="utf-8")
SHOWN = dict(re.findall(r"^```yaml ([\w/]+\.yaml)\n((?:.*\n)*?)```$", PAGE, re.MULTILINE))


@pytest.mark.parametrize("name", FILES)
def test_what_is_published_is_what_the_models_say(name: str) -> None:
    """If not, `make types` publishes it again."""
    published = json.loads((SCHEMAS / f"{name}.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(published)
    assert published == schema_of(name)


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(REPOSITORY)))
def test_every_document_has_the_form_of_its_schema(path: Path) -> None:
    assert complaints(schema_name(str(path)), path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("file", SHOWN)
def test_every_document_of_the_page_too(file: str) -> None:
    assert complaints(schema_name(file), SHOWN[file]) == []


def test_the_documents_name_their_schemas() -> None:
    for path in (path for path in DOCUMENTS if path.is_relative_to(MODELS)):
        named = re.match(r"# yaml-language-server: \$schema=(\S+)\n", path.read_text(encoding="utf-8"))
        assert named, path
        assert (path.parent / named[1]).resolve() == SCHEMAS / f"{schema_name(str(path))}.schema.json"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("station", "title: no name\n"),
        ("station", "name: 5\n"),
        ("station", "name: a\nrests: true\n"),
        ("station", "name: a\nenumerations: {side: []}\n"),
        ("station", "name: a\nestimated: {x: {type: bool, each: {p: side}}}\n"),
        ("resource", "abilities: {a: {enabled: 7}}\n"),
        ("resource", "abilities: {a: {start: {do: x := y}}}\n"),
        ("resource", "abilities: {a: {finish: {do: [x := y]}}}\n"),
        ("resource", "abilities: {a: {effects: {e: {kind: begin, when: true, do: [a := b]}}}}\n"),
        ("resource", "abilities: {a: {effects: {e: {kind: starting, when: true, do: [a := b], takes: [1, 2, 3]}}}}\n"),
        ("resource", "abilities: {a: {effects: {e: {kind: starting, when: true, do: [a := b], takes: -1}}}}\n"),
        ("resource", "topics: {/a: {type: a/msg/B, direction: inn}}\n"),
        ("resource", "topics: {/a: {type: a/msg/B, direction: in, pipeline: [{}]}}\n"),
        ("resource", "topics: {/a: {type: a/msg/B, direction: in, pipeline: [{rename: {a: b}, constant: {c: 1}}]}}\n"),
        ("instance", "type: 5\n"),
        ("instance", "type: a\narguments: {b: [1]}\n"),
        ("instance", "type: a\nabilities: {a: {effects: {e: {takes: slow}}}}\n"),
        ("instance", "type: a\ntopics: {/a: {pipeline: [{}]}}\n"),
        ("type", "parameters: {a: number}\nabilities: {a: {effects: {e: {kind: begin}}}}\n"),
        ("type", "parameters: {a: numbr}\n"),
        ("type", "parameters: {a: {default: 1}}\n"),
        ("operations", "fetch: {goal: true}\n"),
        ("operations", "fetch:\n"),
        ("specifications", "a: {title: nothing forbidden}\n"),
        ("specifications", "a: {never: x, forbidden: y}\n"),
        ("specifications", "a: {never: x}\n"),
        ("work_masters", "job: {operations: {}}\n"),
    ],
)
def test_usual_mistakes_are_marked(name: str, text: str) -> None:
    assert complaints(name, text)


@pytest.mark.parametrize("takes", ["1.5", "[0.1, 2]", "0"])
def test_both_ways_to_write_a_duration(takes: str) -> None:
    effect = f"{{kind: starting, when: true, do: [a := b], takes: {takes}}}"
    assert complaints("resource", f"abilities: {{a: {{effects: {{e: {effect}}}}}}}\n") == []


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("instance", "type: a\narguments: {b: 1, c: d}\nabilities: {a: {effects: {e: {takes: 1}}}}\n"),
        ("type", "parameters: {a: number, b: {kind: value, of: c}}\nabilities: {a: {effects: {e: {takes: [0, a]}}}}\n"),
    ],
)
def test_a_part_may_be_in_the_type_and_its_rest_in_the_instance(name: str, text: str) -> None:
    assert complaints(name, text) == []


def schema_name(file: str) -> str:
    match Path(file).parent.name:
        case "types":
            return "type"
        case "resources":
            text = SHOWN.get(file) or Path(file).read_text(encoding="utf-8")
            return "instance" if re.search("^type:", text, re.MULTILINE) else "resource"
    return Path(file).stem


def complaints(name: str, text: str) -> list[str]:
    content: Any = read_text(text, "file").content
    return [error.message for error in validator(name).iter_errors(content)]


@cache
def validator(name: str) -> Draft202012Validator:
    return Draft202012Validator(schema_of(name))
