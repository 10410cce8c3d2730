"""What is suspicious in the documents themselves: names that nothing uses, and quantifiers that say nothing."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from editor.shorthand import SHORTHAND
from sequence_planner.station import prepare_station
from support.places import MODELS

NOTHING = "nothing uses the {} `{}`: leave it out, or use it [never-used]"


@pytest.fixture
def press(tmp_path: Path) -> Path:
    """A station in which all that it says for short is used."""
    for file, text in SHORTHAND.items():
        path = tmp_path / file
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path


def said(station: Path) -> list[str]:
    """What is suspicious in the station as it is written, with places in its folder."""
    return [str(each).replace(f"{station}/", "") for each in prepare_station(station).suspicions()]


def changed(station: Path, file: str, *changes: tuple[str, str]) -> list[str]:
    """The places of the marks ‹ in what is written instead, and what is suspicious then."""
    text = (station / file).read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    places = []
    while (at := text.find("‹")) >= 0:
        above = text[:at].split("\n")
        places.append(f"{file}:{len(above)}:{len(above[-1]) + 1}")
        text = text[:at] + text[at + 1 :]
    (station / file).write_text(text, encoding="utf-8")
    return places


def test_nothing_is_said_where_everything_is_used(press: Path) -> None:
    assert said(press) == []


@pytest.mark.parametrize(
    ("section", "declared", "what"),
    [
        ("sets:\n", "  ‹spare: {of: part, values: [p1]}\n", "set"),
        ("relations:\n", "  ‹spare: {between: [grip, state], pairs: [[big, tight]]}\n", "relation"),
        ("maps:\n", "  ‹spare: {from: grip, to: bool, otherwise: false}\n", "map"),
        ("predicates:\n", "  ‹spare: goal == home\n", "predicate"),
    ],
)
@pytest.mark.parametrize("file", ["station.yaml", "resources/arm.yaml"])
def test_a_name_of_the_station_or_a_resource_that_nothing_uses(
    press: Path, file: str, section: str, declared: str, what: str
) -> None:
    declared = declared if file == "station.yaml" else declared.replace("goal == home", "at == home")
    [place] = changed(press, file, (section, section + declared))
    assert said(press) == [f"{place}: warning: {NOTHING.format(what, 'spare')}"]


def test_a_set_with_a_title_is_used_by_sentences(press: Path) -> None:
    changed(press, "station.yaml", ("sets:\n", "sets:\n  spare: {of: part, values: [p1], title: a spare}\n"))
    assert said(press) == []


def test_a_predicate_of_a_resource_that_nothing_uses(press: Path) -> None:
    """One of the station that has its name is another one."""
    changed(
        press,
        "station.yaml",
        ("predicates:\n", "predicates:\n  is_away: goal == out\n"),
        ("and all_tight'", "and all_tight and is_away'"),
    )
    [place] = changed(press, "resources/arm.yaml", ("predicates:\n", "predicates:\n  ‹is_away: at == out\n"))
    assert said(press) == [f"{place}: warning: {NOTHING.format('predicate', 'is_away')}"]
    changed(press, "operations.yaml", ("arm.is_at(home)", "arm.is_at(home) and arm.is_away"))
    assert said(press) == []


def test_a_title_is_no_use(press: Path) -> None:
    [place] = changed(
        press,
        "station.yaml",
        ("sets:\n", "sets:\n  ‹spare: {of: part, values: [p1]}\n"),
        ("title: Stuck", "title: No spare part"),
    )
    assert said(press) == [f"{place}: warning: {NOTHING.format('set', 'spare')}"]


def test_a_predicate_of_a_type_is_used_where_one_instance_uses_it(tmp_path: Path) -> None:
    robots = Path(shutil.copytree(MODELS / "robots_with_buffer", tmp_path / "robots"))
    [place] = changed(
        robots, "types/robot.yaml", ("abilities:\n", "predicates:\n  ‹is_there: at == target\n\nabilities:\n")
    )
    assert said(robots) == [f"{place}: warning: {NOTHING.format('predicate', 'is_there')}"]
    changed(robots, "resources/robot_2.yaml", ("at == target and at != stop and", "is_there and at != stop and"))
    assert said(robots) == []


def test_a_quantifier_whose_number_leaves_nothing_open(press: Path) -> None:
    [first, second] = changed(
        press,
        "station.yaml",
        (
            "and all_tight'",
            "and all_tight and (‹at least 0 q in part: is_done(q)) and (‹at most 3 q in part: is_done(q))'",
        ),
    )
    three = "there are 3 values of `part`, so this always holds: write a smaller number"
    assert said(press) == [
        f"{first}: warning: `at least 0` always holds: write a larger number, or leave it out [always-holds]",
        f"{second}: warning: {three} [always-holds]",
    ]


def test_a_number_that_an_instance_gives_may_leave_nothing_open(tmp_path: Path) -> None:
    robots = Path(shutil.copytree(MODELS / "robots_with_buffer", tmp_path / "robots"))
    changed(
        robots,
        "types/robot.yaml",
        ("  namespace: text\n", "  namespace: text\n  fewest: {kind: number, default: 0}\n"),
        ("when: executing and at == stop", "when: 'at == stop and at least fewest q in stops: target == q'"),
    )
    assert said(robots) == []


@pytest.mark.parametrize(
    ("finish", "said_so"),
    [(1, "each run is told to be late"), (2.5, "that take no longer than usual"), (3, None), (30, None)],
)
def test_a_time_limit_that_is_shorter_than_what_it_usually_takes(
    tmp_path: Path, finish: float, said_so: str | None
) -> None:
    """It is told once of all instances of an ability, where that is written."""
    station = tmp_path / "single_bolt"
    shutil.copytree(MODELS / "single_bolt", station)
    [place] = changed(
        station,
        "resources/robot.yaml",
        ("\n  move_to:", "\n  ‹move_to:"),
        (
            "timeouts: {react: 2, finish: 30}\n    duration: [2, 3]",
            f"timeouts: {{finish: {finish}}}\n    duration: [2, 3]",
        ),
    )
    found = [each for each in said(station) if each.endswith("[too-late]")]
    if said_so is None:
        assert found == []
    else:
        [only] = found
        assert only.startswith(
            f"{place}: warning: `robot.move_to` usually takes 2 to 3 s and must finish within {finish:g} s"
        )
        assert said_so in only
