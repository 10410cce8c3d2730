"""A chain shows whatever was done to it."""

from __future__ import annotations

import json
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.journal.hash_chain import START, ChainPosition, broken_at, digest
from sequence_planner.journal.run_journal import RunRecord

CONTENTS = st.dictionaries(st.text(), st.floats(allow_nan=False) | st.text() | st.none(), max_size=3).map(json.dumps)
HAPPENED = st.lists(
    st.tuples(st.floats(allow_nan=False, allow_infinity=False), st.text(min_size=1, max_size=40), CONTENTS),
    min_size=1,
    max_size=6,
)


def _chain(happened: list[tuple[float, str, str]], begin: ChainPosition = START) -> list[RunRecord]:
    records: list[RunRecord] = []
    last = begin
    for time, kind, content in happened:
        record = RunRecord(last.number + 1, time, kind, content, "")
        records.append(replace(record, hash=digest(last.hash, record.text())))
        last = _end(records)
    return records


def _end(records: list[RunRecord]) -> ChainPosition:
    return ChainPosition(records[-1].number, records[-1].hash)


@given(HAPPENED)
def test_what_was_written_is_whole_and_each_line_says_it(happened: list[tuple[float, str, str]]) -> None:
    records = _chain(happened)
    assert broken_at(records, START, _end(records)) is None
    for record in records:
        said = json.loads(record.line())
        assert said == {
            "number": record.number,
            "time": record.time,
            "kind": record.kind,
            "content": json.loads(record.content),
            "hash": record.hash,
        }


@given(HAPPENED, st.data())
def test_a_record_that_was_changed_is_named(happened: list[tuple[float, str, str]], data: st.DataObject) -> None:
    records = _chain(happened)
    place = data.draw(st.integers(0, len(records) - 1))
    old = records[place]
    changed = data.draw(
        st.builds(replace, st.just(old), time=st.floats(allow_nan=False))
        | st.builds(replace, st.just(old), kind=st.text(min_size=1, max_size=40))
        | st.builds(replace, st.just(old), content=CONTENTS)
        | st.builds(replace, st.just(old), hash=st.text("0123456789abcdef", min_size=64, max_size=64))
        | st.builds(replace, st.just(old), number=st.integers())
    )
    found = broken_at([*records[:place], changed, *records[place + 1 :]], START, _end(records))
    # 0.0 and -0.0 are equal, and read differently.
    assert found == (None if changed.line() == old.line() else old.number)


@given(HAPPENED, st.data())
def test_what_is_missing_or_stands_elsewhere_is_named(
    happened: list[tuple[float, str, str]], data: st.DataObject
) -> None:
    records = _chain(happened)
    place = data.draw(st.integers(0, len(records) - 1))
    assert broken_at([*records[:place], *records[place + 1 :]], START, _end(records)) == place + 1
    assert broken_at([*records[: place + 1], *records[place:]], START, _end(records)) == place + 2
    assert broken_at(records, START, None) == len(records) + 1


@given(HAPPENED, HAPPENED)
def test_a_chain_goes_on_behind_what_was_cut_off(
    cut: list[tuple[float, str, str]], left: list[tuple[float, str, str]]
) -> None:
    begin = _end(_chain(cut))
    records = _chain(left, begin)
    assert broken_at(records, begin, _end(records)) is None
    assert broken_at(records, ChainPosition(begin.number, "another"), _end(records)) == begin.number + 1
    assert broken_at(records[1:], begin, _end(records)) == begin.number + 1


def test_a_kind_cannot_take_a_part_of_the_content_for_itself() -> None:
    whole = _chain([(1.0, "a", '{"b":1,"content":{"c":"x","content":1}}')])[0]
    text = whole.text()
    split = text.rindex('","content":')
    start = text.index('"kind":"') + len('"kind":"')
    moved = replace(whole, kind=text[start:split], content=text[split + len('","content":') :])
    assert broken_at([moved], START, ChainPosition(1, whole.hash)) == 1
