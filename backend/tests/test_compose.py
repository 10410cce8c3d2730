"""The compose file, which cannot be started everywhere, is at least what Compose reads and keeps to the loopback."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML
from sqlalchemy import make_url
from typer.core import TyperGroup
from typer.main import get_command

from sequence_planner.cli.main import app
from sequence_planner.db.location import address, backups_folder, revisions_folder
from sequence_planner.journal import checkpoints
from sequence_planner.mes.webhooks import endpoints
from support.places import DOCS, REPOSITORY

# The part of the Compose specification that the file uses; whatever else stands in it is a mistake.
STRINGS = {"type": "array", "items": {"type": "string"}}
DURATION = {"type": "string", "pattern": "^([0-9]+(ms|s|m|h))+$"}
SERVICE = {
    "type": "object",
    "additionalProperties": False,
    "required": ["healthcheck"],
    "oneOf": [{"required": ["build"]}, {"required": ["image"]}],
    "properties": {
        "build": {
            "type": "object",
            "additionalProperties": False,
            "required": ["context"],
            "properties": {
                "context": {"type": "string"},
                "dockerfile": {"type": "string"},
                "args": {"type": "object", "additionalProperties": {"type": "string"}},
            },
        },
        "command": STRINGS,
        "depends_on": {
            "type": "object",
            "additionalProperties": {
                "type": "object",
                "additionalProperties": False,
                "required": ["condition"],
                "properties": {"condition": {"enum": ["service_started", "service_healthy"]}},
            },
        },
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
        "image": {"type": "string", "pattern": "^[a-z]+(/[a-z]+)?:v?[0-9]+([.][0-9]+)*$"},
        "init": {"type": "boolean"},
        "network_mode": {"type": "string"},
        "ports": STRINGS,
        "profiles": STRINGS,
        "secrets": STRINGS,
        "restart": {"enum": ["no", "always", "on-failure", "unless-stopped"]},
        "volumes": STRINGS,
    },
}
COMPOSE = {
    "type": "object",
    "additionalProperties": False,
    "required": ["services"],
    "properties": {
        "services": {"type": "object", "minProperties": 1, "additionalProperties": SERVICE},
        "volumes": {"type": "object", "additionalProperties": {"type": "object", "additionalProperties": False}},
        "secrets": {
            "type": "object",
            "additionalProperties": {
                "type": "object",
                "additionalProperties": False,
                "required": ["file"],
                "properties": {"file": {"type": "string"}},
            },
        },
    },
}


@pytest.fixture
def compose() -> dict[str, Any]:
    loaded: dict[str, Any] = YAML(typ="safe").load(REPOSITORY / "docker-compose.yml")
    return loaded


@pytest.fixture
def guide() -> str:
    return (DOCS / "deployment.md").read_text(encoding="utf-8")


def stations(compose: dict[str, Any]) -> list[dict[str, Any]]:
    """The services that run a station of this repository."""
    return [service for service in compose["services"].values() if "build" in service]


def run_options(command: list[str]) -> dict[str, Any]:
    """What the options of a command that runs a station are read as."""
    assert command[:2] == ["sequence-planner", "run"]
    read = get_command(app)
    assert isinstance(read, TyperGroup)
    return read.commands["run"].make_context("run", command[2:]).params


def test_compose_reads_it(compose: dict[str, Any]) -> None:
    Draft202012Validator.check_schema(COMPOSE)
    Draft202012Validator(COMPOSE).validate(compose)
    for service in compose["services"].values():
        for each in service.get("volumes", []):
            source, _, target = each.partition(":")
            assert source in compose["volumes"] or ((REPOSITORY / source).is_file() and target.endswith(":ro"))
        assert set(service.get("secrets", [])) <= compose["secrets"].keys()
        for needed in service.get("depends_on", {}):
            assert set(service["profiles"]) <= set(compose["services"][needed]["profiles"])


def test_nothing_is_published_beyond_the_loopback(compose: dict[str, Any]) -> None:
    for service in compose["services"].values():
        assert all(port.startswith("127.0.0.1:") for port in service.get("ports", []))
        assert service.get("network_mode") in (None, "host")
    for service in stations(compose):
        assert service["network_mode"] == "host"
        assert service["environment"]["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
        assert "--host=127.0.0.1" in service["command"]


def test_they_say_whether_they_are_well(compose: dict[str, Any]) -> None:
    for service in stations(compose):
        assert "http://127.0.0.1:8000/healthz" in " ".join(service["healthcheck"]["test"])
    assert "pg_isready" in compose["services"]["postgresql"]["healthcheck"]["test"]


def test_each_runs_a_model_of_this_repository_on_rclpy(compose: dict[str, Any]) -> None:
    for service in stations(compose):
        options = run_options(service["command"])
        assert options["transport"] == "rclpy"
        environment = container(service)
        assert str(options["model"]) == environment["STATION_FOLDER"]
        [variable] = re.findall(r"^\$\{STATION:-(.*)\}$", service["build"]["args"]["STATION"])
        assert (REPOSITORY / variable / "station.yaml").is_file()
        # Services work between programs of one kind of middleware only: whoever has the other says so.
        assert service["environment"]["RMW_IMPLEMENTATION"] == "${RMW_IMPLEMENTATION:-rmw_cyclonedds_cpp}"


def test_only_the_demonstration_is_without_sign_in(compose: dict[str, Any]) -> None:
    trying, kept = (compose["services"][name] for name in ("station", "station-with-postgresql"))
    options = run_options(trying["command"])
    assert options["demonstration"]
    assert options["emulator"]
    assert "SEQUENCE_PLANNER_DATABASE" not in trying["environment"]
    assert not run_options(kept["command"])["demonstration"]


def test_the_station_finds_its_database_and_no_password_is_in_the_file(compose: dict[str, Any]) -> None:
    kept, server = (compose["services"][name] for name in ("station-with-postgresql", "postgresql"))
    url = make_url(kept["environment"]["SEQUENCE_PLANNER_DATABASE"])
    there = server["environment"]
    assert (url.username, url.database, url.password) == (there["POSTGRES_USER"], there["POSTGRES_DB"], None)
    assert server["ports"] == [f"{url.host}:{url.port}:5432"]
    # Not `${...:?}`, which Compose asks for also when the services of the profile are not started.
    assert kept["environment"]["PGPASSWORD"] == there["POSTGRES_PASSWORD"] == "${POSTGRES_PASSWORD-}"
    assert kept["profiles"] == server["profiles"] == ["postgresql"]
    assert kept["depends_on"] == {"postgresql": {"condition": "service_healthy"}}
    for ignored in (".gitignore", ".dockerignore"):
        assert ".env" in (REPOSITORY / ignored).read_text().splitlines()


def test_prometheus_scrapes_with_a_key_that_stands_in_no_file_of_the_repository(compose: dict[str, Any]) -> None:
    prometheus = compose["services"]["prometheus"]
    assert "--web.listen-address=127.0.0.1:9090" in prometheus["command"]
    (job,) = YAML(typ="safe").load(REPOSITORY / "deploy" / "prometheus.yml")["scrape_configs"]
    assert job["authorization"]["credentials_file"] == f"/run/secrets/{prometheus['secrets'][0]}"
    assert "credentials" not in job["authorization"]
    for service in stations(compose):
        options = run_options(service["command"])
        assert job["static_configs"] == [{"targets": [f"{options['host']}:{options['port']}"]}]
    file = compose["secrets"]["metrics-key"]["file"].removeprefix("./")
    assert not (REPOSITORY / file).exists() or file in (REPOSITORY / ".gitignore").read_text().splitlines()
    for ignored in (".gitignore", ".dockerignore"):
        assert file in (REPOSITORY / ignored).read_text().splitlines()


def test_the_way_beyond_the_loopback_fits_the_file(compose: dict[str, Any], guide: str) -> None:
    written = re.search(r"```yaml\n(services:\n.*?)```", guide, re.DOTALL)
    assert written is not None
    more = YAML(typ="safe").load(written[1])["services"]
    for name, service in more.items():
        merged = {**compose["services"][name], **service}
        Draft202012Validator(SERVICE).validate(merged)
        options = run_options(merged["command"])
        assert options["name"]
        folders = [each.split(":")[1] for each in merged["volumes"] if each.endswith(":ro")]
        for file in (options["certificate"], options["private_key"]):
            assert any(file.is_relative_to(folder) for folder in folders)


def container(service: dict[str, Any]) -> dict[str, str]:
    """The environment that the image gives its programs."""
    recipe = (REPOSITORY / service["build"]["context"] / service["build"]["dockerfile"]).read_text()
    return dict(re.findall(r"^(?:ENV)?\s+([A-Z_]+)=(\S+)", recipe, re.MULTILINE))


def volumes_of(service: dict[str, Any]) -> dict[str, str]:
    """The named volumes of a service, by where it has them."""
    parts = [each.split(":") for each in service.get("volumes", [])]
    return {target: source for source, target, *_ in parts if not source.startswith((".", "/"))}


def test_what_a_station_writes_survives_the_container(compose: dict[str, Any]) -> None:
    kept, server, prometheus = (
        compose["services"][name] for name in ("station-with-postgresql", "postgresql", "prometheus")
    )
    environment, volumes = container(kept), volumes_of(kept)
    # Keys of webhooks and checkpoints, revisions, backups; the model that is deployed; the generated code.
    assert volumes[environment["XDG_STATE_HOME"]] == "state"
    assert volumes[environment["STATION_FOLDER"]] == "model"
    assert volumes[environment["XDG_CACHE_HOME"]] == "messages"
    assert volumes_of(server) == {"/var/lib/postgresql/data": "postgresql"}
    assert volumes_of(prometheus) == {"/prometheus": "prometheus"}
    # They are Compose's own, which `down` leaves alone, and no two services write to one but the code.
    assert all(each == {} for each in compose["volumes"].values())
    sources = [source for service in compose["services"].values() for source in volumes_of(service).values()]
    assert sorted(set(sources)) == sorted(compose["volumes"])
    assert [each for each in set(sources) if sources.count(each) > 1] == ["messages"]


def test_keys_revisions_and_backups_are_in_the_volume_of_the_state(
    compose: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = compose["services"]["station-with-postgresql"]
    environment, url = container(kept), kept["environment"]["SEQUENCE_PLANNER_DATABASE"]
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    model, place = Path(environment["STATION_FOLDER"]), address(url)
    keys = {checkpoints.key_file(place), endpoints.key_file(place)}
    places = keys | {revisions_folder(url, model), backups_folder(url, model)}
    assert len(places) == 4
    assert all(place.is_relative_to(environment["XDG_STATE_HOME"]) for place in places)
