"""The unit of systemd, what systemd is told, and what stands in the wheel."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from typer.core import TyperGroup
from typer.main import get_command

from sequence_planner.cli.main import app
from sequence_planner.process.service_manager import ServiceManager
from sequence_planner.settings import PREFIX, Configuration
from sequence_planner.startup.station_process import UNUSABLE
from support.places import BACKEND, REPOSITORY

UNIT = REPOSITORY / "deploy" / "sequence-planner@.service"
PAGE = REPOSITORY / "frontend" / "build"


def settings(section: str) -> dict[str, list[str]]:
    """What a section of the unit says; some names more than once."""
    found: dict[str, list[str]] = {}
    (text,) = [each for each in UNIT.read_text().split("\n[") if each.lstrip("[").startswith(f"{section}]")]
    for line in text.splitlines():
        name, equals, value = line.partition("=")
        if equals and not line.startswith("#"):
            found.setdefault(name, []).append(value)
    return found


def test_the_unit_runs_what_there_is() -> None:
    service = settings("Service")
    program, *arguments = service["ExecStart"][0].split()
    assert Path(program).name == "sequence-planner"
    read = get_command(app)
    assert isinstance(read, TyperGroup)
    options = {option for each in read.commands["run"].command().params for option in each.opts}  # type: ignore[attr-defined]
    assert arguments[0] == "run"
    assert arguments[1] in options
    for variable in (each.partition("=")[0] for each in service["Environment"]):
        assert not variable.startswith(PREFIX) or variable.removeprefix(PREFIX).lower() in Configuration.model_fields
    assert service["RestartPreventExitStatus"] == [str(UNUSABLE)]
    assert service["Type"] == ["notify"]


def test_the_unit_gives_no_more_rights_than_are_needed() -> None:
    service = settings("Service")
    for name, value in {"NoNewPrivileges": "yes", "ProtectSystem": "strict", "CapabilityBoundingSet": ""}.items():
        assert service[name] == [value]
    assert service["User"] != ["root"]
    assert service["StateDirectory"]


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd is not here")
def test_systemd_reads_the_unit(tmp_path: Path) -> None:
    program = Path(sys.executable)
    copied = tmp_path / UNIT.name.replace("@", "@press")
    copied.write_text(UNIT.read_text().replace("/opt/sequence-planner/bin/sequence-planner", str(program)))
    done = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", str(copied)], capture_output=True, text=True, check=False, timeout=60
    )
    assert (done.returncode, str(copied) in done.stderr, UNIT.stem in done.stderr) == (0, False, False), done.stderr


@pytest.mark.parametrize("abstract", [False, True])
def test_systemd_is_told_of_a_station(tmp_path: Path, abstract: bool) -> None:
    address = f"@sequence-planner-{os.getpid()}" if abstract else str(tmp_path / "notify")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as heard:
        heard.bind(f"\0{address[1:]}" if abstract else address)
        heard.settimeout(5)
        asked = {"NOTIFY_SOCKET": address, "WATCHDOG_USEC": "60000000", "WATCHDOG_PID": str(os.getpid())}
        environ = {**asked, "PATH": "/"}
        manager = ServiceManager(environ)
        assert environ == {"PATH": "/"}  # no part speaks for it
        assert manager.patience == 60
        manager.ready()
        manager.alive()
        manager.stopping()
        told = [heard.recv(1000).decode() for _ in range(3)]
    assert told[0].startswith("READY=1\n")
    assert told[1:] == ["WATCHDOG=1", "STOPPING=1"]
    manager.alive()  # systemd has gone: nothing comes of it


def test_nobody_is_told_where_nobody_asks() -> None:
    assert ServiceManager({}).patience is None
    assert ServiceManager({"WATCHDOG_USEC": "1000", "WATCHDOG_PID": "1"}).patience is None
    ServiceManager({}).ready()


def _files_below(folder: Path) -> list[str]:
    found = (each.relative_to(folder) for each in folder.rglob("*") if each.is_file())
    return [each.as_posix() for each in found if "__pycache__" not in each.parts]


@pytest.mark.skipif(not (PAGE / "index.html").is_file(), reason="the page is not built: make page")
def test_wheel_and_sdist_have_all_that_runs(tmp_path: Path) -> None:
    script = BACKEND / "packaging" / "distribute.py"
    subprocess.run([sys.executable, script, PAGE, tmp_path], check=True, capture_output=True, timeout=120)
    (wheel,), (sdist,) = tmp_path.glob("*.whl"), tmp_path.glob("*.tar.gz")
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
        archive.extractall(tmp_path / "installed")
        (metadata,) = [archive.read(name).decode() for name in names if name.endswith(".dist-info/METADATA")]
    assert metadata.startswith("Metadata-Version: ")
    for said in ("Author: The developers of Sequence Planner", "Keywords: automation", "Classifier: Typing :: Typed"):
        assert said in metadata
    assert "# Sequence Planner" in metadata  # the README
    source, page = BACKEND / "src", PAGE
    modules = {each.relative_to(source).as_posix() for each in source.rglob("*.py") if "page" not in each.parts}
    built = {f"sequence_planner/page/{each.relative_to(page).as_posix()}" for each in page.rglob("*") if each.is_file()}
    templates = source / "sequence_planner" / "cli" / "templates"
    shown = {each.relative_to(source).as_posix() for each in templates.rglob("*") if each.is_file()}
    models = REPOSITORY / "models"
    examples = {f"sequence_planner/models/{path}" for path in _files_below(models)}
    assert {"sequence_planner/py.typed"} | modules | built | shown | examples <= names
    assert any("migrations/versions/v0001" in name for name in modules)
    with tarfile.open(sdist) as archive_of_sources:
        inside = {name.partition("/")[2].removeprefix("src/") for name in archive_of_sources.getnames()}
    assert built | modules | shown | examples <= inside
    # What was installed finds its own page, schemas and examples, and not those of the repository.
    code = (
        "from pathlib import Path; import sys; from sequence_planner import launcher; "
        "from sequence_planner.model.json_schema import write_schemas; "
        "from sequence_planner.model.examples.library import example_folders; "
        "write_schemas(Path(sys.argv[1])); print(launcher.PAGE, *example_folders().values(), sep='\\n')"
    )
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "installed")}
    printed = subprocess.run(
        [sys.executable, "-c", code, tmp_path / "schemas"],
        env=environment,
        cwd=tmp_path,
        check=True,
        capture_output=True,
        text=True,
        timeout=60,
    ).stdout
    found, *folders = map(Path, printed.split("\n")[:-1])
    assert found == tmp_path / "installed" / "sequence_planner" / "page"
    installed = tmp_path / "installed" / "sequence_planner" / "models"
    assert folders == [installed / path.parent.name for path in sorted(models.glob("*/station.yaml"))]
    assert sorted(each.name for each in (tmp_path / "schemas").iterdir())
