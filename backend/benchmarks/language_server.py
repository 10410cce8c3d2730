"""What an editor waits for in a station of 30 000 lines: completion, findings after an edit, and the start.

Run with `make bench`. The language server is a process of its own that is spoken to over its streams, as editors do. Of
each the time on the wall and that of the server's processor are printed, medians; on a machine with other work the
second is what counts. What is found of the whole station in the background is another process, which is ended soon.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from stations.large import RESOURCES, files

from sequence_planner.model.files import write_files

sys.path.append(str(Path(__file__).parents[1] / "tests"))
from support.editor import COMMAND, Editor

ABILITIES = 13  # of each of the resources
LOOKS = 9
_TICKS = os.sysconf("SC_CLK_TCK")


def processor(process: int) -> float:
    """Milliseconds that a process has worked."""
    values = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return 1000 * (int(values[11]) + int(values[12])) / _TICKS


def told(what: str, editor: Editor, work: Callable[[], object], rest: Callable[[], object] = lambda: None) -> None:
    """Print how long it takes; `rest` is done behind each look."""
    wall, cpu = [], []
    for _ in range(LOOKS):
        began = time.perf_counter(), processor(editor.process.pid)
        work()
        wall.append(1000 * (time.perf_counter() - began[0]))
        cpu.append(processor(editor.process.pid) - began[1])
        rest()
    print(f"| {what} | {statistics.median(wall):.0f} ms | {statistics.median(cpu):.0f} ms |")


def main() -> None:
    """All lines."""
    model = files(ABILITIES)
    load = ", ".join(f"{each:.1f}" for each in os.getloadavg())
    lines = sum(text.count("\n") for text in model.values())
    print(f"{lines} lines, {RESOURCES} resources, {RESOURCES * ABILITIES} abilities; load of the machine {load}")
    print("| what | on the wall | processor |\n|---|---|---|")
    starting()
    with tempfile.TemporaryDirectory() as folder, Editor(options={"deadline": 0.1}) as editor:
        write_files(model, Path(folder))
        editing(editor, Path(folder))


def starting() -> None:
    """The process until it has said what it can do, and ended again."""
    wall, cpu = [], []
    for _ in range(LOOKS):
        began, before = time.perf_counter(), os.times()
        asked: dict[str, object] = {"processId": None, "rootUri": None, "capabilities": {}}
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": asked}).encode()
        subprocess.run(
            COMMAND, input=b"Content-Length: %d\r\n\r\n%s" % (len(body), body), stdout=subprocess.PIPE, check=False
        )
        after = os.times()
        wall.append(1000 * (time.perf_counter() - began))
        cpu.append(1000 * (sum(after[2:4]) - sum(before[2:4])))  # of processes that have ended
    print(f"| the process begins, and ends | {statistics.median(wall):.0f} ms | {statistics.median(cpu):.0f} ms |")


def editing(editor: Editor, folder: Path) -> None:
    """One resource is written, of which others are read as well."""
    uri = editor.open(folder / "resources" / "machine_9.yaml")
    began, before = time.perf_counter(), processor(editor.process.pid)
    editor.options(uri, "enabled: ")
    wall, cpu = 1000 * (time.perf_counter() - began), processor(editor.process.pid) - before
    print(f"| the station is read, until there are names | {wall:.0f} ms | {cpu:.0f} ms |")
    editor.until_clean(uri)
    time.sleep(1)
    mark = "enabled: automatic and mach"
    told("completion", editor, lambda: editor.options(uri, mark))

    def typed() -> None:
        editor.type(uri, mark, f"{mark[:-1]}")
        editor.type(uri, f"{mark[:-1]}", mark)
        editor.options(uri, mark)

    told("completion right behind what is typed", editor, typed, lambda: time.sleep(1))
    told("an explanation", editor, lambda: editor.ask("textDocument/hover", **editor.at(uri, "machine_8.held", 4)))
    shown = editor.at(uri, "place != target", 2)
    told("the same names in the document", editor, lambda: editor.ask("textDocument/documentHighlight", **shown))

    def until_published(old: str, new: str) -> Callable[[], None]:
        def work() -> None:
            number = len(editor.published)
            editor.type(uri, old, new)
            while len(editor.published) == number:
                time.sleep(0.001)

        return work

    def put_back(old: str, new: str) -> Callable[[], None]:
        def work() -> None:
            editor.type(uri, new, old)
            editor.until_clean(uri)
            time.sleep(1)

        return work

    for what, old, new in (
        ("findings after a wrong name in a guard", "place == p0", "place == p7"),
        ("findings after a wrong type of a new variable", "estimated:\n", "estimated:\n  extra: {type: bol}\n"),
        ("findings after a wrong key", "    start:\n", "    sart:\n"),
    ):
        told(what, editor, until_published(old, new), put_back(old, new))
    place = {**editor.at(uri, "automatic and", 2), "context": {"includeDeclaration": True}}
    told("references to what all read", editor, lambda: editor.ask("textDocument/references", **place))
    told("symbols of the station", editor, lambda: editor.ask("workspace/symbol", query="step_1"))


if __name__ == "__main__":
    main()
