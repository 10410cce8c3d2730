"""Packages of types of resources: brought, locked, and checked without a network."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from sequence_planner.execution.record.recorder import model_digest
from sequence_planner.model.files import put_in_place, read_files
from sequence_planner.station import prepare_station, read_station
from support.places import MODELS
from support.station import finished

from .breaking import findings, replace

ROBOTS = MODELS / "robots_with_buffer"
MANIFEST = """\
name: robots
version: "1.2.0"
title: Robots with a gripper
enumerations: {place: [between, infeed, buffer, outfeed]}
"""
NO_ADDRESS = "is no address that begins with https, ssh or file and ://"
LOCKED = "packages/robots/package.yaml"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """The type of robot as a package, with its messages and its places."""
    folder = tmp_path / "shared" / "robots"
    shutil.copytree(ROBOTS / "types", folder / "types")
    shutil.copytree(ROBOTS / "messages", folder / "messages")
    (folder / "package.yaml").write_text(MANIFEST)
    (folder / "README.md").write_text("It is no part of the package.")
    return folder


@pytest.fixture
def station(tmp_path: Path) -> Path:
    """The station of two robots, without what it has of the package."""
    folder = Path(shutil.copytree(ROBOTS, tmp_path / "station"))
    for each in ("types", "messages"):
        shutil.rmtree(folder / each)
    for name in ("robot_1", "robot_2"):
        replace(folder, f"resources/{name}.yaml", "type: robot\n", "type: robots.robot\n")
    text = (folder / "station.yaml").read_text()
    begin, end = text.index("  # Where a robot can be."), text.index("\n# No sensor sees the buffer")
    (folder / "station.yaml").write_text(text[:begin] + text[end:])
    return folder


def names(station: Path, source: str) -> None:
    """Let the station name the package."""
    text = (station / "station.yaml").read_text()
    (station / "station.yaml").write_text(f"{text}\npackages:\n  robots: {source}\n")


@pytest.fixture
def fetched(station: Path, package: Path) -> Path:
    """The station with the package, brought from its folder."""
    names(station, "{path: ../shared/robots}")
    assert finished("packages", "fetch", str(station)).returncode == 0
    return station


def repository_of(package: Path) -> tuple[str, Path]:
    """A bare repository with the package, tagged v1; its address, and a clone of it."""
    bare, clone = package.parent / "robots.git", package.parent / "clone"
    subprocess.run(["git", "init", "--quiet", "--bare", str(bare)], check=True)
    shutil.copytree(package, clone)
    git(clone, "init", "--quiet", "--initial-branch=main")
    git(clone, "remote", "add", "origin", str(bare))
    commit(clone)
    git(clone, "tag", "v1")
    git(clone, "push", "--quiet", "origin", "main", "v1")
    return f"file://{bare}", clone


def commit(clone: Path) -> str:
    git(clone, "add", "--all")
    git(clone, "-c", "user.name=test", "-c", "user.email=test@example.org", "commit", "--quiet", "-m", "a change")
    return git(clone, "rev-parse", "HEAD")


def git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(["git", "-C", str(folder), *arguments], check=True, capture_output=True, text=True)
    return done.stdout.strip()


def test_a_station_with_a_package_is_the_same_station(fetched: Path) -> None:
    assert model_digest(prepare_station(fetched).automaton) == model_digest(read_station(ROBOTS).automaton)
    assert sorted(path.name for path in (fetched / "packages" / "robots").iterdir()) == [
        "messages",
        "package.yaml",
        "types",
    ]


def test_it_needs_nothing_but_its_folder_from_then_on(fetched: Path, package: Path) -> None:
    shutil.rmtree(package)
    assert finished("check", str(fetched)).returncode == 0
    assert finished("packages", "verify", str(fetched)).stdout == "robots 1.2.0 is what is locked\n"


def test_the_files_of_a_deployment_are_the_whole_model(fetched: Path, tmp_path: Path) -> None:
    files = read_files(fetched)
    assert {LOCKED, "packages.lock", "packages/robots/types/robot.yaml"} < files.keys()
    deployed = tmp_path / "deployed"
    deployed.mkdir()
    put_in_place(files, deployed)
    assert model_digest(prepare_station(deployed).automaton) == model_digest(read_station(ROBOTS).automaton)


def test_a_repository_at_a_tag_and_a_newer_one_only_when_it_is_asked_for(station: Path, package: Path) -> None:
    address, clone = repository_of(package)
    first = git(clone, "rev-parse", "v1")
    names(station, f"{{git: '{address}', revision: main}}")
    assert finished("packages", "fetch", str(station)).stdout == f"robots 1.2.0 at {first}: locked\n"
    (clone / "package.yaml").write_text(MANIFEST.replace("1.2.0", "1.3.0"))
    second = commit(clone)
    git(clone, "push", "--quiet", "origin", "main")
    shutil.rmtree(station / "packages")
    assert finished("packages", "fetch", str(station)).stdout == f"robots 1.2.0 at {first}: as it is locked\n"
    assert finished("packages", "update", str(station), "robots").stdout == f"robots 1.3.0 at {second}: locked\n"
    [listed] = json.loads(finished("packages", "list", str(station), "--json").stdout)
    assert (listed["name"], listed["version"], listed["revision"]) == ("robots", "1.3.0", second)
    assert read_station(station).automaton == read_station(ROBOTS).automaton


def test_nothing_of_a_repository_but_its_files_is_taken(station: Path, package: Path) -> None:
    address, clone = repository_of(package)
    (clone / "types" / "other.yaml").symlink_to("/etc/passwd")
    commit(clone)
    git(clone, "push", "--quiet", "origin", "main")
    names(station, f"{{git: '{address}', revision: main}}")
    refused = finished("packages", "fetch", str(station))
    assert refused.returncode == 2
    assert refused.stderr == "the package `robots`: types/other.yaml is a link, and a package has files alone\n"
    assert not (station / "packages").exists()


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("{git: 'ext::sh -c true', revision: main}", f"`ext::sh -c true` {NO_ADDRESS}"),
        ("{git: '--upload-pack=true', revision: main}", f"`--upload-pack=true` {NO_ADDRESS}"),
        ("{git: 'file:///nowhere', revision: '--help'}", "`--help` is no tag, branch or commit"),
        ("{path: ../nowhere}", "there is no package.yaml where it is brought from"),
    ],
)  # fmt: skip
def test_a_source_that_is_none(station: Path, source: str, message: str) -> None:
    names(station, source)
    refused = finished("packages", "fetch", str(station))
    assert (refused.returncode, refused.stderr) == (2, f"the package `robots`: {message}\n")


def test_a_revision_that_is_not_there(station: Path, package: Path) -> None:
    address, _ = repository_of(package)
    names(station, f"{{git: '{address}', revision: v2}}")
    refused = finished("packages", "fetch", str(station))
    assert refused.returncode == 2
    assert refused.stderr == "the package `robots` cannot be brought: there is no such revision\n"


# What is said of packages that are not what they should be.


def test_a_package_that_is_not_here(station: Path, package: Path) -> None:
    names(station, "{path: ../shared/robots}")
    place = f"{station}/station.yaml:{len((station / 'station.yaml').read_text().splitlines())}:3"
    assert f"{place}: the package `robots` is not locked: bring it with `sequence-planner packages fetch`" in findings(
        station
    )
    finished("packages", "fetch", str(station))
    shutil.rmtree(station / "packages")
    assert f"{place}: the package `robots` is not here: bring it with `sequence-planner packages fetch`" in findings(
        station
    )


def test_a_package_that_was_changed_is_refused_and_can_be_brought_back(fetched: Path) -> None:
    replace(fetched, "packages/robots/types/robot.yaml", "timeouts: {react: 2", "timeouts: {react: 3")
    message = (
        "the package `robots` is not what packages.lock has the hash of: `packages fetch` brings back what is locked "
        "if its source still has that, `packages update robots` locks what its source has now"
    )
    assert f"{fetched / LOCKED}:1:1: {message}" in findings(fetched)
    verified = finished("packages", "verify", str(fetched))
    assert (verified.returncode, verified.stdout) == (1, "")
    assert message in verified.stderr
    assert finished("packages", "fetch", str(fetched)).returncode == 0
    assert finished("packages", "verify", str(fetched)).returncode == 0


def test_a_source_that_has_changed_is_not_taken_unasked(fetched: Path, package: Path) -> None:
    replace(package, "types/robot.yaml", "timeouts: {react: 2", "timeouts: {react: 3")
    kept = finished("packages", "fetch", str(fetched))
    assert (kept.returncode, kept.stdout) == (0, "robots 1.2.0: as it is locked\n")
    assert read_station(fetched).automaton == read_station(ROBOTS).automaton
    assert finished("packages", "update", str(fetched)).returncode == 0
    moving = read_station(fetched).automaton.abilities["robot_1.move_to(buffer)"]
    assert moving.timeouts.react == 3


def test_what_is_here_as_it_is_locked_needs_no_source(fetched: Path, package: Path) -> None:
    shutil.rmtree(package)
    kept = finished("packages", "fetch", str(fetched))
    assert (kept.returncode, kept.stdout) == (0, "robots 1.2.0: as it is locked\n")
    shutil.rmtree(fetched / "packages")
    refused = finished("packages", "fetch", str(fetched))
    assert refused.stderr == "the package `robots`: there is no package.yaml where it is brought from\n"


def test_what_neither_the_station_nor_the_source_has_any_more(fetched: Path, package: Path) -> None:
    """Then nothing is taken unasked, and the folder stays as it is."""
    for each in (package / "types", fetched / "packages" / "robots" / "types"):
        replace(each, "robot.yaml", "timeouts: {react: 2", "timeouts: {react: 3")
    (package / "types" / "robot.yaml").write_text((package / "types" / "robot.yaml").read_text() + "# another\n")
    before = (fetched / "packages" / "robots" / "types" / "robot.yaml").read_text()
    refused = finished("packages", "fetch", str(fetched))
    assert (refused.returncode, refused.stderr) == (
        2,
        "the package `robots` cannot be brought as it is locked: ../shared/robots has another one by now than "
        "packages.lock has the hash of. Bring packages/robots back from the history of the model, or let "
        "`packages update robots` lock what its source has now\n",
    )
    assert (fetched / "packages" / "robots" / "types" / "robot.yaml").read_text() == before
    assert finished("packages", "update", str(fetched)).returncode == 0
    assert finished("packages", "verify", str(fetched)).returncode == 0


def test_another_source_in_the_station_is_noticed(fetched: Path, package: Path) -> None:
    other = Path(shutil.copytree(package, package.parent / "newer"))
    (other / "package.yaml").write_text(MANIFEST.replace("1.2.0", "1.3.0"))
    [place] = replace(
        fetched, "station.yaml", "  robots: {path: ../shared/robots}", "  ‹robots: {path: ../shared/newer}"
    )
    message = "packages.lock has the package `robots` from ../shared/robots, and not from ../shared/newer"
    assert f"{place}: {message}: bring it with `sequence-planner packages fetch`" in findings(fetched)
    assert finished("packages", "fetch", str(fetched)).stdout == "robots 1.3.0: locked\n"
    assert read_station(fetched).automaton == read_station(ROBOTS).automaton


def test_two_packages_of_one_name(fetched: Path, package: Path) -> None:
    shutil.copytree(package, package.parent / "arms")
    text = (fetched / "station.yaml").read_text()
    (fetched / "station.yaml").write_text(f"{text}  arms: {{path: ../shared/arms}}\n")
    refused = finished("packages", "fetch", str(fetched))
    assert refused.stderr == "the package `arms` calls itself `robots`: call it so in station.yaml\n"


def test_a_package_that_needs_another_one(station: Path, package: Path) -> None:
    (package / "package.yaml").write_text(f'{MANIFEST}needs: {{grippers: ">=2, <3"}}\n')
    names(station, "{path: ../shared/robots}")
    finished("packages", "fetch", str(station))
    assert (
        f"{station / LOCKED}:5:9: `robots` needs the package `grippers` >=2, <3: name it in station.yaml"
        in findings(station)
    )
    grippers = package.parent / "grippers"
    grippers.mkdir()
    (grippers / "package.yaml").write_text('name: grippers\nversion: "1.9"\n')
    text = (station / "station.yaml").read_text()
    (station / "station.yaml").write_text(f"{text}  grippers: {{path: ../shared/grippers}}\n")
    finished("packages", "fetch", str(station))
    assert f"{station / LOCKED}:5:19: `robots` needs `grippers` >=2, <3, and 1.9 is here: update it" in findings(
        station
    )
    (grippers / "package.yaml").write_text('name: grippers\nversion: "2.1"\n')
    finished("packages", "update", str(station))
    assert read_station(station).automaton == read_station(ROBOTS).automaton


def test_an_enumeration_that_is_there_already(fetched: Path) -> None:
    [place] = replace(fetched, "station.yaml", "enumerations:\n", "enumerations:\n  ‹place: [here]\n")
    [line] = [each for each in findings(fetched) if "duplicate" in each]
    assert line == f"{fetched / LOCKED}:4:16: duplicate name `place`, first declared at {place}: rename one"


def test_a_package_that_nobody_names(fetched: Path) -> None:
    text = (fetched / "station.yaml").read_text()
    (fetched / "station.yaml").write_text(text[: text.index("packages:")])
    message = "the package `robots` is not read: name it in `packages` of station.yaml, or remove its folder"
    assert f"{fetched / LOCKED}:1:1: {message}" in findings(fetched)
