"""Relations and maps of a resource, of a type of resources and of a package are like those of the station."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed, usages
from sequence_planner.language.evaluator import evaluate
from sequence_planner.model.loader import load_station
from sequence_planner.station import ReadyStation, prepare_station, read_station
from support.places import MODELS
from support.station import finished

from .breaking import findings, write

FILES = {
    "station.yaml": "name: carts\nenumerations:\n  low: [rack, door, oven]\n  high: [shelf, lift]\n",
    "types/cart.yaml": """\
parameters:
  namespace: text
  stops: enumeration
  base: {kind: value, of: stops}
  turn: {kind: value, of: stops}
topics:
  /{namespace}/command:
    type: carts_msgs/msg/Command
    direction: out
    pipeline:
      - map: {field: code, variable: go_to, values: code_of}
      - table: {fields: [go_to, last], variables: [slow], rows: [{when: beside, gives: [true]}], otherwise: [false]}
relations:
  beside: {between: [stops, stops], symmetric: true, pairs: [[base, turn]]}
maps:
  code_of: {from: stops, to: 0..9, values: {base: 1, turn: 4}, otherwise: 7}
output: {go_to: {type: stops}}
estimated: {last: {type: stops}}
abilities:
  drive:
    parameters: {stop: stops}
    enabled: beside(go_to, stop) and code_of[stop] > 1
    start: {do: [go_to := stop, last := go_to]}
""",
    "resources/one.yaml": "type: cart\narguments: {namespace: one, stops: low, base: rack, turn: door}\n",
    "resources/two.yaml": "type: cart\narguments: {namespace: two, stops: high, base: lift, turn: shelf}\n",
    "specifications.yaml": "apart:\n  forbidden: one.beside(one.go_to, one.last) and two.code_of[two.go_to] == 4\n",
    "messages/carts_msgs/msg/Command.msg": "uint8 code\nbool slow\n",
}


def carts(folder: Path, **changes: tuple[str, str]) -> Path:
    """The station of two carts of one type, with something else in some of its files."""
    for name, text in FILES.items():
        old, new = changes.get(Path(name).stem, ("", ""))
        assert old in text
        write(folder, name, text.replace(old, new) if old else text)
    return folder


@pytest.fixture(scope="module")
def ready(tmp_path_factory: pytest.TempPathFactory) -> ReadyStation:
    """It is made once."""
    return prepare_station(carts(tmp_path_factory.mktemp("carts")))


def test_each_instance_has_its_own(ready: ReadyStation) -> None:
    state = ready.automaton.initial_valuation
    may = {name: evaluate(each.enabled, state) for name, each in ready.automaton.abilities.items()}
    # One stands at the rack, which is beside its door; two at its shelf, beside its lift, of which the code is 1.
    assert {name for name, allowed in may.items() if allowed} == {"one.drive(door)"}
    forbidden = ready.automaton.specifications["apart"].forbidden
    beside = {**state, "one.go_to": "door", "one.last": "rack"}
    assert evaluate(forbidden, beside) is True  # two is at the shelf, which has the code 4
    assert evaluate(forbidden, {**beside, "two.go_to": "lift"}) is False
    assert evaluate(forbidden, {**beside, "one.last": "oven"}) is False


def test_its_pipelines_have_them(ready: ReadyStation) -> None:
    coding, slow = ready.pipelines.outgoing["/two/command"].chain.stages
    assert [coding.meaning(each) for each in ("lift", "shelf")] == [1, 4]  # type: ignore[attr-defined]
    pairs = [(one, other) for one in ("lift", "shelf") for other in ("lift", "shelf")]
    assert [slow.meaning(pair)[0] for pair in pairs] == [False, True, True, False]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("[[base, turn]]", "[[base, trun]]", 14, "`trun` is no value of {rack, door, oven} and no set"),
        ("beside(go_to, stop)", "besid(go_to, stop)", 22, "unknown variable `besid(go_to, stop)`"),
        ("code_of[stop]", "beside(stop)", 22, "`beside` has 2 arguments, found 1"),
        ("values: code_of}", "values: code_for}", 11, "there is no map `code_for`: `maps` of station.yaml or of the "
         "resource declares them; did you mean `code_of`?"),
        (", otherwise: 7}", "}", 16, "`code_of` says nothing for `oven`: add it, or `otherwise`"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_in_the_type(tmp_path: Path, old: str, new: str, line: int, message: str) -> None:
    found = findings(carts(tmp_path, cart=(old, new)))
    assert any(f"types/cart.yaml:{line}:" in each and message in each for each in found), found


def test_they_are_renamed_where_they_are_named() -> None:
    files = {
        "station.yaml": "name: gates\nenumerations: {side: [left, right]}\n",
        "resources/gate.yaml": (
            "relations: {across: {between: [side, side], pairs: [[left, right]]}}\n"
            "maps: {other: {from: side, to: side, values: {left: right, right: left}}}\n"
            "output: {at: {type: side}}\nabilities: {move: {enabled: 'across(at, other[at])'}}\n"
        ),
        "specifications.yaml": "never:\n  forbidden: gate.across(gate.at, gate.other[gate.at])\n",
    }
    for part, new in (("relation:gate.across", "facing"), ("map:gate.other", "opposite")):
        old = part.rpartition(".")[2]
        assert len(usages(files, parse_part(part)).found) == 3
        assert renamed(files, parse_part(part), new) == {
            name: text.replace(old, new) for name, text in files.items() if old in text
        }


SHARED = """\
name: places
version: "1.0"
enumerations: {place: [between, infeed, buffer, outfeed]}
sets: {stops: {of: place, except: [between]}}
relations: {linked: {between: [stops, stops], symmetric: true, pairs: [[buffer, [infeed, outfeed]]]}}
maps: {is_end: {from: place, to: bool, values: {infeed: true, outfeed: true}, otherwise: false}}
predicates: {linked_to_end: {parameters: {where: stops}, when: "any s in stops: linked(where, s) and is_end[s]"}}
"""


@pytest.fixture
def with_package(tmp_path: Path) -> Path:
    """The station of two robots, whose places are in a package with what is known of them."""
    station = Path(shutil.copytree(MODELS / "robots_with_buffer", tmp_path / "station"))
    write(tmp_path, "shared/package.yaml", SHARED)
    text = (station / "station.yaml").read_text()
    without = text[: text.index("  place:\n")] + text[text.index("\n# No sensor sees the buffer") :]
    (station / "station.yaml").write_text(f"{without}\npackages:\n  places: {{path: ../shared}}\n")
    assert finished("packages", "fetch", str(station)).returncode == 0
    return station


def test_what_a_package_declares_is_known_in_the_station(with_package: Path) -> None:
    write(with_package, "specifications.yaml", "x:\n  forbidden: linked_to_end(buffer) and not is_end[robot_1.at]\n")
    document = load_station(with_package).station
    assert {"stops"} == set(document.sets) and {"linked"} == set(document.relations)
    forbidden = read_station(with_package).automaton.specifications["x"].forbidden
    state = read_station(with_package).automaton.initial_valuation
    assert [evaluate(forbidden, {**state, "robot_1.at": at}) for at in ("infeed", "between", "outfeed")] == [
        False, True, False,
    ]  # fmt: skip


def test_two_of_one_name_are_refused_with_both_places(with_package: Path) -> None:
    text = (with_package / "station.yaml").read_text()
    own = "relations: {linked: {between: [place, place], pairs: [[infeed, buffer]]}}\n"
    (with_package / "station.yaml").write_text(own + text)
    assert any("duplicate name `linked`, first declared at" in each for each in findings(with_package))
