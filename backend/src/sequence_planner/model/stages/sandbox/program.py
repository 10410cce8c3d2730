"""The process of one function: requests come in on standard input, answers go out where standard output was.

It is run as a file and imports nothing of the package but what confines it, so that it starts fast and a station's own
modules cannot be taken for ours. It is confined before anything of the station's is loaded. Whatever the function
prints goes to standard error, which the other side writes to the log. The process ends with its standard input,
whatever the function does then.
"""

from __future__ import annotations

import importlib.util
import json
import os
import queue
import sys
import threading
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from sequence_planner.model.stages.sandbox.confinement import confine

CONFINED = "a stage reads files of its folder alone, writes none, and has neither network nor other programs"
Function = Callable[..., object]


def main() -> None:
    """Load the function that the command line names, and answer."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    requests: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    folder, file, name = sys.argv[1:]
    sys.path.insert(0, folder)
    without = confine()
    threading.Thread(target=_read, args=(sys.stdin.buffer, requests), daemon=True).start()
    try:
        function = _load(Path(file), name)
    except BaseException as error:
        _say(answers, {"failed": _reason(error)})
        os._exit(1)
    _say(answers, {"ready": True, "without": without})
    while True:
        _say(answers, _answer(function, json.loads(requests.get())))


def _read(requests: BinaryIO, waiting: queue.SimpleQueue[bytes]) -> None:
    for line in requests:
        waiting.put(line)
    os._exit(0)


def _load(file: Path, name: str) -> Function:
    specification = importlib.util.spec_from_file_location(file.stem, file)
    if specification is None or specification.loader is None:
        raise ImportError(f"{file.name} is no Python file")
    module = importlib.util.module_from_spec(specification)
    sys.modules[file.stem] = module
    specification.loader.exec_module(module)
    function: Function = getattr(module, name)
    if not callable(function):
        raise TypeError(f"{name} is no function")
    return function


def _answer(function: Function, arguments: dict[str, object]) -> dict[str, object]:
    try:
        return {"gives": json.loads(json.dumps(function(**arguments), default=_plain))}
    except BaseException as error:
        return {"failed": _reason(error)}


def _plain(value: object) -> object:
    """A number of NumPy's as one of Python's. Raises TypeError for anything else."""
    if callable(item := getattr(value, "item", None)):
        return item()
    raise TypeError(f"{type(value).__name__} is no plain value")


def _reason(error: BaseException) -> str:
    traceback.print_exception(error)
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return f"{reason} ({CONFINED})" if _is_kept_out(error) else reason


def _is_kept_out(error: BaseException | None) -> bool:
    while error is not None and not isinstance(error, PermissionError):
        error = error.__cause__ or error.__context__
    return error is not None


def _say(answers: BinaryIO, word: dict[str, object]) -> None:
    sys.stdout.flush()
    sys.stderr.flush()
    answers.write(json.dumps(word).encode() + b"\n")
    answers.flush()


if __name__ == "__main__":
    main()
