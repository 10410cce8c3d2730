"""The language server as a process: how it begins and ends, and what it makes of an editor that makes mistakes."""

from __future__ import annotations

import json
import shutil
import subprocess
import time
from pathlib import Path

import pytest

from support.editor import CAPABILITIES, COMMAND, Editor, RefusedError
from support.places import MODELS
from support.waiting import PATIENCE, until


def test_it_ends_as_the_protocol_has_it(station: Path) -> None:
    with Editor() as editor:
        uri = editor.open(station / "station.yaml")
        editor.options(uri, "name: ")
        assert editor.leave() == 0
    assert editor.log == b""


def test_it_has_an_exit_code_of_its_own_where_nothing_was_shut_down(station: Path) -> None:
    with Editor() as editor:
        editor.open(station / "station.yaml")
        editor.tell("exit")
        assert editor.process.wait(PATIENCE) == 1


@pytest.mark.parametrize("begun", [False, True])
def test_it_ends_when_its_input_does(station: Path, begun: bool) -> None:
    with Editor() as editor:
        if begun:
            editor.open(station / "station.yaml")
            editor.ask("shutdown")
        assert editor.process.stdin is not None
        editor.process.stdin.close()
        assert editor.process.wait(PATIENCE) == (0 if begun else 1)


def test_it_ends_without_a_word_where_nobody_speaks() -> None:
    done = subprocess.run(COMMAND, input=b"", capture_output=True, timeout=PATIENCE, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (1, b"", b"")


def test_nothing_is_answered_after_a_shutdown_but_that(station: Path) -> None:
    with Editor() as editor:
        editor.ask("shutdown")
        with pytest.raises(RefusedError, match="has been shut down"):
            editor.ask("workspace/symbol", query="")
        editor.tell("exit")
        assert editor.process.wait(PATIENCE) == 0


def test_mistakes_of_the_editor(station: Path) -> None:
    """Each is answered, if it can be, and what is asked next is answered as always."""
    with Editor() as editor:
        uri = editor.open(station / "resources" / "nutrunner.yaml")
        editor.send(b"{this is no JSON")
        with pytest.raises(RefusedError, match="not JSON") as refused:
            editor.answer(None)
        assert refused.value.code == -32700
        editor.send(b'["a list"]')
        with pytest.raises(RefusedError, match="no message of JSON-RPC"):
            editor.answer(None)
        with pytest.raises(RefusedError, match="Method Not Found") as refused:
            editor.ask("textDocument/sing", text="la")
        assert refused.value.code == -32601
        with pytest.raises(RefusedError) as refused:
            editor.ask("textDocument/hover", textDocument=5)
        assert refused.value.code == -32602
        editor.tell("telemetry/unheard_of", a=1)
        editor.raw(b"Content-Length: many\r\n\r\n" + b"x" * 10_000_000 + b"\r\n")
        editor.tell("textDocument/didChange", textDocument={"uri": "file:///nowhere", "version": 2}, contentChanges=[])
        assert editor.ask("textDocument/hover", **editor.at(uri, "robot.pose", 8))
        assert editor.said == []


def test_a_line_of_ten_megabytes(station: Path) -> None:
    """It is refused as a file of a model; all else is looked at as before."""
    with Editor() as editor:
        uri = editor.open(station / "resources" / "nutrunner.yaml")
        editor.options(uri, "executing: ")
        editor.type(uri, "en: Nutrunner", "en: " + "x" * 10_000_000)
        editor.until_shown(uri, "a file of a model has at most 1000000")
        assert editor.options(uri, "executing: tool_is_running_forward and not tool_is")
        editor.type(uri, "x" * 10_000_000, "Nutrunner")
        editor.until_clean(uri)


def test_files_go_and_come(station: Path) -> None:
    """Files change under it, as another program writes them; whatever is gone is said, and it goes on."""
    with Editor() as editor:
        until(lambda: "client/registerCapability" in editor.asked, "files are watched")
        uri = editor.open(station / "operations.yaml")
        editor.options(uri, "  precondition: ")
        robot = station / "resources" / "robot.yaml"
        text = robot.read_text(encoding="utf-8")
        robot.unlink()
        changed = {"uri": robot.as_uri(), "type": 3}
        editor.tell("workspace/didChangeWatchedFiles", changes=[changed])
        editor.until_shown(uri, "robot.tool_is_attached")
        robot.write_text(text, encoding="utf-8")
        editor.tell("workspace/didChangeWatchedFiles", changes=[{**changed, "type": 1}])
        editor.until_clean(uri)
        shutil.rmtree(station)
        editor.tell(
            "workspace/didChangeWatchedFiles", changes=[{"uri": (station / "station.yaml").as_uri(), "type": 3}]
        )
        editor.until_shown((station / "station.yaml").as_uri(), "a station is a folder with a station.yaml")
        assert editor.ask("textDocument/definition", **editor.at(uri, "bolts[pair]", 2)) is not None


def test_a_file_with_almost_the_right_name(station: Path) -> None:
    with Editor() as editor:
        wrong = station / "resources" / "robot.yaml"
        wrong = wrong.rename(wrong.with_suffix(".yml"))
        uri = editor.open(wrong)
        shown = editor.until_shown(uri, "rename it to robot.yaml: this is not read")
        actions = editor.ask(
            "textDocument/codeAction", textDocument={"uri": uri}, range=shown["range"], context={"diagnostics": [shown]}
        )
        assert [each["title"] for each in actions] == ["Call the file robot.yaml"]
        editor.apply(actions[0]["edit"])
        assert (station / "resources" / "robot.yaml").is_file()


def test_several_stations_and_files_of_none(station: Path, tmp_path: Path) -> None:
    """Each file belongs to the nearest station; of what belongs to none nothing is said."""
    second = tmp_path / "second"
    shutil.copytree(MODELS / "robots_with_buffer", second)
    inner = station / "attic" / "old"
    shutil.copytree(MODELS / "single_bolt", inner)
    stray = tmp_path / "stray.yaml"
    stray.write_text("goal: {", encoding="utf-8")
    with Editor() as editor:
        first = editor.open(station / "operations.yaml")
        other = editor.open(second / "operations.yaml")
        deep = editor.open(inner / "operations.yaml")
        alone = editor.open(stray)
        unsaved = "untitled:Untitled-1"
        document = {"uri": unsaved, "languageId": "yaml", "version": 1, "text": "name: x"}
        editor.tell("textDocument/didOpen", textDocument=document)
        assert editor.options(first, "  precondition: ")
        names = {each["name"] for each in editor.ask("workspace/symbol", query="")}
        assert {"robot_1.pick", "nutrunner.run_nut"} <= names
        for uri in (alone, unsaved):
            where = {"textDocument": {"uri": uri}, "position": {"line": 0, "character": 3}}
            assert editor.ask("textDocument/completion", **where) is None
            assert editor.ask("textDocument/hover", **where) is None
        for uri in (first, other, deep):
            text = editor.text(uri)
            editor.type(uri, text[text.index("goal:") :].split("\n", maxsplit=1)[0], "goal: nobody.knows")
            editor.until_shown(uri, "unknown variable `nobody.knows`")
        assert not {alone, unsaved} & editor.diagnostics.keys()


def test_what_is_asked_is_called_off(station: Path) -> None:
    with Editor() as editor:
        uri = editor.open(station / "resources" / "nutrunner.yaml")
        numbers = [editor.begin("workspace/symbol", query="x") for _ in range(20)]
        last = numbers[-1]
        editor.tell("$/cancelRequest", id=last)
        with pytest.raises(RefusedError) as refused:
            editor.answer(last)
        assert refused.value.code == -32800
        assert editor.answer(numbers[0]) is not None
        assert editor.ask("textDocument/hover", **editor.at(uri, "robot.pose", 8))


@pytest.mark.parametrize(("encoding", "width"), [("utf-8", 4), ("utf-16", 2), ("utf-32", 1)])
def test_it_counts_as_the_editor_does(station: Path, encoding: str, width: int) -> None:
    capabilities = {**CAPABILITIES, "general": {"positionEncodings": [encoding, "utf-16"]}}
    with Editor(capabilities) as editor:
        assert editor.can["positionEncoding"] == encoding
        path = station / "work_masters.yaml"
        line = "  title: {en: 𝔫, sv: [x]}\n"
        path.write_text(
            path.read_text(encoding="utf-8").replace("  title: {en: Truck engine, sv: Lastbilsmotor}\n", line),
            encoding="utf-8",
        )
        uri = editor.open(path)
        shown = editor.until_shown(uri, "expected a text")
        row = path.read_text(encoding="utf-8").split("\n")[shown["range"]["start"]["line"]]
        behind = "  title: {en: 𝔫, sv: "
        assert row.startswith("  title: ")
        assert shown["range"]["start"]["character"] in (len("  title: "), len(behind) - 1 + width)


def test_settings(station: Path) -> None:
    """A deadline that is over says so, and what was found until then stays."""
    with Editor(options={"supervisorHints": False, "deadline": 0.01}) as editor:
        uri = editor.open(station / "resources" / "robot.yaml")
        whole = {"start": {"line": 0, "character": 0}, "end": {"line": 999, "character": 0}}
        editor.options(uri, "enabled: ")
        time.sleep(1)
        assert editor.ask("textDocument/inlayHint", textDocument={"uri": uri}, range=whole) is None
        editor.type(uri, "abilities:", "abilitys:")
        editor.until_shown(uri, "did you mean `abilities`?")


def test_what_it_prints_is_messages_alone(station: Path) -> None:
    """Each byte of its output belongs to a message, also where processes of its own have something to say."""
    messages = [
        {
            "jsonrpc": "2.0",
            "id": 1,
            "method": "initialize",
            "params": {"processId": None, "rootUri": None, "capabilities": {}},
        },
        {"jsonrpc": "2.0", "id": 2, "method": "shutdown"},
        {"jsonrpc": "2.0", "method": "exit"},
    ]
    bodies = [json.dumps(each).encode() for each in messages]
    sent = b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(each), each) for each in bodies)
    done = subprocess.run(COMMAND, input=sent, capture_output=True, timeout=PATIENCE, check=False)
    assert done.returncode == 0
    rest, numbers = done.stdout, []
    while rest:
        head, _, rest = rest.partition(b"\r\n\r\n")
        length = int(head.split(b"\r\n")[0].partition(b":")[2])
        numbers.append(json.loads(rest[:length]).get("id"))
        rest = rest[length:]
    assert numbers == [1, 2]
