"""What others rely on by name, part by part, as it is now: one text for each. `make golden` writes them down.

`frontend/openapi.json` and `docs/schemas` are such texts too, which `make types` writes.
"""

from __future__ import annotations

import ast
import json
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from enum import Enum
from functools import cache
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Final, Union, get_args, get_origin, get_type_hints
from unittest.mock import patch

import typer
from typer.testing import CliRunner

import sequence_planner
from sequence_planner.automaton.automaton import State
from sequence_planner.cli.lazy import LazyCommand
from sequence_planner.cli.main import app
from sequence_planner.controller.alarms.alarm import KIND as ASIDE
from sequence_planner.controller.alarms.kinds import KINDS as ALARMS
from sequence_planner.controller.features.plan import KIND as OPERATIONS
from sequence_planner.controller.features.variables import KIND as BELIEFS
from sequence_planner.execution.record.codec import _MISSING, BEGUN, KINDS, SNAPSHOT, WRITTEN_AS, _fields
from sequence_planner.execution.record.recorder import EXECUTION, ORDER, PLAN
from sequence_planner.language.syntax import Expression
from sequence_planner.planning.problem import Proof
from sequence_planner.server.metrics import PREFIX as METRICS_PREFIX
from sequence_planner.settings import PREFIX, Configuration

TEXTS: Final = Path(__file__).parent / "surface"
SOURCE: Final = Path(sequence_planner.__file__).parent
_EVENT: Final = re.compile(r'\bLOG\.(\w+)\(\s*"([^"]+)"')
_SLUG: Final = re.compile(r'\b(?:\w*(?:Error|Refused)|_?refus(?:al|ed))\(\s*"([a-z]+(?:-[a-z]+)+)"')
_VARIABLE: Final = re.compile(rf'"({PREFIX}[A-Z_]*[A-Z]|(?:ROS|RMW|FASTRTPS|FASTDDS|CYCLONEDDS|XDG)_[A-Z_]+)"')


def journal_kinds() -> str:
    """Each kind of record of which the state follows, with its fields, and what a snapshot remembers.

    `?` stands behind a field that may be left out; a choice of classes is written with the class's name before it.
    """
    parts = {f"{prefix}{name.lstrip('_')}": _form(form) for prefix, name, form in _memory()}
    kinds = {kind: _form(form) for kind, form in KINDS.items()}
    others = {"whole": sorted((BEGUN, SNAPSHOT)), "lasting": sorted((ASIDE, BELIEFS, OPERATIONS))}
    return json.dumps({"happenings": kinds, "memory": parts, **others}, indent=1, sort_keys=True) + "\n"


def alarm_keys() -> str:
    """The keys of all alarms that a controller raises; `*` is what is different for each of a kind."""
    return _lines({":".join((name, *"*" * kind.subjects)) for name, kind in ALARMS.items()})


def log_events() -> str:
    """What is logged, each with its level."""
    return _lines({f"{event} ({level})" for text in _sources().values() for level, event in _EVENT.findall(text)})


def error_slugs() -> str:
    """The kinds of refusals, as they are written where something is refused."""
    return _lines({slug for text in _sources().values() for slug in _SLUG.findall(text)})


def settings() -> str:
    """The variables of the environment, and each command's options with the variable that stands in for it."""
    variables = {f"{PREFIX}{name.upper()}" for name in Configuration.model_fields}
    variables |= {name for text in _sources().values() for name in _VARIABLE.findall(text)}
    options = {
        " ".join((*path, "/".join((*each.opts, *each.secondary_opts)), *_variables(each)))
        for path, command in _commands()
        for each in command.params
        if each.name != "help"
    }
    return _lines(variables) + "\n" + _lines(options)


def command_help() -> str:
    """What `--help` prints of every command, 80 columns wide and without colours."""
    runner = CliRunner(env={"COLUMNS": "80", "TERMINAL_WIDTH": "80", "NO_COLOR": "1", "TERM": "dumb"})
    texts = []
    for path, _ in _commands():
        # As the program is called: where somebody only wants help, `run` prepares nothing.
        with patch.object(sys, "argv", ["sequence-planner", *path, "--help"]):
            result = runner.invoke(app, [*path, "--help"], prog_name="sequence-planner", color=False)
        assert result.exit_code == 0, (path, result.output)
        lines = (line.rstrip() for line in result.output.splitlines())
        texts.append("\n".join(("$ " + " ".join(("sequence-planner", *path, "--help")), *lines)).rstrip() + "\n")
    return "\n".join(texts)


def metrics() -> str:
    """The metrics by their names, each with its type."""
    constants = {"PREFIX": METRICS_PREFIX}
    found: set[str] = set()
    for tree in _trees("MetricFamily("):
        for function in (each for each in ast.walk(tree) if isinstance(each, ast.FunctionDef)):
            for call in _calls(function, "MetricFamily"):
                kind, name = ast.unparse(call.func).removesuffix("MetricFamily").lower(), _text(call.args[0], constants)
                for given in _given(tree, function) if "*" in name else ("",):
                    found.add(f"{name.replace('*', given)} ({kind})")
    return _lines(found)


PARTS: Final[Mapping[str, Callable[[], str]]] = {
    "journal_kinds.json": journal_kinds,
    "alarm_keys.txt": alarm_keys,
    "log_events.txt": log_events,
    "error_slugs.txt": error_slugs,
    "settings.txt": settings,
    "help.txt": command_help,
    "metrics.txt": metrics,
}


def _lines(found: set[str]) -> str:
    return "".join(f"{each}\n" for each in sorted(found))


def _memory() -> Iterator[tuple[str, str, Any]]:
    for prefix, table in (("", EXECUTION), ("plan.", PLAN), ("order.", ORDER)):
        for name, form in table.items():
            yield prefix, name, form


def _form(form: Any) -> Any:  # noqa: ANN401 - what annotations are is no type
    """How values of a type are written."""
    if form in (Expression, State):
        return "predicate" if form is Expression else "values"
    origin, arguments = get_origin(form), get_args(form)
    if origin in (Union, UnionType):
        some = [each for each in arguments if each is not NoneType]
        plain = all(each in (bool, int, float, str) for each in some)
        inner = _form(some[0]) if len(some) == 1 else {each.__name__: _form(each) for each in some}
        inner = " or ".join(sorted(each.__name__ for each in some)) if plain else inner
        return {"or null": inner} if len(some) < len(arguments) else inner
    if origin is not None:
        return {
            getattr(origin, "__name__", str(origin)).lower(): [_form(each) for each in arguments if each is not ...]
        }
    if form is Proof:
        return "left out"
    if isinstance(form, type) and issubclass(form, Enum):
        return {"one of": sorted(str(each.value) for each in form)}
    if isinstance(form, type) and issubclass(form, tuple):
        return {"tuple": [_form(each) for each in get_type_hints(form).values()]}
    if form in (bool, int, float, str):
        return form.__name__
    hints = get_type_hints(form)
    names = WRITTEN_AS.get(form, {})
    return {
        f"{names.get(n, n)}{'' if default is _MISSING else '?'}": _form(hints[n])
        for n, default in _fields(form).items()
    }


@cache
def _sources() -> Mapping[Path, str]:
    return {file: file.read_text(encoding="utf-8") for file in sorted(SOURCE.rglob("*.py"))}


def _trees(needle: str) -> Iterator[ast.Module]:
    return (ast.parse(text) for text in _sources().values() if needle in text)


def _given(tree: ast.Module, function: ast.FunctionDef) -> Iterator[str]:
    """What a function of a module is given first where it is called there."""
    return (_text(call.args[0], {}) for call in _calls(tree, function.name))


def _calls(tree: ast.AST, ends: str) -> Iterator[ast.Call]:
    """Calls, with arguments, of what has a name that ends so."""
    for each in ast.walk(tree):
        if isinstance(each, ast.Call) and each.args and ast.unparse(each.func).endswith(ends):
            yield each


def _text(node: ast.expr, constants: Mapping[str, str]) -> str:
    """What an expression is, with `*` for what is only known when it runs."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.Name(id=name):
            return constants[name]
        case ast.JoinedStr(values=parts):
            return "".join(_text(part, constants) for part in parts)
        case ast.FormattedValue(value=ast.Name(id=name)) if name in constants:
            return constants[name]
        case ast.FormattedValue():
            return "*"
    raise AssertionError(f"it cannot be told what {ast.unparse(node)} is")


def _commands() -> Iterator[tuple[tuple[str, ...], Any]]:
    """Every command with its path, the program itself first."""
    yield from _within((), typer.main.get_command(app), None)


def _within(path: tuple[str, ...], command: Any, above: Any) -> Iterator[tuple[tuple[str, ...], Any]]:  # noqa: ANN401
    command = command.command() if isinstance(command, LazyCommand) else command
    yield path, command
    if hasattr(command, "list_commands"):
        context = command.make_context(path[-1] if path else None, [], parent=above, resilient_parsing=True)
        for name in command.list_commands(context):
            yield from _within((*path, name), command.get_command(context, name), context)


def _variables(parameter: Any) -> tuple[str, ...]:  # noqa: ANN401 - of an option or an argument
    found = parameter.envvar
    return () if found is None else (found,) if isinstance(found, str) else tuple(found)


if __name__ == "__main__":
    TEXTS.mkdir(exist_ok=True)
    for file in TEXTS.iterdir():
        file.unlink()
    for part, now in PARTS.items():
        (TEXTS / part).write_text(now(), encoding="utf-8")
