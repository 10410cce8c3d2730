"""The draft in the database: shared, undone by each for themselves, and brought together with the station's files."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from sqlalchemy import Connection

from sequence_planner.core.actor import Actor
from sequence_planner.db.database import Database
from sequence_planner.editor import draft as drafts
from sequence_planner.editor.draft import ChangeKind, Draft, DraftProposal, PartChangedError, SetEntry, WriteText
from sequence_planner.editor.schemas.draft import LONGEST_TEXT, MOST_PLACES, change_view
from sequence_planner.model.paths import EditError
from support.people import ADAM, EVA

STATION, OPERATIONS = "station.yaml", "operations.yaml"
FILES = {STATION: "name: cell\ntitle: Cell\nrest: true\n", OPERATIONS: "drill:\n  goal: done\n"}


class Desk:
    """Engineers at one draft."""

    def __init__(self, database: Database) -> None:
        self._database = database
        self.now = 1000.0
        self.take_up(FILES)

    def take_up(self, files: dict[str, str]) -> None:
        self.now += 1
        with self._database.writing() as connection:
            draft = drafts.read(connection)
            if not draft.number or draft.base != files:
                assert drafts.take_up(connection, draft, files, drafts.taking_up(draft, files), self.now) is not None

    def change(self, by: Actor, propose: Callable[[Connection, Draft], DraftProposal]) -> Draft:
        self.now += 1
        with self._database.writing() as connection:
            draft = drafts.read(connection)
            changed = drafts.write(connection, draft, propose(connection, draft), by, self.now)
        assert changed is not None
        return changed

    def set(self, by: Actor, path: list[str | int], was: str | bool, value: str, file: str = STATION) -> Draft:
        edit = SetEntry(file=file, path=path, was=was, value=value)
        return self.change(by, lambda _, draft: drafts.editing(draft, [edit], f"{path[-1]} is {value}"))

    def write(self, by: Actor, file: str, was: str | None, text: str | None) -> Draft:
        edit = WriteText(file=file, was=was, text=text)
        return self.change(by, lambda _, draft: drafts.editing(draft, [edit], f"wrote {file}"))

    def undo(self, by: Actor) -> Draft:
        def propose(connection: Connection, draft: Draft) -> DraftProposal:
            done, _ = drafts.stacks(connection, by)
            return drafts.undoing(draft, done[-1], drafts.differences_of(connection, done[-1]))

        return self.change(by, propose)

    def redo(self, by: Actor) -> Draft:
        def propose(connection: Connection, draft: Draft) -> DraftProposal:
            _, undone = drafts.stacks(connection, by)
            return drafts.redoing(draft, undone[-1], drafts.differences_of(connection, undone[-1]))

        return self.change(by, propose)

    def can(self, by: Actor) -> tuple[int, int]:
        """How many changes somebody could undo, and do again."""
        with self._database.reading() as connection:
            done, undone = drafts.stacks(connection, by)
        return len(done), len(undone)

    @property
    def draft(self) -> Draft:
        with self._database.reading() as connection:
            return drafts.read(connection)

    @property
    def said(self) -> list[tuple[str, ChangeKind, str]]:
        with self._database.reading() as connection:
            return [(each.by_name, each.kind, each.title) for each in drafts.changes(connection, 50)]


@pytest.fixture
def desk(database: Database) -> Desk:
    return Desk(database)


def test_a_draft_begins_as_the_station_is(desk: Desk) -> None:
    assert desk.draft == Draft(1, FILES, FILES)
    desk.take_up(FILES)
    assert desk.draft.number == 1


def test_changes_are_kept_with_who_made_them(desk: Desk) -> None:
    desk.set(EVA, ["title"], "Cell", "A cell")
    desk.write(ADAM, "resources/robot.yaml", None, "title: Robot\n")
    assert desk.draft.files[STATION] == FILES[STATION].replace("Cell", "A cell")
    assert desk.draft.base == FILES
    assert desk.said[:2] == [
        ("Adam", ChangeKind.EDIT, "wrote resources/robot.yaml"),
        ("Eva", ChangeKind.EDIT, "title is A cell"),
    ]


def test_a_change_tells_what_it_did_and_so_does_taking_it_back(desk: Desk, database: Database) -> None:
    desk.set(EVA, ["title"], "Cell", "Robot cell")
    desk.undo(EVA)
    desk.write(EVA, OPERATIONS, FILES[OPERATIONS], None)
    with database.reading() as connection:
        told = [change_view(each, did) for each, did in drafts.accounts(connection, 3)]
    assert [[(each.file, each.line, each.was, each.now) for each in view.places] for view in told] == [
        [(OPERATIONS, 1, "drill:\n  goal: done", None)],
        [(STATION, 2, "title: Robot cell", "title: Cell")],
        [(STATION, 2, "title: Cell", "title: Robot cell")],
    ]


def test_of_a_large_change_only_its_beginning_is_told(desk: Desk, database: Database) -> None:
    lines = "".join(f"# {number} {'long ' * 100}\nline_{number}: 1\n" for number in range(2 * MOST_PLACES))
    desk.write(EVA, "resources/robot.yaml", None, lines)
    desk.write(EVA, "resources/robot.yaml", lines, lines.replace(": 1", ": 2"))
    with database.reading() as connection:
        last, first = (change_view(each, did).places for each, did in drafts.accounts(connection, 2))
    assert len(last) == MOST_PLACES
    assert last[0].now == "line_0: 2"
    assert len(first) == 1
    assert first[0].now is not None
    assert len(first[0].now) == LONGEST_TEXT + 1


def test_a_refused_change_leaves_nothing_behind(desk: Desk) -> None:
    desk.set(EVA, ["title"], "Cell", "A cell")
    before = desk.draft
    with pytest.raises(PartChangedError):
        desk.set(ADAM, ["title"], "Cell", "My cell")
    with pytest.raises(EditError, match="not there any more"):
        desk.set(EVA, ["nothing"], "", "", OPERATIONS)
    assert desk.draft == before


def test_what_was_proposed_for_another_draft_is_not_written(desk: Desk, database: Database) -> None:
    old = desk.draft
    desk.set(EVA, ["title"], "Cell", "A cell")
    proposal = drafts.editing(old, [WriteText(file=OPERATIONS, was=FILES[OPERATIONS], text="")], "emptied")
    with database.writing() as connection:
        assert drafts.write(connection, old, proposal, ADAM, 2000.0) is None
    assert desk.draft.files[OPERATIONS] == FILES[OPERATIONS]
    with database.reading() as connection:
        last = drafts.last_of(connection, STATION)
    assert last is not None
    assert (last.by_name, last.title) == ("Eva", "title is A cell")


def test_each_undoes_what_they_did_themselves(desk: Desk) -> None:
    desk.set(EVA, ["title"], "Cell", "A cell")
    desk.set(EVA, ["rest"], True, "idle")
    desk.set(ADAM, ["drill", "goal"], "done", "drilled", OPERATIONS)
    desk.undo(EVA)
    desk.undo(EVA)
    assert desk.draft.files == {**FILES, OPERATIONS: "drill:\n  goal: drilled\n"}
    assert desk.can(EVA) == (0, 2)
    desk.redo(EVA)
    assert "A cell" in desk.draft.files[STATION]
    desk.set(EVA, ["name"], "cell", "cell_2")
    assert desk.can(EVA) == (2, 0)  # something else was done since
    desk.undo(EVA)
    desk.undo(EVA)
    assert desk.draft.files[STATION] == FILES[STATION]


def test_what_somebody_else_went_on_with_is_not_undone(desk: Desk) -> None:
    desk.set(EVA, ["title"], "Cell", "A cell")
    desk.set(ADAM, ["title"], "A cell", "The cell")
    with pytest.raises(PartChangedError):
        desk.undo(EVA)
    assert "The cell" in desk.draft.files[STATION]


def test_a_file_that_was_taken_away_comes_back(desk: Desk) -> None:
    desk.write(EVA, OPERATIONS, FILES[OPERATIONS], None)
    assert OPERATIONS not in desk.draft.files
    assert OPERATIONS in desk.draft.base
    desk.undo(EVA)
    assert desk.draft.files == FILES


def test_what_happens_to_the_files_of_the_station_is_taken_up(desk: Desk) -> None:
    desk.set(EVA, ["title"], "Cell", "A cell")
    other = {**FILES, OPERATIONS: "drill:\n  goal: drilled\n", "resources/tool.yaml": "title: Tool\n"}
    desk.take_up(other)
    assert desk.said[0][2] == "The files of the station have changed"
    draft = desk.draft
    assert draft.base == other
    assert draft.files == {**other, STATION: FILES[STATION].replace("Cell", "A cell")}


def test_where_both_changed_the_same_lines_the_draft_stays(desk: Desk) -> None:
    desk.set(EVA, ["title"], "Cell", "A cell")
    other = {**FILES, STATION: FILES[STATION].replace("Cell", "Drilling cell")}
    desk.take_up(other)
    *_, told = desk.said[0]
    assert told.endswith("; where the draft had changed the same lines, its own are kept: station.yaml")
    assert "A cell" in desk.draft.files[STATION]
    assert desk.draft.base == other


def test_only_so_many_changes_are_kept(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drafts, "MOST_CHANGES", 3)
    for number in range(6):
        desk.write(EVA, "resources/a.yaml", None if not number else f"title: a{number - 1}\n", f"title: a{number}\n")
    assert desk.draft.number == 7
    assert len(desk.said) == 3
    desk.undo(EVA)
    desk.undo(EVA)
    assert desk.draft.files["resources/a.yaml"] == "title: a3\n"
    assert desk.can(EVA)[0] == 0
