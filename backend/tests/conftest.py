"""Which tests run beside many others; and nothing that one run of the tests has kept is believed by the next."""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import settings

from support.examples import examples
from support.network import DOMAIN
from support.places import TESTS

pytest_plugins = ["support.databases"]

# What does not say how many examples it wants has those of hypothesis, and as all others the same in every run.
settings.register_profile("everywhere", examples(100))
settings.load_profile("everywhere")

# What runs a station, or measures how long something takes, would be disturbed by many tests beside it.
HEAVY = (
    "controller",
    "simulation",
    "foreign",
    "golden/test_all_journals.py",
    "ros",
    "rosbridge",
    "running",
    "stations",
    "server/test_connections.py",
    "server/test_ending.py",
    "server/test_looking.py",
    "server/test_order_desk.py",
    "server/test_order_of_work.py",
    "server/test_stream.py",
    "server/test_watches.py",
    "analysis/test_process.py",
    "checks/test_edited_station.py",
    "checks/test_speed.py",
    "core/test_race.py",
    "history/test_controller.py",
    "history/test_process.py",
    "history/test_rest.py",
    "mes/test_sequencing_process.py",
    "pipelines/test_speed.py",
    "pipelines/test_stage_python.py",
    "test_tutorial.py",
)
# Of those, what neither runs anything nor looks at the clock.
LIGHT = (
    "controller/alarming/test_causes.py",
    "controller/alarming/test_folding.py",
    "controller/alarming/test_life.py",
    "controller/test_asking_decisions.py",
    "controller/test_belief.py",
    "controller/test_conduct.py",
    "controller/test_contradictions.py",
    "controller/test_device_faults.py",
    "controller/test_example_stations.py",
    "controller/test_execution.py",
    "controller/test_forcing.py",
    "controller/test_release.py",
    "controller/test_responsible.py",
    "controller/test_standing_still.py",
    "controller/test_starts.py",
    "controller/test_tasks.py",
    "controller/test_ticks.py",
    "controller/test_trying_again.py",
    "controller/test_undecided.py",
    "simulation/test_devices.py",
    "simulation/test_fault_text.py",
    "ros/test_ros_ament.py",
    "ros/test_ros_definitions.py",
    "ros/test_ros_interfaces.py",
    "ros/test_ros_messages.py",
    "stations/test_drivers.py",
    "stations/test_faults_at_the_dock.py",
    "stations/test_taking_over.py",
)
# What takes longest: begun at last, it would keep one processor busy when there is nothing left for the others.
LONGEST = ("server/test_schemathesis.py",)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests that are heavy, and let those that take longest begin first."""
    for item in items:
        if is_heavy(item.path):
            item.add_marker(pytest.mark.heavy)
    items.sort(key=lambda item: not _is_in(item.path, LONGEST))


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave what is not to run unread where the one kind is asked for: reading all takes each worker half a minute."""
    asked = {"heavy": True, "not heavy": False}.get(config.getoption("markexpr"))
    if asked is None or not collection_path.match("test_*.py"):
        return None
    return is_heavy(collection_path) != asked or None


@cache
def is_heavy(path: Path) -> bool:
    """Whether the tests of a file are heavy."""
    return _is_in(path, HEAVY) and not _is_in(path, LIGHT)


def _is_in(path: Path, places: tuple[str, ...]) -> bool:
    return any(path.is_relative_to(TESTS / each) for each in places)


@pytest.fixture(scope="session", autouse=True)
def _own_surroundings(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A network, a cache and databases of this run alone, also for processes that it starts; certificates of nobody.

    Nothing leaves the loopback, and to read all that a machine trusts takes each client longer than most tests do.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        patch.setenv("XDG_STATE_HOME", str(tmp_path_factory.mktemp("state")))
        patch.setenv("SSL_CERT_DIR", str(tmp_path_factory.mktemp("certificates")))
        patch.delenv("SSL_CERT_FILE", raising=False)
        yield


@pytest.fixture
def short_path() -> Iterator[Path]:
    """A folder whose path is short enough for sockets in it, which `tmp_path` is not beside other tests."""
    with TemporaryDirectory() as folder:
        yield Path(folder)


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """One more worker than processors, as tests with servers wait for these now and then."""
    return (os.cpu_count() or 1) + 1
