"""The policy of SROS 2: its form is that of sros2's schema, and it allows what the station needs and no more."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from xml.etree import ElementTree

import pytest

from sequence_planner.controller import service as controller_process
from sequence_planner.export.sros2 import policy
from sequence_planner.ros import environment
from sequence_planner.ros.actions import ActionNames
from sequence_planner.simulation import manual_interface as emulated_devices
from sequence_planner.station import ReadyStation, prepare_station
from support.commands import command
from support.places import TESTS

MODELS = TESTS.parents[1] / "models"
STATIONS = [*sorted(each for each in MODELS.iterdir() if each.is_dir()), TESTS / "stations" / "mixer"]
# The schema of version 0.2.0: what each element holds, in the order there, and its attributes, those with * as needed.
HOLDS = {
    "policy": {"enclaves"},
    "enclaves": {"enclave"},
    "enclave": {"profiles"},
    "profiles": {"profile"},
    "profile": {"topics", "services", "actions"},
    "topics": {"topic"},
    "services": {"service"},
    "actions": {"action"},
    "topic": set(),
    "service": set(),
    "action": set(),
}
NEEDED = {"policy": {"version"}, "enclave": {"path"}, "profile": {"ns", "node"}}
QUALIFIERS = {
    "topics": {"publish", "subscribe"},
    "services": {"request", "reply"},
    "actions": {"call", "execute"},
}
EVERYBODY = {"/parameter_events", "~/get_type_description", "/*/get_type_description"}
PEOPLE = "/sequence_planner/emulator/"
Rights = dict[str, set[str]]


def check(element: ElementTree.Element) -> None:
    """Fails for what is not of the form that the schema has."""
    assert {each.tag for each in element} <= HOLDS[element.tag]
    assert HOLDS[element.tag] == set() or element.tag == "profile" or len(element)
    assert element.attrib.keys() >= NEEDED.get(element.tag, set())
    qualifiers = element.attrib.keys() - NEEDED.get(element.tag, set())
    assert qualifiers <= QUALIFIERS.get(element.tag, set())
    assert all(element.attrib[each] in ("ALLOW", "DENY") for each in qualifiers)
    assert bool((element.text or "").strip()) == (HOLDS[element.tag] == set())
    for each in element:
        check(each)


def allowed(root: ElementTree.Element, *, checks: bool = False) -> dict[str, Rights]:
    """What is allowed in each enclave beside what every node needs: to those nodes that look whether a process would be
    alone, or to all others.
    """
    found: dict[str, Rights] = {}
    for enclave in root.iter("enclave"):
        rights: Rights = defaultdict(set)
        for profile in enclave.iter("profile"):
            for rule in profile if profile.attrib["node"].endswith("_check") is checks else ():
                (qualifier,) = rule.attrib
                assert rule.attrib[qualifier] == "ALLOW"
                names = {each.text or "" for each in rule} - EVERYBODY
                rights[qualifier] |= {name for name in names if not name.startswith(PEOPLE)}
        found[enclave.attrib["path"]] = {qualifier: names for qualifier, names in rights.items() if names}
    return found


@pytest.fixture(scope="module", params=STATIONS, ids=lambda folder: folder.name)
def station(request: pytest.FixtureRequest) -> ReadyStation:
    return prepare_station(request.param)


@pytest.fixture
def root(station: ReadyStation) -> ElementTree.Element:
    return ElementTree.fromstring(policy(station.pipelines, station.ros_1).encode())


def test_its_form_is_that_of_the_schema(root: ElementTree.Element) -> None:
    assert (root.tag, root.attrib) == ("policy", {"version": "0.2.0"})
    check(root)


def test_the_controller_may_do_what_the_model_says_and_no_more(
    station: ReadyStation, root: ElementTree.Element
) -> None:
    pipelines, found = station.pipelines, allowed(root)
    wanted = {
        "publish": set(pipelines.outgoing),
        "subscribe": set(pipelines.incoming),
        "request": set(pipelines.services),
        "call": set(pipelines.actions),
    }
    assert found[environment.CONTROLLER] == {qualifier: names for qualifier, names in wanted.items() if names}
    assert found[environment.TOOLS] == {}


def test_who_looks_whether_it_would_be_alone_may_listen_to_what_it_would_say(
    station: ReadyStation, root: ElementTree.Element
) -> None:
    pipelines, found = station.pipelines, allowed(root, checks=True)
    states = {ActionNames(name).status for name in pipelines.actions}
    wanted = {environment.CONTROLLER: set(pipelines.outgoing), environment.EMULATED: {*pipelines.incoming, *states}}
    assert {path: rights for path, rights in found.items() if rights} == {
        path: {"subscribe": names} for path, names in wanted.items() if names
    }
    for node in (controller_process.NODE, emulated_devices.NODE):
        assert environment.enclave_of(f"{node}_check") == environment.enclave_of(node) != environment.TOOLS


def test_devices_may_do_the_other_half(station: ReadyStation, root: ElementTree.Element) -> None:
    found, pipelines = allowed(root), station.pipelines
    other = {"publish": "subscribe", "subscribe": "publish", "request": "reply", "call": "execute"}
    controller = {other[qualifier]: names for qualifier, names in found[environment.CONTROLLER].items()}
    assert found[environment.EMULATED] == controller
    devices = {path: rights for path, rights in found.items() if path.startswith(f"{environment.DEVICES}/")}
    together: Rights = defaultdict(set)
    for path, rights in devices.items():
        for qualifier, names in rights.items():
            assert not names & together[qualifier]  # nobody may do what is another device's
            together[qualifier] |= names
        for name in rights.get("publish", ()):
            assert path == f"{environment.DEVICES}/{pipelines.incoming[name].topic.resource}"
    assert together == controller


def test_services_and_actions_are_among_what_is_tested() -> None:
    mixer = prepare_station(STATIONS[-1]).pipelines
    assert mixer.services
    assert mixer.actions


def test_topics_of_ros_1_are_none_of_it() -> None:
    pipelines = prepare_station(MODELS / "bolt_tightening").pipelines
    name = sorted(pipelines.incoming)[0]
    assert f">{name}<" in policy(pipelines)
    assert f">{name}<" not in policy(pipelines, {name})


def test_a_node_is_told_its_enclave_where_security_is_wanted() -> None:
    on = {"ROS_SECURITY_ENABLE": "true"}
    assert environment.arguments("sequence_planner", {}) == []
    assert environment.arguments("sequence_planner", on) == ["--ros-args", "--enclave", environment.CONTROLLER]
    assert environment.arguments("emulated_devices", on)[-1] == environment.EMULATED
    assert environment.arguments("sequence_planner_look_77", on)[-1] == environment.TOOLS
    assert environment.arguments("sequence_planner", {**on, environment.OVERRIDE: "/mine"}) == []


def test_by_the_command_line(tmp_path: Path) -> None:
    file = tmp_path / "policy.xml"
    code, out, err = command("security", STATIONS[0], "--to", file, "--keystore", "/etc/keys")
    assert (code, err) == (0, "")
    check(ElementTree.fromstring(file.read_bytes()))
    assert f"ros2 security create_permission /etc/keys {environment.CONTROLLER} {file}" in out.splitlines()
    assert command("security", STATIONS[0], "--to", tmp_path / "no" / "policy.xml")[0] == 2
