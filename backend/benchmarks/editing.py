"""What editing costs in a large model: 200 resources with 1 000 abilities, of which each reads others.

Run with `make bench`. The draft is in a new SQLite file. The same files read by ruamel.yaml alone, which knows places
and comments too, stand beside ours. Of each the time on the wall and that of the processor are printed: on a machine
with other work the second is what counts.
"""

from __future__ import annotations

import itertools
import os
import statistics
import tempfile
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from ruamel.yaml import YAML
from stations.large import ABILITIES, RESOURCES, files

from sequence_planner.core.actor import SYSTEM
from sequence_planner.db.database import Database
from sequence_planner.editor import draft as drafts
from sequence_planner.editor.checks import checked
from sequence_planner.editor.draft import SetEntry
from sequence_planner.editor.language.draft import LanguageDraft
from sequence_planner.editor.language_worker import answer, errors, renamed_files, tied, used
from sequence_planner.editor.processes import LanguageQuestionKind, PlaceInText
from sequence_planner.editor.schemas.draft import FileReader
from sequence_planner.model.files import FolderReader, write_files
from sequence_planner.model.launch_requirements import StartNeeds

LOOKS = 20
MACHINE = "resources/machine_9.yaml"


def told(what: str, work: Callable[[], object], looks: int = 1) -> None:
    """Print how long it takes: the medians of so many looks."""
    wall, cpu = [], []
    for _ in range(looks):
        began = time.perf_counter(), time.process_time()
        work()
        wall.append(1000 * (time.perf_counter() - began[0]))
        cpu.append(1000 * (time.process_time() - began[1]))
    print(f"| {what} | {statistics.median(wall):.1f} ms | {statistics.median(cpu):.1f} ms |")


def main() -> None:
    """All lines."""
    model = files()
    size = sum(map(len, model.values())) / 1e6
    load = ", ".join(f"{each:.1f}" for each in os.getloadavg())
    print(f"{RESOURCES} resources, {RESOURCES * ABILITIES} abilities, {size:.2f} MB; load of the machine {load}")
    print("| what | on the wall | processor |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        drafting(model, Path(folder))
        words(model, Path(folder))
        whole(model, Path(folder))


def drafting(model: dict[str, str], folder: Path) -> None:
    """The draft, as the server keeps and shows it."""
    write_files(model, folder / "model")
    seen = FolderReader(folder / "model")
    with closing(Database.open(f"sqlite:///{folder}/station.sqlite")) as database:
        database.upgrade()
        with database.writing() as connection:
            empty = drafts.read(connection)
            drafts.take_up(connection, empty, model, drafts.taking_up(empty, model), 1.0)

        def read() -> drafts.Draft:
            with database.reading() as connection:
                return drafts.read(connection)

        draft, reader = read(), FileReader()
        told("all files for the page, first", lambda: reader.shown(draft, draft.files))
        told("the same by ruamel.yaml alone", lambda: [YAML(typ="rt").load(text) for text in model.values()])
        told("all files for the page, again", lambda: reader.shown(read(), model), LOOKS)
        told("what is in the folder and in the database, before each answer", lambda: (seen.read(), read()), LOOKS)
        edit = SetEntry(file="resources/machine_7.yaml", path=["title"], was="Machine 7", value="Mill")

        def change() -> None:
            proposal = drafts.editing(read(), [edit], "a title")
            with database.writing() as connection:
                drafts.write(
                    connection, read(), drafts.DraftProposal(dict(model), proposal.kind, None, ""), SYSTEM, 2.0
                )

        told("an edit, worked out and written", change, LOOKS)


def words(model: dict[str, str], folder: Path) -> None:
    """The process that keeps what it has read of the draft."""
    draft = LanguageDraft(folder / "words")
    draft.take(model)
    told("errors of the whole model, first", lambda: errors(draft))
    numbers = itertools.count()

    def changed(was: str, text: str) -> Callable[[], object]:
        def work() -> object:
            number = str(next(numbers))
            other = f"{model[MACHINE].replace(was, text.replace('{n}', number))}# {number}\n"
            draft.take({MACHINE: other})
            return errors(draft)

        return work

    told("errors after a guard was changed", changed("p0\n    start", "p9\n    start"), LOOKS)
    told("errors after a variable was added", changed("estimated:", "estimated:\n  extra_{n}: {type: bool}"), LOOKS)
    draft.take(model)
    place: list[str | int] = ["abilities", "step_1", "start", "when"]
    asked = PlaceInText(file=MACHINE, path=place, text="place == p1 and mach", offset=20)

    def ask(kind: LanguageQuestionKind) -> Callable[[], object]:
        return lambda: answer(draft, kind, asked)

    def after_change() -> object:
        draft.take({MACHINE: model[MACHINE] + f"# {next(numbers)}\n"})
        return answer(draft, LanguageQuestionKind.CHECK, asked)

    told("a text is checked, first", ask(LanguageQuestionKind.CHECK))
    told("a text is checked, after another change", after_change, LOOKS)
    for kind in LanguageQuestionKind:
        told(f"a text while it is typed: {kind.value}", ask(kind), LOOKS)
    told("where a variable that all read is named, first", lambda: used(draft, "variable:automatic"))
    told("where it is named, again", lambda: used(draft, "variable:automatic"), 5)
    told("the model as a whole, read before", lambda: tied(draft, 1), 5)
    told("it has another name", lambda: renamed_files(draft, "variable:automatic", "hands_free"), 5)
    told("a resource has another name", lambda: renamed_files(draft, "resource:machine_5", "mill"), 5)


def whole(model: dict[str, str], folder: Path) -> None:
    """The check from scratch, which every draft without errors has."""
    found = folder / "found"
    found.mkdir()
    told(
        "the check from scratch, until its warnings",
        lambda: next(e for e in checked(1, model, None, StartNeeds(), found) if e.findings),
    )


if __name__ == "__main__":
    main()
