"""Flows: topics brought together, one topic twice, and the order in which a graph works."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.model.source import ModelError
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.station import ReadyStation

from .station_writing import Heard, station_with

FIELDS = {
    "Scene": "string[] objects\nbool moving\n",
    "Arm": "float64 force\nbool moving\ngeometry_msgs/Pose pose\n",
}

GRIPPED = """
topics:
  /scene: {type: tank_msgs/msg/Scene, direction: in, ignore: [moving]}
  /left: {type: tank_msgs/msg/Arm, direction: in, ignore: [moving]}
  /right: {type: tank_msgs/msg/Arm, direction: in, ignore: [moving]}
flows:
  gripped:
    from: {scene: /scene, arm: /left}
    pipeline:
      - member: {field: scene.objects, item: tool, variable: attached}
      - expression: {holds: "attached and arm.force > 2.5", high: arm.pose.position.z > 1}
  any_arm:
    from: [/left, /right]
  surely:
    from: gripped
    pipeline:
      - expression: {sure: holds and high}
measured:
  attached: {type: bool}
  holds: {type: bool}
  sure: {type: bool}
  moving: {type: bool}
"""


@pytest.fixture(scope="module")
def station(tmp_path_factory: pytest.TempPathFactory) -> ReadyStation:
    return station_with(tmp_path_factory.mktemp("station"), GRIPPED, FIELDS)


@pytest.fixture(scope="module")
def listen(station: ReadyStation) -> Callable[[], Heard]:
    """Hears the station from the beginning."""

    def begin() -> Heard:
        return Heard(station)

    return begin


def known(heard: Heard, *stale: str) -> dict[str, object]:
    """What is known of the tank, without its name."""
    values = heard.known(*stale).items()
    return {name.removeprefix("tank."): value for name, value in values if name.startswith("tank.")}


def test_a_merge_speaks_once_each_source_has_spoken(station: ReadyStation) -> None:
    heard = Heard(station)
    heard.take("/scene", objects=["camera", "tool"])
    assert known(heard) == dict.fromkeys(("attached", "holds", "sure", "moving"))
    heard.take("/left", force=3.0, pose={"position": {"z": 2.0}}, moving=True)
    assert known(heard) == {"attached": True, "holds": True, "sure": True, "moving": True}
    heard.take("/scene", objects=["camera"])
    assert known(heard) == {"attached": False, "holds": False, "sure": False, "moving": True}


def test_of_sources_in_the_order_of_arrival_the_last_one_counts(station: ReadyStation) -> None:
    heard = Heard(station)
    heard.take("/left", moving=True)
    heard.take("/right", moving=False)
    assert known(heard)["moving"] is False
    heard.take("/left", moving=True)  # what it said before, and it is news
    assert known(heard)["moving"] is True


EVENTS = st.lists(
    st.one_of(
        st.tuples(st.just("/scene"), st.fixed_dictionaries({"objects": st.lists(st.sampled_from(["tool", "cup"]))})),
        st.tuples(
            st.sampled_from(["/left", "/right"]),
            st.fixed_dictionaries({"force": st.floats(0, 5), "moving": st.booleans()}),
        ),
        st.tuples(st.sampled_from(["/scene", "/left", "/right"]), st.none()),  # it has fallen silent
    ),
    max_size=15,
)


@given(EVENTS)
def test_it_is_always_what_the_last_messages_say(
    listen: Callable[[], Heard], events: list[tuple[str, dict[str, Any] | None]]
) -> None:
    heard = listen()
    last: dict[str, dict[str, Any]] = {}
    moved: list[bool] = []
    for topic, fields in events:
        if fields is None:
            last.pop(topic, None)
            heard.running.forget(topic)
        else:
            last[topic] = fields
            heard.take(topic, **fields)
            moved += [fields["moving"]] if "moving" in fields else []
        stale = {"/scene", "/left", "/right"} - set(last)
        expected = dict.fromkeys(("attached", "holds", "sure", "moving"))
        if "/scene" in last and "/left" in last:
            attached = "tool" in last["/scene"]["objects"]
            expected |= {"attached": attached, "holds": attached and last["/left"]["force"] > 2.5, "sure": False}
        if not {"/left", "/right"} <= stale:
            expected["moving"] = moved[-1]
        assert known(heard, *stale) == expected


def test_what_comes_of_a_silent_topic_is_unknown(station: ReadyStation) -> None:
    heard = Heard(station)
    heard.take("/scene", objects=["tool"])
    heard.take("/left", force=3.0, moving=True)
    assert known(heard, "/scene") == {"attached": None, "holds": None, "sure": None, "moving": True}
    assert known(heard, "/left")["moving"] is True, "the right arm has spoken for both"
    assert known(heard, "/left", "/right")["moving"] is None


def test_after_silence_a_merge_waits_for_that_topic_again(station: ReadyStation) -> None:
    heard = Heard(station)
    heard.take("/scene", objects=["tool"])
    heard.take("/left", force=3.0)
    heard.running.forget("/scene")
    heard.take("/left", force=1.0)
    assert known(heard)["holds"] is None
    heard.take("/scene", objects=["tool"])
    assert known(heard)["holds"] is False


def test_a_message_that_cannot_be_read_makes_what_is_behind_it_unknown(station: ReadyStation) -> None:
    heard = Heard(station)
    heard.take("/scene", objects=["tool"])
    heard.take("/left", force=3.0, moving=True)
    heard.running.spoil("/left", "not an Arm")
    assert known(heard) == dict.fromkeys(("attached", "holds", "sure", "moving"))
    assert heard.running.trouble("/left") == "not an Arm"
    heard.take("/scene", objects=[])
    assert known(heard)["attached"] is None, "nothing is known of the arm"
    heard.take("/left", force=3.0)
    assert known(heard)["attached"] is False


def test_two_ways_from_one_topic_meet_in_one_record(tmp_path: Path) -> None:
    resource = """
topics:
  /arm: {type: tank_msgs/msg/Arm, direction: in}
flows:
  strong: {from: /arm, pipeline: [expression: {strong: force > 1.5}]}
  weak: {from: /arm, pipeline: [expression: {weak: not force > 1.5}]}
  both:
    from: {one: strong, other: weak}
    pipeline: [expression: {contradiction: one.strong == other.weak}]
measured: {contradiction: {type: bool}, moving: {type: bool}}
"""
    heard = Heard(station_with(tmp_path, resource, FIELDS))
    for force in (1.0, 2.0, 1.0):
        assert heard.take("/arm", force=force)["tank.contradiction"] is False
    assert heard.running.observed()["tank.both"].edges[0].records == 3


def test_each_edge_says_what_has_passed_it(tmp_path: Path) -> None:
    resource = """
topics:
  /arm:
    type: tank_msgs/msg/Arm
    direction: in
    pipeline:
      - filter: force < 100.0
      - expression: {strong: force > 1.5}
      - limit: {every: 1.0}
measured: {strong: {type: bool}, moving: {type: bool}}
"""
    heard = Heard(station_with(tmp_path, resource, FIELDS))
    for now, force in enumerate((1.0, 500.0, 2.0)):
        heard.take("/arm", now / 10, force=force)
    view = heard.running.observed()["/arm"]
    assert [(edge.to, edge.records, edge.held, edge.at) for edge in view.edges] == [
        ("1 filter", 3, 1, 0.2),
        ("2 expression", 2, 0, 0.2),
        ("3 limit", 2, 1, 0.2),
        ("tank.strong, tank.moving", 1, 0, 0.0),
    ]
    assert [(edge.last or {}).get("strong") for edge in view.edges] == [None, None, True, False]
    assert heard.running.due == 1.0
    assert heard.wake(1.0)["tank.strong"] is True
    assert heard.running.observed()["/arm"].edges[-1].records == 2


def test_a_person_sets_a_field_within_bounds_for_a_while(tmp_path: Path) -> None:
    resource = """
topics:
  /arm:
    type: tank_msgs/msg/Arm
    direction: in
    pipeline:
      - override: {name: test, fields: {force: {between: [0, 5]}}, expires: 10}
      - expression: {strong: force > 1.5}
measured: {strong: {type: bool}, moving: {type: bool}}
"""
    heard = Heard(station_with(tmp_path, resource, FIELDS))
    assert heard.take("/arm", 0.0, force=1.0)["tank.strong"] is False
    heard.running.set_override("/arm", "test", {"force": 3.0}, 1.0, "eva")
    assert heard.known()["tank.strong"] is True
    overrides = heard.running.observed()["/arm"].overrides
    assert overrides["test"] is not None
    assert (overrides["test"].actor, overrides["test"].until) == ("eva", 11.0)
    with pytest.raises(ValueError, match="force"):
        heard.running.set_override("/arm", "test", {"force": 6.0}, 2.0, "bob")
    heard.running.forget("/arm")
    assert heard.take("/arm", 5.0, force=1.0)["tank.strong"] is True, "what a person set outlasts silence"
    assert heard.wake(11.0)["tank.strong"] is False
    heard.running.set_override("/arm", "test", {"force": 3.0}, 12.0, "eva")
    heard.running.clear_override("/arm", "test", 13.0)
    assert heard.known()["tank.strong"] is False


@pytest.mark.parametrize(
    ("flows", "said"),
    [
        (
            "one: {from: /arms}",
            ["there is no topic or flow `/arms`; did you mean `/arm`?"],
        ),
        ("one: {from: {a: /arm, b: /arms}}\n  # from\n  two: {from: one}", ["there is no topic or flow `/arms`;"]),
        ("one: {from: {a b: /arm}}", ["`a b` is no name for a source: use letters, digits and _"]),
        ("one: {from: [/arm, /arm]}", ["`/arm` is a source of this flow already"]),
        ("one: {from: two}\n  two: {from: one}", [
            "`tank.one` comes from itself: tank.one → tank.two → tank.one",
        ]),
        ("one: {from: /go}", ["`/go` is an outgoing topic: a flow comes of incoming topics and other flows"]),
        ("one: {from: /arm}", ["`one` feeds no variable: no field bears the name of a measured variable"]),
        (
            "one: {from: /arm, pipeline: [expression: {strongg: force > 1.5}]}",
            [
                "`one` → stage 1 `expression`: `tank` has no measured variable `strongg`, and no later stage reads it; "
                "did you mean `strong`?",
            ],
        ),
        (
            "one: {from: {a: /arm}, pipeline: [expression: {strong: b.force > 1.5}]}",
            ["`one` → stage 1 `expression`: "],
        ),
        ("one: {from: /arm, pipeline: [expression: {strong: force}]}", [
            "`one` → stage 1 `expression`: field `strong` is real, and `tank.strong` is bool: they do not correspond",
        ]),
    ],
)  # fmt: skip
def test_flows_that_do_not_fit_are_said_where_they_stand(tmp_path: Path, flows: str, said: list[str]) -> None:
    resource = f"""
topics:
  /arm: {{type: tank_msgs/msg/Arm, direction: in}}
  /go: {{type: std_msgs/msg/Bool, direction: out}}
flows:
  {flows}
measured: {{strong: {{type: bool}}, moving: {{type: bool}}}}
output: {{data: {{type: bool}}}}
"""
    with pytest.raises(ModelError) as refused:
        station_with(tmp_path, resource, FIELDS)
    findings = refused.value.findings
    assert len(findings) == len(said)
    for text in said:
        assert any(finding.message.startswith(text) for finding in findings), findings
    lines = resource.splitlines()
    assert all("from" in lines[finding.place.line - 1] for finding in findings)


def test_every_flow_stands_behind_its_sources(station: ReadyStation) -> None:
    pipelines: StationPipelines = station.pipelines
    placed = set(pipelines.incoming)
    for name, flow in pipelines.flows.items():
        assert placed.issuperset(flow.sources.values())
        placed.add(name)
    assert pipelines.topics_of("tank.surely") == {"/scene", "/left"}
