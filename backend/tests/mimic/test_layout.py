"""Pictures made from models: everything is there once, nothing lies over anything, and all that is bound exists."""

from __future__ import annotations

from itertools import combinations, pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.automaton.automaton import Ability, Automaton, HumanTask, Kind, VariableDeclaration
from sequence_planner.automaton.findings import Findings
from sequence_planner.language.syntax import FALSE, TRUE, Assignment, Comparison, Constant, Or, Variable
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type
from sequence_planner.mimic.drawn import drawn
from sequence_planner.mimic.layout import made_from
from sequence_planner.mimic.motion import motions
from sequence_planner.mimic.picture_file import picture_file
from sequence_planner.mimic.views import Box, MimicStop, MimicView
from sequence_planner.model.mimic.documents import MimicDocument
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.station import prepare_station
from support.examples import examples
from support.places import MODELS, TRUCK_ENGINE_STATION

STATIONS = sorted(path for path in MODELS.iterdir() if (path / "station.yaml").is_file())


def overlap(one: Box, other: Box) -> bool:
    """Return whether two rectangles have a part in common."""
    return (
        one.x < other.x + other.width
        and other.x < one.x + one.width
        and one.y < other.y + other.height
        and other.y < one.y + one.height
    )


def is_within(box: Box, x: float, y: float) -> bool:
    """Return whether a point is in a rectangle."""
    return box.x <= x <= box.x + box.width and box.y <= y <= box.y + box.height


def assert_good(view: MimicView, automaton: Automaton) -> None:
    """Check what everybody who looks at a picture relies on."""
    whole = Box(x=0, y=0, width=view.width, height=view.height)
    assert sorted(each.resource for each in view.symbols if each.resource) == sorted(automaton.resources)
    for one, other in combinations(view.symbols, 2):
        assert not overlap(one.box, other.box), f"{one.name} lies over {other.name}"
    for symbol in view.symbols:
        box = symbol.box
        assert is_within(whole, box.x, box.y)
        assert is_within(whole, box.x + box.width, box.y + box.height)
        bound = {part.variable for part in symbol.parts}
        bound |= {symbol.level.variable} if symbol.level else set()
        for part in symbol.parts:
            assert set(part.looks) == {
                str(v).lower() if isinstance(v, bool) else str(v)
                for v in automaton.variables[part.variable].type.domain
            }
            assert all(is_within(box, x, y) for x, y in part.marks)
        if symbol.track is not None:
            bound |= {symbol.track.position, symbol.track.target or symbol.track.position}
            assert_good_stops(symbol.track.stops, view, symbol.name)
            names = {stop.value for stop in symbol.track.stops}
            assert {end for way in symbol.track.ways for end in way} <= names
            assert names <= set(automaton.variables[symbol.track.position].type.domain)
        assert bound <= set(automaton.variables)
    estimated = {
        name for name, each in automaton.variables.items() if each.kind is Kind.ESTIMATED and not each.resource
    }
    assert {part.variable for each in view.symbols for part in each.parts} == estimated


def assert_good_stops(stops: list[MimicStop], view: MimicView, of: str) -> None:
    """The stops of a track lie apart, in no card but their own, and their titles have the room they need."""
    assert len({(stop.x, stop.y) for stop in stops}) == len(stops)
    for stop in stops:
        covering = [each.name for each in view.symbols if is_within(each.box, stop.x, stop.y)]
        assert covering in ([], [of])
    for side in ("above", "below"):
        told = sorted((stop for stop in stops if stop.label == side), key=lambda stop: stop.x)
        for one, other in pairwise(told):
            assert one.x + one.room / 2 <= other.x - other.room / 2 + 1e-6


def drawn_from_its_file(view: MimicView, automaton: Automaton) -> MimicView:
    """The picture of the file that is written of another one, which can be read and draws all it binds."""
    document = MimicDocument.model_validate(read_text(picture_file(view), "mimic.yaml").content)
    return drawn(automaton, document, {}, Findings())


@pytest.mark.parametrize("path", STATIONS, ids=lambda path: path.name)
def test_the_file_to_begin_with_draws_what_is_made_from_the_model(path: Path) -> None:
    """Who draws the picture themselves begins with the one that is there; so it can be said in the file."""
    automaton = prepare_station(path).automaton
    view = made_from(automaton)
    assert drawn_from_its_file(view, automaton) == view.model_copy(update={"made_from": "file"})


@pytest.mark.parametrize("path", STATIONS, ids=lambda path: path.name)
def test_every_station_has_a_good_picture(path: Path) -> None:
    """Also those that have one drawn by hand."""
    automaton = prepare_station(path).automaton
    view = made_from(automaton)
    assert_good(view, automaton)
    assert made_from(automaton) == view


def test_poses_are_joined_as_the_robot_may_move() -> None:
    """A pair of bolts is reached from above the engine alone, so it is a branch of that, above its part."""
    automaton = prepare_station(TRUCK_ENGINE_STATION).automaton
    [agv, robot] = sorted(motions(automaton), key=lambda each: each.resource)
    assert (agv.position, agv.target, agv.stops) == ("agv.act_pos", "agv.ref_pos", ("kitting", "station"))
    assert robot.previous == "robot.previous_pose"
    assert robot.neighbours("AtBoltPair3TCPPose") == ("AboveEngineTCPPose",)
    assert robot.neighbours("AttachLFToolTCPPose") == ("PreAttachLFToolFarJOINTPose",)
    assert "HomeJOINTPose" in robot.neighbours("AboveKitJOINTPose")
    view = made_from(automaton)
    track = next(each.track for each in view.symbols if each.name == "robot")
    assert track is not None
    stops = {stop.value: stop for stop in track.stops}
    assert {name for name, stop in stops.items() if not stop.branch} == {
        "HomeJOINTPose",
        "AboveEngineTCPPose",
        "PRE_OF_1_UNTIGHTENED",
        "AboveKitJOINTPose",
        "PreAttachAtlasFarJOINTPose",
        "PreAttachLFToolFarJOINTPose",
        "PreAttachOFToolFarJOINTPose",
    }
    parts = {part.variable: part for each in view.symbols for part in each.parts}
    for number in range(1, 7):
        pose = f"AtBoltPair{number}TCPPose"
        part = parts[f"bolts[{pose}]"]
        assert part.label == str(number)
        assert part.marks[0][0] == pytest.approx(stops[pose].x)


LOOSE: st.SearchStrategy[Type] = st.sampled_from([BOOLEAN, IntegerRange(0, 3)])
NAMES = st.text("abcdefghij_", min_size=1, max_size=80)
OF: tuple[Type, ...] = (BOOLEAN, IntegerRange(0, 3))


@st.composite
def stations(draw: st.DrawFn) -> Automaton:
    """Up to 40 resources, some of which move, and a product of up to 60 parts, with names of up to 80 characters."""
    resources = draw(st.lists(NAMES, min_size=1, max_size=40, unique=True))
    variables: dict[str, VariableDeclaration] = {}
    abilities: dict[str, Ability] = {}

    def declare(name: str, of: Type, kind: Kind, of_whom: str | None) -> Variable:
        variables[name] = VariableDeclaration(name, of, kind, of.domain[0], of_whom)
        return Variable(name, of)

    pairs = tuple(f"pair_{number}" for number in range(draw(st.integers(0, 30))))
    for pair in pairs:
        declare(f"bolts[{pair}]", EnumerationType(("empty", "placed", "tight")), Kind.ESTIMATED, None)
    for number in range(draw(st.integers(0, 30))):
        declare(f"{draw(NAMES)}_{number}", draw(LOOSE), Kind.ESTIMATED, None)
    for resource in resources:
        kind = draw(st.sampled_from(("still", "person", "moves", "level")))
        if kind == "level":
            declare(f"{resource}.fill", IntegerRange(0, 5), Kind.MEASURED, resource)
        if kind == "person":
            task = HumanTask("do", f"{resource}.done")
            abilities[f"{resource}.do"] = Ability(
                f"{resource}.do", resource, "Do", TRUE, TRUE, (), FALSE, FALSE, None, (), human=task
            )
        if kind == "moves":
            own = tuple(f"stop_{number}" for number in range(draw(st.integers(2, 30))))
            stops = EnumerationType((*own, *pairs) if draw(st.booleans()) else own)
            at = declare(f"{resource}.at", EnumerationType(("between", *stops.values)), Kind.MEASURED, resource)
            to = declare(f"{resource}.to", stops, Kind.OUTPUT, resource)
            for stop in stops.values:
                from_ = draw(st.lists(st.sampled_from(stops.values), max_size=4, unique=True))
                near = [Comparison("==", at, Constant(each)) for each in from_]
                enabled = Or(tuple(near)) if len(near) > 1 else near[0] if near else TRUE
                name = f"{resource}.go({stop})"
                abilities[name] = Ability(
                    name,
                    resource,
                    "Go",
                    enabled,
                    TRUE,
                    (Assignment(to, Constant(stop)),),
                    FALSE,
                    FALSE,
                    Comparison("==", at, Constant(stop)),
                    (),
                )
    titles = {each: draw(st.sampled_from((each, "Robot", "AGV", "Kamera", "a" * 80))) for each in resources}
    return Automaton("station", "Station", "", titles, variables, abilities, ())


@given(stations())
@examples(200)
def test_any_station_has_a_good_picture(automaton: Automaton) -> None:
    """Whatever it is made of."""
    assert_good(made_from(automaton), automaton)


@given(stations())
@examples(200)
def test_any_picture_made_from_a_model_can_be_written_as_a_file(automaton: Automaton) -> None:
    """With names and numbers of stops and parts as they come; nothing of it is left out or drawn elsewhere."""
    view = made_from(automaton)
    assert drawn_from_its_file(view, automaton) == view.model_copy(update={"made_from": "file"})


def test_a_resource_may_be_called_product() -> None:
    """Each thing of a picture has a name of its own."""
    variables = {"tight": VariableDeclaration("tight", BOOLEAN, Kind.ESTIMATED, False, None)}
    automaton = Automaton("station", "Station", "", {"product": "Product"}, variables, {}, ())
    assert sorted(each.name for each in made_from(automaton).symbols) == ["product", "product_2"]
