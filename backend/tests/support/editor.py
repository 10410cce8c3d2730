"""An editor: it speaks the Language Server Protocol to the program, as a process of its own, over its streams."""

from __future__ import annotations

import contextlib
import itertools
import json
import queue
import subprocess
import sys
import threading
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Self

from support.waiting import PATIENCE, until

COMMAND = (sys.executable, "-c", "from sequence_planner.program import main; main()", "language-server")
# What VS Code says that it can do, as far as it matters.
CAPABILITIES: dict[str, Any] = {
    "general": {"positionEncodings": ["utf-16"]},
    "workspace": {
        "inlayHint": {"refreshSupport": True},
        "workspaceEdit": {"documentChanges": True, "resourceOperations": ["create", "rename", "delete"]},
        "didChangeWatchedFiles": {"dynamicRegistration": True},
    },
}


class RefusedError(Exception):
    """An error that was answered."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        self.code = code


class Editor:
    """One that has started the program. `diagnostics` are those shown last, by the address of the document."""

    def __init__(self, capabilities: Mapping[str, Any] = CAPABILITIES, options: object = None) -> None:
        self.process = subprocess.Popen(COMMAND, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.diagnostics: dict[str, list[dict[str, Any]]] = {}
        self.published: list[dict[str, Any]] = []
        self.asked: list[str] = []  # what the program asks the editor
        self.said: list[str] = []  # messages to the person
        self.log = b""
        self._numbers = itertools.count(1)
        self._writing = threading.Lock()
        self._versions: dict[str, int] = {}
        self._texts: dict[str, str] = {}
        self.answers: dict[int | str | None, queue.SimpleQueue[dict[str, Any]]] = {None: queue.SimpleQueue()}
        self._threads = [threading.Thread(target=each, daemon=True) for each in (self._listen, self._keep_log)]
        for thread in self._threads:
            thread.start()
        self.can = self.ask(
            "initialize", processId=None, rootUri=None, capabilities=capabilities, initializationOptions=options
        )["capabilities"]
        self.tell("initialized")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            assert self.leave() == 0
        for thread in self._threads:
            thread.join()
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            assert stream is not None
            stream.close()

    def leave(self) -> int:
        """End the program as the protocol has it; returns its exit code."""
        self.ask("shutdown")
        self.tell("exit")
        return self.process.wait(PATIENCE)

    def send(self, body: bytes) -> None:
        """Send a message as it is."""
        self.raw(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    def raw(self, data: bytes) -> None:
        """Send that."""
        assert self.process.stdin is not None
        with self._writing:
            self.process.stdin.write(data)
            self.process.stdin.flush()

    def tell(self, method: str, **params: object) -> None:
        """Send a notification."""
        self.send(json.dumps({"jsonrpc": "2.0", "method": method, "params": params}).encode())

    def begin(self, method: str, **params: object) -> int:
        """Ask something; returns the number by which the answer is known."""
        number = next(self._numbers)
        self.answers[number] = queue.SimpleQueue()
        message = {"jsonrpc": "2.0", "id": number, "method": method, **({"params": params} if params else {})}
        self.send(json.dumps(message).encode())
        return number

    def answer(self, number: int | None) -> Any:  # noqa: ANN401
        """Return what is answered. Raises `RefusedError`."""
        until(lambda: not self.answers[number].empty(), "an answer")
        answered = self.answers[number].get()
        if "error" in answered:
            raise RefusedError(answered["error"]["code"], answered["error"]["message"])
        return answered["result"]

    def ask(self, method: str, **params: object) -> Any:  # noqa: ANN401
        """Ask something, and return what is answered. Raises `RefusedError`."""
        return self.answer(self.begin(method, **params))

    # Documents, as a person works with them.

    def open(self, path: Path, text: str | None = None) -> str:
        """Open a file, perhaps one that is not saved yet; returns its address."""
        uri = path.as_uri()
        self._texts[uri] = path.read_text(encoding="utf-8") if text is None else text
        self._versions[uri] = 1
        document = {"uri": uri, "languageId": "yaml", "version": 1, "text": self._texts[uri]}
        self.tell("textDocument/didOpen", textDocument=document)
        return uri

    def close(self, uri: str) -> None:
        """Close a document."""
        self.tell("textDocument/didClose", textDocument={"uri": uri})

    def type(self, uri: str, old: str, new: str) -> None:
        """Write something in place of the first that is so; the editor sends only the change."""
        text = self._texts[uri]
        start = text.index(old)
        where = {"start": position(text, start), "end": position(text, start + len(old))}
        self._texts[uri] = text[:start] + new + text[start + len(old) :]
        self._versions[uri] += 1
        self.tell(
            "textDocument/didChange",
            textDocument={"uri": uri, "version": self._versions[uri]},
            contentChanges=[{"range": where, "text": new}],
        )

    def text(self, uri: str) -> str:
        """The text of a document."""
        return self._texts[uri]

    def at(self, uri: str, mark: str, offset: int | None = None) -> dict[str, Any]:
        """The position so many characters into the first `mark` of a document, or behind it, as a request has it."""
        text = self._texts[uri]
        index = text.index(mark) + (len(mark) if offset is None else offset)
        return {"textDocument": {"uri": uri}, "position": position(text, index)}

    def options(self, uri: str, mark: str) -> list[str]:
        """The names that are offered behind `mark`."""
        found = self.ask("textDocument/completion", **self.at(uri, mark))
        return [] if found is None else [each["label"] for each in found["items"]]

    def apply(self, edit: Mapping[str, Any]) -> None:
        """Carry out an edit in all documents that are open, and on the files of the others."""
        by_document = dict(edit.get("changes") or {})
        for each in edit.get("documentChanges") or ():
            if each.get("kind") == "create":
                path = Path(each["uri"].removeprefix("file://"))
                path.parent.mkdir(exist_ok=True)
                path.touch(exist_ok=False)
        for each in edit.get("documentChanges") or ():
            if "kind" not in each:
                by_document[each["textDocument"]["uri"]] = each["edits"]
        for uri, edits in by_document.items():
            path = Path(uri.removeprefix("file://"))
            text = self._texts.get(uri) or path.read_text(encoding="utf-8")
            new = edited(text, edits)
            if uri in self._texts:
                self.type(uri, text, new)
            else:
                path.write_text(new, encoding="utf-8")
        for each in edit.get("documentChanges") or ():
            if each.get("kind") == "rename":
                Path(each["oldUri"].removeprefix("file://")).rename(each["newUri"].removeprefix("file://"))

    def messages(self, uri: str) -> list[str]:
        """What is shown as wrong in a document."""
        return [each["message"] for each in self.diagnostics.get(uri, [])]

    def until_shown(self, uri: str, part: str) -> dict[str, Any]:
        """Wait until something is shown with this in its words; returns it."""
        until(lambda: any(part in each for each in self.messages(uri)), f"“{part}” in {uri}")
        return next(each for each in self.diagnostics[uri] if part in each["message"])

    def until_clean(self, uri: str) -> None:
        """Wait until nothing is shown as an error any more."""
        until(
            lambda: not [each for each in self.diagnostics.get(uri, []) if each["severity"] == 1], f"no error in {uri}"
        )

    def _listen(self) -> None:
        assert self.process.stdout is not None
        stream = self.process.stdout
        while header := stream.readline():
            length = int(header.partition(b":")[2])
            while stream.readline().strip():
                pass
            self._hear(json.loads(stream.read(length)))

    def _hear(self, message: dict[str, Any]) -> None:
        match message:
            case {"method": "textDocument/publishDiagnostics", "params": params}:
                self.diagnostics[params["uri"]] = params["diagnostics"]
                self.published.append(params)
            case {"method": "window/showMessage", "params": params}:
                self.said.append(params["message"])
            case {"method": str(method), "id": number}:
                self.asked.append(method)
                with contextlib.suppress(OSError, ValueError):  # what it asks at its end, nobody answers
                    self.send(json.dumps({"jsonrpc": "2.0", "id": number, "result": None}).encode())
            case {"id": number}:
                self.answers[number].put(message)

    def _keep_log(self) -> None:
        assert self.process.stderr is not None
        while line := self.process.stderr.readline():
            self.log += line


def position(text: str, index: int) -> dict[str, int]:
    """The line and the unit of UTF-16 of a character."""
    line_start = text.rfind("\n", 0, index) + 1
    units = len(text[line_start:index].encode("utf-16-le")) // 2
    return {"line": text.count("\n", 0, index), "character": units}


def edited(text: str, edits: Iterable[Mapping[str, Any]]) -> str:
    """A text with edits, each at its place in what it was."""
    for each in sorted(edits, key=lambda each: tuple(each["range"]["start"].values()), reverse=True):
        start, end = (_index(text, each["range"][end]) for end in ("start", "end"))
        text = text[:start] + each["newText"] + text[end:]
    return text


def _index(text: str, at: Mapping[str, int]) -> int:
    lines = text.split("\n")
    before = lines[at["line"]].encode("utf-16-le")[: 2 * at["character"]].decode("utf-16-le")
    return sum(len(line) + 1 for line in lines[: at["line"]]) + len(before)
