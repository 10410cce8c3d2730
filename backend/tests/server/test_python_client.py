"""A Python client that is generated from the OpenAPI document has every operation, compiles, and works."""

from __future__ import annotations

import compileall
import importlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from sequence_planner.auth.roles import Scope
from sequence_planner.server.openapi import document
from support.examples import SHARE
from support.places import REPOSITORY
from support.server import Server

from .bearers import key
from .test_docs_curl import snippet, typed
from .test_job_orders import controller

__all__ = ["controller"]

BIN = REPOSITORY / ".client" / "bin"  # `make install-test` makes it
PROJECT, PACKAGE = "sequence-planner-client", "sequence_planner_client"
# The templates of the generator hand on what `with` ends with as objects; that is so in the client of any document.
TYPES = f"[mypy]\nstrict = true\n[mypy-{PACKAGE}.client]\ndisable_error_code = arg-type\n"
ASK = snippet("docs/mes.md", "job-orders/4711").splitlines()[0]
FETCH, GENERATE = snippet("docs/mes.md", "openapi-python-client").splitlines()


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `docs/mes.md` generates from the document; that ends with an error where anything is left out."""
    folder = tmp_path_factory.mktemp("client")
    (folder / "docs").symlink_to(REPOSITORY / "docs")
    (folder / "openapi.json").write_text(document(), encoding="utf-8")
    typed(GENERATE, folder, 120, PATH=os.pathsep.join((str(BIN), os.environ["PATH"])))
    return folder


def example() -> str:
    """The program of `docs/mes.md` that uses the client."""
    text = (REPOSITORY / "docs" / "mes.md").read_text(encoding="utf-8")
    [found] = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return str(found)


def operation(tag: str, name: str) -> ModuleType:
    """What the client has for an operation of the document."""
    return importlib.import_module(f"{PACKAGE}.api.{tag}.{name}")


def test_the_client_has_every_operation_and_compiles(made: Path) -> None:
    paths = json.loads((made / "openapi.json").read_text(encoding="utf-8"))["paths"]
    operations = [operation for verbs in paths.values() for operation in verbs.values()]
    named = {f"{each['tags'][0].replace(' ', '_')}/{each['operationId']}" for each in operations}
    files = (made / PROJECT / PACKAGE / "api").glob("*/[!_]*.py")
    assert sorted(f"{each.parent.name}/{each.stem}" for each in files) == sorted(named)
    assert len(named) == len(operations) > 100
    assert compileall.compile_dir(made / PROJECT, quiet=1)


@pytest.mark.skipif(SHARE < 1, reason="all of the client takes mypy long: `make campaign`")
def test_the_client_and_the_example_have_right_types(made: Path, tmp_path: Path) -> None:
    (tmp_path / "example.py").write_text(example(), encoding="utf-8")
    (tmp_path / "mypy.ini").write_text(TYPES, encoding="utf-8")
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--cache-dir", os.devnull, "-p", PACKAGE, "-m", "example"],
        cwd=tmp_path,
        env={**os.environ, "MYPYPATH": str(made / PROJECT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert checked.returncode == 0, checked.stdout + checked.stderr


@pytest.mark.skipif(shutil.which("curl") is None, reason="there is no curl here")
def test_the_walk_through_is_typed_as_it_is_written_with_the_key_that_it_names(server: Server, tmp_path: Path) -> None:
    secret, _ = key(server, Scope.ORDERS_READ, Scope.ORDERS_WRITE)
    shown = {"STATION": server.address, "STATION_KEY": secret}
    walk = snippet("docs/mes.md", "job-orders/4711")
    printed = typed(f"{walk}\n{FETCH}", tmp_path, **shown)
    assert '"truck_engine"' in printed.split('"id":"4711"')[0], "the work master is one of this station"
    assert '"outcome":"aborted"' in printed
    assert json.loads((tmp_path / "openapi.json").read_text(encoding="utf-8"))["openapi"].startswith("3.1")
    (tmp_path / "openapi.json").unlink()
    with pytest.raises(AssertionError, match="401"):
        typed(f"{ASK}\n{FETCH}", tmp_path, **shown | {"STATION_KEY": "wrong"})
    assert not (tmp_path / "openapi.json").exists(), "a refusal is not kept as a document"


@pytest.mark.skipif(shutil.which("curl") is None, reason="there is no curl here")
def test_the_client_stores_and_reads_orders_and_the_station(
    made: Path, server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    secret, _ = key(server, Scope.READ, Scope.ORDERS_READ, Scope.ORDERS_WRITE)
    shown = {"STATION": server.address, "STATION_KEY": secret}
    typed(f"{ASK}\n{FETCH}", tmp_path, **shown)
    fetched = json.loads((tmp_path / "openapi.json").read_text(encoding="utf-8"))
    assert fetched == json.loads((made / "openapi.json").read_text(encoding="utf-8"))
    done = subprocess.run(
        [sys.executable, "-c", example()],
        env={**os.environ, **shown, "PYTHONPATH": str(made / PROJECT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.stdout, done.stderr) == ("4712: AllowedToStart\n", "")

    monkeypatch.syspath_prepend(str(made / PROJECT))
    client, models = importlib.import_module(PACKAGE), importlib.import_module(f"{PACKAGE}.models")
    read, store = operation("job_orders", "read_job_order"), operation("job_orders", "store_job_order")
    with client.AuthenticatedClient(base_url=server.address, token=secret) as mes:
        station = operation("station", "station").sync(client=mes)
        assert (station.mode, station.by_order) == (models.Mode.AUTOMATIC, False)
        assert station.undecided["robot.target_pose"].quiet == ["above"]
        assert read.sync_detailed(client=mes, id="4712").headers["etag"] == '"1"'
        order = models.NewOrderBody(work_master="truck_engine", id="4712")
        again = store.sync(client=mes, body=order, idempotency_key="another")
        assert isinstance(again, models.Problem)
        assert (again.status, again.type_) == (409, "/problems/job-order-exists")
    with client.Client(base_url=server.address) as nobody:
        assert read.sync(client=nobody, id="4712").status == 401
