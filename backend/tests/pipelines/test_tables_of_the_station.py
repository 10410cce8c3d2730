"""Maps and relations of a station are the tables of stages: written once, the same in a pipeline and in a guard."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from pathlib import Path

import pytest

from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.types import Value
from sequence_planner.model.source import ModelError
from sequence_planner.pipelines.chain_runtime import RunningOutgoing
from sequence_planner.station import ReadyStation, prepare_station

from .station_writing import Heard, write_station

MESSAGES = {
    "State": "string word\nuint8 code\nfloat64 level\nint16 height\n",
    "Command": "uint8 code\nint16 height\nbool far\nstring word\n",
}
ENUMERATIONS = "drive: [manual, automatic, off]\nstop: [store, bench]\nplace: [between, store, bench]"
STATION = """
maps:
  code_of: {from: drive, to: 0..9, values: {manual: 1, automatic: 4}, otherwise: 7}
  height_of: {from: stop, to: -200..400, values: {store: -120, bench: 300}}
  other: {from: stop, to: stop, values: {store: bench, bench: store}}
  in_use: {from: drive, to: bool, values: {manual: true, automatic: true, off: false}}
relations:
  far: {between: [place, stop], pairs: [[store, bench], [bench, store], [between, stop]]}
"""
TOPICS = """
topics:
  /tank/state:
    type: tank_msgs/msg/State
    direction: in
    pipeline:
      - map: {field: code, variable: now, values: code_of}
      - discretise: {field: height, variable: at, values: height_of, tolerance: 5, otherwise: between}
      - map: {field: word, variable: opposite, values: other}
  /tank/command:
    type: tank_msgs/msg/Command
    direction: out
    pipeline:
      - map: {field: code, variable: wanted, values: code_of}
      - undiscretise: {field: height, variable: goal, values: height_of}
      - table:
          fields: [at, goal]
          variables: [far]
          rows: [{when: far, gives: [true]}]
          otherwise: [false]
measured:
  now: {type: drive}
  at: {type: place, initial: store}
  opposite: {type: stop}
output:
  wanted: {type: drive}
  goal: {type: stop}
abilities:
  go:
    parameters: {where: stop}
    enabled: far(at, where) and in_use[wanted]
    start: {do: ["goal := other[where]"]}
"""


def tank(folder: Path, topics: str = TOPICS) -> Path:
    """The cell with a tank whose pipelines have tables of the station."""
    station = write_station(folder, topics, MESSAGES, ENUMERATIONS)
    with (station / "station.yaml").open("a", encoding="utf-8") as file:
        file.write(STATION)
    return station


@pytest.fixture(scope="module")
def ready(tmp_path_factory: pytest.TempPathFactory) -> ReadyStation:
    """It is made once."""
    return prepare_station(tank(tmp_path_factory.mktemp("tables")))


def sent(ready: ReadyStation, values: Mapping[str, Value | None]) -> Mapping[str, object]:
    """What a command says for these values of the variables."""
    state = {**ready.automaton.initial_valuation, **{f"tank.{name}": value for name, value in values.items()}}
    message = RunningOutgoing(ready.pipelines.outgoing["/tank/command"]).take(state, 0.0)
    assert message is not None
    return message


def test_a_map_is_read_backwards_where_a_message_has_what_it_is_to(ready: ReadyStation) -> None:
    heard = Heard(ready)
    for code, meant in ((1, "manual"), (4, "automatic"), (7, "off"), (5, None)):
        known = heard.take("/tank/state", code=code, word="store", height=0)
        assert (known["tank.now"], known["tank.opposite"]) == (meant, "bench")


def test_a_map_to_numbers_has_the_points_of_both_directions(ready: ReadyStation) -> None:
    heard = Heard(ready)
    for height, meant in ((-117, "store"), (300, "bench"), (0, "between"), (306, "between")):
        assert heard.take("/tank/state", code=1, word="store", height=height)["tank.at"] == meant


def test_what_is_sent_and_what_a_guard_asks_are_the_same_table(ready: ReadyStation) -> None:
    codes, heights = {"manual": 1, "automatic": 4, "off": 7}, {"store": -120, "bench": 300}
    for wanted, at, goal in product(codes, ("between", "store", "bench"), heights):
        message = sent(ready, {"wanted": wanted, "at": at, "goal": goal})
        assert (message["code"], message["height"]) == (codes[wanted], heights[goal])
        state = {**ready.automaton.initial_valuation, "tank.at": at, "tank.goal": goal, "tank.wanted": "manual"}
        enabled = ready.automaton.abilities[f"tank.go({goal})"].enabled
        assert evaluate(enabled, state) is message["far"] is (at != goal)


INCOMING = "topics:\n  /tank/state: {{type: tank_msgs/msg/State, direction: in, pipeline: [{}]}}\nmeasured: {{{}}}\n"
OUTGOING = "topics:\n  /tank/command: {{type: tank_msgs/msg/Command, direction: out, pipeline: [{}]}}\noutput: {{{}}}\n"


@pytest.mark.parametrize(
    ("form", "stage", "variable", "said"),
    [
        (INCOMING, "map: {field: word, variable: now, values: ‹code_off}", "now: {type: drive}",
         "there is no map `code_off`: `maps` of station.yaml or of the resource declares them; did you mean "
         "`code_of`?"),
        (INCOMING, "map: {field: word, variable: now, values: ‹in_use}", "now: {type: stop}",
         "`in_use` is from {manual, automatic, off} to bool, and fits neither way round (`word`: text, `now`: "
         "{store, bench})"),
        (OUTGOING, "map: {field: word, variable: using, values: ‹in_use}", "using: {type: bool}",
         "`in_use` has `true` for both `manual` and `automatic`, so it cannot be read backwards here: give each a "
         "value of its own"),
        (INCOMING, "discretise: {field: height, variable: at, values: ‹other, tolerance: 1, otherwise: between}",
         "at: {type: place}", "`other` is to {store, bench}, and a point is a number: take a map to a range such as "
         "0..360, or write the coordinates here"),
        (OUTGOING, "table: {fields: [goal], variables: [far], rows: [{when: ‹far, gives: [true]}]}",
         "goal: {type: stop}", "the relation `far` is between two fields, and the table has 1"),
        (OUTGOING, "table: {fields: [goal, goal], variables: [far], rows: [{when: ‹near, gives: [true]}]}",
         "goal: {type: stop}",
         "there is no relation `near`: `relations` of station.yaml or of the resource declares them; did you mean "
         "`far`?"),
        (OUTGOING, "table: {fields: [wanted, wanted], variables: [far], rows: [{when: ‹far, gives: [true]}]}",
         "wanted: {type: drive}", "`far` is between {between, store, bench} and {store, bench}, and no pair fits "
         "the fields (`wanted`: {manual, automatic, off}, `wanted`: {manual, automatic, off})"),
    ],
)  # fmt: skip
def test_a_table_that_does_not_fit_is_refused_where_it_is_named(
    tmp_path: Path, form: str, stage: str, variable: str, said: str
) -> None:
    text = form.format(stage, variable)
    station = tank(tmp_path, text.replace("‹", ""))
    with pytest.raises(ModelError) as error:
        prepare_station(station)
    line = text.splitlines()[1]
    found = [each for each in error.value.findings if said in each.message]
    assert [(each.place.line, each.place.column) for each in found] == [(2, line.index("‹") + 1)], error.value
