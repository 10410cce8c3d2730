"""Pictures drawn by hand: what is wrong in `mimic.yaml` is told at its place, and the rest is drawn."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from model.breaking import write
from sequence_planner.automaton.automaton import Automaton, Kind, VariableDeclaration
from sequence_planner.automaton.findings import Findings
from sequence_planner.language.types import BOOLEAN
from sequence_planner.mimic.drawn import drawn
from sequence_planner.mimic.layout import made_from
from sequence_planner.mimic.picture import picture_of
from sequence_planner.mimic.views import MimicView
from sequence_planner.model.mimic.documents import MimicDocument
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.station import prepare_station
from support.places import BOLT_TIGHTENING, MODELS

DRAWN = sorted(path.parent for path in MODELS.glob("*/mimic.yaml"))
ROBOT = "symbols:\n  arm:\n    at: [0, 0]\n    symbol: arm\n"


def view_of(folder: Path, text: str) -> tuple[MimicView, list[str], list[str]]:
    """The picture of the bolt station with this text; the places of its marks; and what `check` says of it."""
    station = Path(shutil.copytree(BOLT_TIGHTENING, folder / "station"))
    places = write(station, "mimic.yaml", text)
    ready = prepare_station(station)
    return picture_of(ready.automaton, ready.written), places, [str(each) for each in ready.suspicions()]


@pytest.mark.parametrize("path", DRAWN, ids=lambda path: path.name)
def test_the_pictures_of_our_stations_show_all_resources(path: Path) -> None:
    """And bind nothing that is not there."""
    ready = prepare_station(path)
    view = picture_of(ready.automaton, ready.written)
    assert view.made_from == "file"
    assert view.findings == []
    assert {each.resource for each in view.symbols if each.resource} == set(ready.automaton.resources)
    assert {part.variable for each in view.symbols for part in each.parts} >= {
        name for name in ready.automaton.variables if name.startswith("bolts[")
    }


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"{ROBOT}    resource: ‹robbot\n", "there is no resource `robbot`; did you mean `robot`?"),
        (f"{ROBOT}    level: ‹robot.posse\n", "there is no variable `robot.posse`; did you mean `robot.pose`?"),
        (
            f"{ROBOT}    level: ‹robot.moving\n",
            "a level shows a number, and `robot.moving` is bool",
        ),
        (f"{ROBOT}    active: {{robot.pose: ‹hom}}\n", "`robot.pose` is never `hom`; did you mean `home`?"),
        (f"{ROBOT}    visible: {{‹robot.moving: 3}}\n", "`robot.moving` is never `3`"),
        (
            f"{ROBOT}    text: [{{say: ‹'at {{robot.poze}}'}}]\n",
            "there is no variable `robot.poze`; did you mean `robot.pose`?",
        ),
        (
            f"{ROBOT}    track: {{of: robot.pose, stops: {{home: {{at: [1, 1]}}, ‹above: {{at: [9, 1]}}}}}}\n",
            "`robot.pose` is never `above`; did you mean `above_engine`?",
        ),
        (
            f"{ROBOT}    track: {{of: robot.pose, stops: {{home: {{at: [1, 1]}}}}, ways: [[home, ‹unknown]]}}\n",
            "there is no stop `unknown`",
        ),
        (f"{ROBOT}    parts: [{{of: ‹bolt, at: [9, 9]}}]\n", "there is no variable `bolt`; did you mean `bolts`?"),
        (
            f"{ROBOT}    parts: [{{of: bolts, at: [9, 9], looks: {{‹tight: done}}}}]\n",
            "`bolts` is never `tight`; did you mean `tightened`?",
        ),
        (
            f"{ROBOT}    slots: [{{at: [9, 9], title: Tool, holds: {{‹tool: true}}}}]\n",
            "there is no variable `tool`",
        ),
        (
            "size: [100, 100]\nsymbols:\n  ‹arm: {at: [90, 0]}\n",
            "`arm` lies outside the drawing, which is 100 wide and 100 high",
        ),
    ],
)
def test_what_is_not_there_is_told_and_the_rest_is_drawn(tmp_path: Path, text: str, message: str) -> None:
    """A person who looks at the station sees the picture, an engineer what is wrong with it."""
    view, [place], checked = view_of(tmp_path, text)
    [finding] = view.findings
    assert place.endswith(f"/{finding.file}:{finding.line}:{finding.column}")  # wherever the station's folder is
    assert not Path(finding.file).is_absolute()
    assert finding.message.startswith(message)
    assert [each.name for each in view.symbols] == ["arm"]
    assert [each for each in checked if each.startswith(f"{place}: warning: {message}")]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("symbols: ‹{}\n", "at least one entry"),
        ("symbols:\n  arm: {at: ‹[1]}\n", "at least 2 entries"),
        ("symbols:\n  arm: {at: [1, 1], ‹symbl: arm}\n", "`symbl` is not known here; did you mean `symbol`?"),
        ("symbols:\n  arm: {at: [1, 1], symbol: ‹robot}\n", "expected `arm`"),
        ("symbols:\n  arm: {at: [1, ‹.inf]}\n", "expected a finite number"),
        ("symbols: [\n‹", "this is not YAML"),
    ],
)
def test_a_file_without_the_form_of_a_picture_is_told_and_one_is_made_from_the_model(
    tmp_path: Path, text: str, message: str
) -> None:
    """No station stands still because of its picture."""
    view, [place], checked = view_of(tmp_path, text)
    assert view.made_from == "model"
    assert len(view.symbols) > 1
    [finding] = view.findings
    assert place.endswith(f"/{finding.file}:{finding.line}:{finding.column}")  # wherever the station's folder is
    assert not Path(finding.file).is_absolute()
    assert message in finding.message
    assert [each for each in checked if finding.message in each]


def test_parts_slots_and_ways_follow_from_what_is_written(tmp_path: Path) -> None:
    """Parts stand in rows, a pair is drawn twice, and ways that nobody wrote are those of the model."""
    view, _, _ = view_of(
        tmp_path,
        """
symbols:
  plate:
    at: [0, 0]
    size: [200, 200]
    parts: [{of: bolts, at: [20, 20], step: [30, 0], columns: 2, row: [0, 50], marks: [[0, 0], [0, 20]]}]
  arm:
    at: [210, 0]
    resource: robot
    track:
      of: robot.pose
      stops: {home: {at: [300, 10]}, above_engine: {at: [400, 10]}, bolt_pair_1: {at: [400, 60], branch: true}}
""",
    )
    plate, arm = view.symbols
    assert [part.marks for part in plate.parts] == [
        [(20, 20), (20, 40)],
        [(50, 20), (50, 40)],
        [(20, 70), (20, 90)],
    ]
    assert [part.label for part in plate.parts] == ["1", "2", "3"]
    assert plate.parts[0].looks == {"empty": "empty", "placed": "placed", "tightened": "done"}
    assert arm.track is not None
    assert arm.track.ways == [("home", "above_engine"), ("above_engine", "bolt_pair_1")]


def test_of_very_many_parts_the_first_are_drawn_and_the_rest_is_told() -> None:
    """As many as in a picture that is made from the model: more could not be told apart."""
    pairs = [f"bolts[pair_{number}]" for number in range(300)]
    variables = {name: VariableDeclaration(name, BOOLEAN, Kind.ESTIMATED, False, None) for name in pairs}
    automaton = Automaton("station", "Station", "", {}, variables, {}, ())
    text = "symbols:\n  plate:\n    at: [0, 0]\n    parts:\n      - {of: bolts, at: [20, 20], columns: 20}\n"
    document = MimicDocument.model_validate(read_text(text, "mimic.yaml").content)
    findings = Findings()
    (plate,) = drawn(automaton, document, {}, findings).symbols
    assert [part.variable for part in plate.parts] == pairs[:240]
    assert [each.message for each in findings.all] == [
        "the first 240 of the 300 parts are drawn: more could not be told apart"
    ]
    assert [part.variable for each in made_from(automaton).symbols for part in each.parts] == pairs[:240]
