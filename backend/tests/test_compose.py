"""The compose file, which cannot be started everywhere, is at least what Compose reads and keeps to the loopback."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML

ROOT = Path(__file__).parents[2]

# The part of the Compose specification that the file uses; whatever else stands in it is a mistake.
STRINGS = {"type": "array", "items": {"type": "string"}}
DURATION = {"type": "string", "pattern": "^([0-9]+(ms|s|m|h))+$"}
SERVICE = {
    "type": "object",
    "additionalProperties": False,
    "required": ["build", "healthcheck"],
    "properties": {
        "build": {
            "type": "object",
            "additionalProperties": False,
            "required": ["context"],
            "properties": {"context": {"type": "string"}, "dockerfile": {"type": "string"}},
        },
        "command": STRINGS,
        "environment": {"type": "object", "additionalProperties": {"type": ["string", "number", "null"]}},
        "healthcheck": {
            "type": "object",
            "additionalProperties": False,
            "required": ["test"],
            "properties": {
                "test": {**STRINGS, "prefixItems": [{"enum": ["CMD", "CMD-SHELL", "NONE"]}], "minItems": 1},
                "interval": DURATION,
                "timeout": DURATION,
                "start_period": DURATION,
                "retries": {"type": "integer", "minimum": 1},
            },
        },
        "init": {"type": "boolean"},
        "network_mode": {"type": "string"},
        "ports": STRINGS,
        "restart": {"enum": ["no", "always", "on-failure", "unless-stopped"]},
    },
}
COMPOSE = {
    "type": "object",
    "additionalProperties": False,
    "required": ["services"],
    "properties": {"services": {"type": "object", "minProperties": 1, "additionalProperties": SERVICE}},
}


@pytest.fixture
def compose() -> dict[str, Any]:
    loaded: dict[str, Any] = YAML(typ="safe").load(ROOT / "docker-compose.yml")
    return loaded


def test_compose_reads_it(compose: dict[str, Any]) -> None:
    Draft202012Validator.check_schema(COMPOSE)
    Draft202012Validator(COMPOSE).validate(compose)


def test_nothing_is_published_beyond_the_loopback(compose: dict[str, Any]) -> None:
    for service in compose["services"].values():
        assert all(port.startswith("127.0.0.1:") for port in service.get("ports", []))
        assert service["environment"]["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
        if service.get("network_mode") == "host":
            assert "--host=127.0.0.1" in service["command"]


def test_it_says_whether_it_is_well(compose: dict[str, Any]) -> None:
    for service in compose["services"].values():
        assert "http://127.0.0.1:8000/healthz" in " ".join(service["healthcheck"]["test"])


def test_it_runs_a_model_of_this_repository_on_rclpy(compose: dict[str, Any]) -> None:
    command = compose["services"]["station"]["command"]
    assert command[:2] == ["sequence-planner", "run"]
    assert (ROOT / command[2]).is_dir()
    assert "--transport=rclpy" in command


def test_the_image_is_ros_jazzy(compose: dict[str, Any]) -> None:
    build = compose["services"]["station"]["build"]
    recipe = ROOT / build["context"] / build["dockerfile"]
    bases = [line.split()[1] for line in recipe.read_text().splitlines() if line.startswith("FROM ")]
    assert bases == ["ros:jazzy"]
