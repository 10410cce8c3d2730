"""What editing costs in a large model: 200 resources with 1 000 abilities, of which each reads others.

Run with `make bench`. The draft is in a new SQLite file. The same files read by ruamel.yaml alone, which knows places
and comments too, stand beside ours, with the ratio.
"""

from __future__ import annotations

import shutil
import statistics
import tempfile
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from ruamel.yaml import YAML
from stations.large import ABILITIES, RESOURCES, files

from sequence_planner.actor import SYSTEM
from sequence_planner.storage.database import Database
from sequence_planner.workshop import draft as drafts
from sequence_planner.workshop.checking import checked
from sequence_planner.workshop.edits import SetEntry
from sequence_planner.workshop.language_worker import Draft, answer
from sequence_planner.workshop.questions import LanguageQuestionKind, PlaceInText
from sequence_planner.workshop.references import dependants, parse_part, renamed
from sequence_planner.workshop.showing import Reader

LOOKS = 20


def seconds(work: Callable[[], object]) -> float:
    """How long it takes."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def middle(work: Callable[[], object]) -> float:
    """The median of some looks, in milliseconds."""
    return 1000 * statistics.median(seconds(work) for _ in range(LOOKS))


def main() -> None:
    """All lines."""
    model = files()
    print(f"{RESOURCES} resources, {RESOURCES * ABILITIES} abilities, {sum(map(len, model.values())) / 1e6:.2f} MB")
    with tempfile.TemporaryDirectory() as folder:
        measure(model, Path(folder))


def measure(model: dict[str, str], folder: Path) -> None:
    """The draft, the check, the language and names."""
    with closing(Database.open(f"sqlite:///{folder}/station.sqlite")) as database:
        database.upgrade()
        with database.writing() as connection:
            drafts.take_up(connection, model, 1.0)

        def read() -> drafts.Draft:
            with database.reading() as connection:
                return drafts.read(connection)

        draft, reader = read(), Reader()
        first = seconds(lambda: reader.views(draft, draft.files))
        peer = seconds(lambda: [YAML(typ="rt").load(text) for text in model.values()])
        again = middle(lambda: reader.views(read(), model))
        print(
            f"all files for the page: first {first:.2f} s (ruamel.yaml alone {peer:.2f} s, ratio {peer / first:.1f}), ",
            end="",
        )
        print(f"then {again:.0f} ms")
        edit = SetEntry(file="resources/machine_7.yaml", path=["title"], was="Machine 7", value="Mill")

        def change() -> None:
            proposal = drafts.editing(read(), [edit], "a title")
            with database.writing() as connection:
                drafts.write(connection, read(), drafts.Proposal(model, proposal.kind, None, ""), SYSTEM, 2.0)

        print(f"an edit, worked out and written: {middle(change):.0f} ms")
    wrong = {**model, "operations.yaml": model["operations.yaml"].replace("machine_0.held", "machine_0.hold")}
    found = folder / "found"
    found.mkdir()
    until_error = seconds(lambda: [each for each in checked(1, wrong, None, found) if each.findings])
    shutil.rmtree(found)
    print(f"an error of the whole model is found in {until_error:.2f} s")
    words = Draft(folder / "words")
    words.take(model)
    place = ["abilities", "step_1", "start", "when"]
    asked = PlaceInText(file="resources/machine_9.yaml", path=place, text="place == p1 and mach", offset=20)

    def ask(kind: LanguageQuestionKind) -> Callable[[], object]:
        return lambda: answer(words, kind, asked)

    cold = seconds(ask(LanguageQuestionKind.CHECK))
    print(f"a text while it is typed: first {cold:.2f} s, then ", end="")
    print(", ".join(f"{kind.value} {middle(ask(kind)):.1f} ms" for kind in LanguageQuestionKind))
    part = parse_part("resource:machine_5")
    print(f"what depends on a resource: {seconds(lambda: dependants(model, part)):.2f} s")
    print(f"a resource is renamed: {seconds(lambda: renamed(model, part, 'mill')):.2f} s")


if __name__ == "__main__":
    main()
