"""Titles of variables, values, sets and predicates: what they give, and what is wrong with them."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
from pydantic import TypeAdapter

from editor.shorthand import SHORTHAND
from sequence_planner.automaton.findings import title_of
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.language.types import EnumerationType
from sequence_planner.model.loader import load_station
from sequence_planner.texts.message import Message, Title, message

from .breaking import findings, replace, write

STATION = "station.yaml"


@pytest.fixture
def press(tmp_path: Path) -> Path:
    """A station with names for what is said more than once."""
    for file, text in SHORTHAND.items():
        write(tmp_path, file, text)
    return tmp_path


TITLED = (
    (
        "state: [empty, placed, tight]",
        "state: {values: [empty, placed, tight], titles: {tight: {en: firm, sv: fast}, empty: {en: open}}}",
    ),
    (
        "bolts: {for: {where: part}, type: state, initial: empty}",
        'bolts: {for: {where: part}, type: state, initial: empty, title: "{where}", phrase: "bolt {where} is {value}"}',
    ),
    (
        "part: {values: [p1, p2, p3], ordered: true}",
        "part: {values: [p1, p2, p3], ordered: true, titles: {p1: one, p2: two}}",
    ),
    ("free: {of: spot, values: [home, out]}", "free: {of: spot, values: [home, out], title: {en: a free spot}}"),
    ("goal: {type: spot, initial: home}", "goal: {type: spot, initial: home, titles: {out: {en: far away}}}"),
)


@pytest.fixture
def titled(press: Path) -> Path:
    """The same with titles."""
    for old, new in TITLED:
        replace(press, STATION, old, new)
    return press


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("bolts[p1]", "tight", {"en": "bolt one is firm", "sv": "bolt one is fast"}),
        ("bolts[p3]", "empty", {"en": "bolt p 3 is open", "sv": "bolt p 3 is open"}),
        # A variable can say of a value something else than its enumeration does.
        ("goal", "out", {"en": "goal is far away", "sv": "goal är far away"}),
        ("arm.target", "out", {"en": "target is out", "sv": "target är out"}),
    ],
)  # fmt: skip
def test_titles_are_told(titled: Path, name: str, value: str, sentence: dict[str, str]) -> None:
    assert sentences_of(ground(load_station(titled))).tell_value(name, value).words == sentence


def test_it_is_told_what_a_person_does_so_that_a_measured_variable_gets_a_value(press: Path) -> None:
    said = sentences_of(ground(load_station(press)))
    assert said.tell_by_hand("arm.held", "bare") is None
    by_hand = "{bare: {en: Open the grip. Turn the key., sv: Öppna greppet. Vrid om nyckeln.}}"
    replace(press, "resources/arm.yaml", "held: {type: grip", f"held: {{by_hand: {by_hand}, type: grip")
    said = sentences_of(ground(load_station(press)))
    told = said.tell_by_hand("arm.held", "bare")
    assert told is not None
    assert told.words == {"en": "Open the grip. Turn the key.", "sv": "Öppna greppet. Vrid om nyckeln."}
    # In short by its first sentence, as it stands within another.
    called = said.call_by_hand("arm.held", "bare")
    assert called is not None
    assert called.words == {"en": "open the grip", "sv": "öppna greppet"}
    assert called.written == "see to it that arm.held is bare"
    assert said.tell_by_hand("arm.at", "home") is None
    assert said.call_by_hand("arm.at", "home") is None


def test_a_value_has_its_title_in_the_titles_of_abilities(press: Path) -> None:
    replace(
        press,
        STATION,
        "spot: [home, left, right, out]",
        "spot: {values: [home, left, right, out], titles: {out: the exit}}",
    )
    assert ground(load_station(press)).abilities["arm.move(out)"].title == "Move to the exit"


SAID = {"en": "Move to the exit", "sv": "Kör till utgången"}


@pytest.fixture
def spoken(press: Path) -> Path:
    """A station whose parts have titles in two languages."""
    values = "titles: {out: {en: the exit, sv: utgången}}"
    replace(press, STATION, "spot: [home, left, right, out]", f"spot: {{values: [home, left, right, out], {values}}}")
    replace(press, "resources/arm.yaml", 'title: "Move to {to}"', 'title: {en: "Move to {to}", sv: "Kör till {to}"}')
    return press


def test_a_part_has_its_title_in_each_language_with_what_its_parameters_are_called(spoken: Path) -> None:
    title = ground(load_station(spoken)).abilities["arm.move(out)"].title
    assert title == SAID["en"], "all that does not ask for a language has the English one"
    assert isinstance(title, Title)
    assert title.words == SAID
    assert pickle.loads(pickle.dumps(title)).words == SAID
    flag = sentences_of(ground(load_station(spoken))).tell_value("arm.move(out).executing", True)
    assert flag.words["sv"].startswith("”Kör till utgången”")


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("move", "home", "Move: home"),
        ("go_to_spot", "spot_3", "Go to spot 3"),
        ("place_bolt_pair", "bolt_pair_3", "Place bolt pair 3"),
        ("open", "open", "Open"),
    ],
)
def test_one_of_several_without_a_title_is_told_from_the_others(name: str, value: str, told: str) -> None:
    of = EnumerationType((value,))
    title = title_of(None, name, {"one": (value, of)})
    assert title == name.replace("_", " "), "what is recorded keeps the letters of the name"
    assert isinstance(title, Title)
    assert title.words == {"": title, "en": told, "sv": told}
    assert not isinstance(title_of(None, name, {}), Title)


def test_a_message_tells_a_title_in_the_language_of_who_reads_it(spoken: Path) -> None:
    told = message("waits.service", title=ground(load_station(spoken)).abilities["arm.move(out)"].title)
    assert SAID["en"] in told
    assert told.sent()["arguments"] == {"title": {"words": SAID}}
    read = TypeAdapter(Message).validate_python(told.sent())
    assert (read, read.sent()) == (told, told.sent())


def test_a_model_means_the_same_in_any_language(spoken: Path) -> None:
    automaton = ground(load_station(spoken))
    replace(spoken, "resources/arm.yaml", 'sv: "Kör till {to}"', 'sv: "Åk till {to}"')
    other = ground(load_station(spoken))
    assert automaton == other
    assert repr(automaton) == repr(other)


@pytest.mark.parametrize(
    ("title", "message"),
    [
        ('{en: "Move to {to}", sv: ‹"Kör till {too}"}', "`{too}` stands for no parameter here; did you mean `to`?"),
        ('‹"Move to {t}"', "`{t}` stands for no parameter here; did you mean `to`?"),
        ("{en: Move, ‹de: Fahren}", "`de` is not known here; did you mean `en`?"),
        ("{en: Move, sv: ‹' '}", "write a text: this one is empty"),
        ("‹[Move]", "expected a text, or one for each language: `{en: …, sv: …}`, found a list"),
        ("‹{}", "say it in one language at least: `en` or `sv`"),
    ],
)
def test_what_is_wrong_with_the_title_of_a_part_is_told_where_it_is(press: Path, title: str, message: str) -> None:
    [place] = replace(press, "resources/arm.yaml", 'title: "Move to {to}"', f"title: {title}")
    assert findings(press) == [f"{place}: {message}"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "state: [empty, placed, tight]",
            "state: {values: [empty, placed, tight], titles: {‹tigt: firm}}",
            "`tigt` is no value of `state`, which ranges over {empty, placed, tight}; did you mean `tight`?",
        ),
        (
            "state: [empty, placed, tight]",
            "state: {values: [empty, placed, tight], titles: {tight: firm, placed: ‹Firm}}",
            "`Firm` is what `tight` is called already: nobody could tell them apart; write other words for one of them",
        ),
        (
            "goal: {type: spot, initial: home}",
            "goal: {type: spot, initial: home, titles: {‹hoem: at home}}",
            "`hoem` is no value of `goal`, which ranges over {home, left, right, out}; did you mean `home`?",
        ),
        (
            "goal: {type: spot, initial: home}",
            "goal: {type: spot, initial: home, phrase: ‹the goal is set}",
            "a phrase has a place for the value: write `{value}` in it, as in `the robot is at {value}`",
        ),
        (
            "bolts: {for: {where: part}, type: state, initial: empty}",
            'bolts: {for: {where: part}, type: state, initial: empty, title: {en: ‹"bolt {wher}"}}',
            "`{wher}` stands for no parameter here; did you mean `where`?",
        ),
        (
            'title: "{which} is done"',
            'title: ‹"{wich} is done"',
            "`{wich}` stands for no parameter here; did you mean `which`?",
        ),
        (
            "goal: {type: spot, initial: home}",
            "goal: {type: spot, initial: home, title: {‹de: Ziel}}",
            "`de` is not known here; did you mean `en`?",
        ),
        (
            "goal: {type: spot, initial: home}",
            "goal: {type: spot, initial: home, title: ‹' '}",
            "write a text: this one is empty",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_title_is_told_where_it_is(press: Path, old: str, new: str, message: str) -> None:
    [place] = replace(press, STATION, old, new)
    assert findings(press) == [f"{place}: {message}"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "held: {type: grip",
            "held: {by_hand: {‹bear: Turn the key.}, type: grip",
            "`bear` is no value of `arm.held`, which ranges over {bare, big, small}; did you mean `bare`?",
        ),
        (
            "held: {type: grip",
            'held: {by_hand: {bare: ‹"Turn {it}."}, type: grip',
            "`{it}` stands for no parameter here",
        ),
        (
            "target: {type: spot}",
            "target: {type: spot, by_hand: {‹home: Push it home.}}",
            "`by_hand` is for what is measured: nobody at the station gives `arm.target` a value",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_with_what_a_person_does_is_told_where_it_is(
    press: Path, old: str, new: str, message: str
) -> None:
    [place] = replace(press, "resources/arm.yaml", old, new)
    assert findings(press) == [f"{place}: {message}"]
