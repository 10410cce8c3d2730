"""`python` from documents: the file and its function are read, and not yet run."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from pathlib import Path

from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange
from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import PythonDocument
from sequence_planner.pipelines.context import Context
from sequence_planner.pipelines.record import FieldType, ListType
from sequence_planner.pipelines.stages.own.process import Function
from sequence_planner.pipelines.stages.own.stage import Argument, PythonStage
from sequence_planner.pipelines.stages.values import REAL, TEXT, is_numeric, is_textual

FOLDER = "stages"

_SIMPLE: Mapping[str, FieldType] = {"bool": BOOLEAN, "real": REAL, "text": TEXT}
_RANGE = re.compile(r"(-?\d+)\.\.(-?\d+)")
_NAMES = re.compile(r"\{\s*(\w+(?:\s*,\s*\w+)*)\s*\}")
_LIST = re.compile(r"(.+)\[(\d*)\]")


def build_python(document: PythonDocument, context: Context) -> PythonStage | None:
    """A function whose file, parameters and types fit."""
    path = _file(document, context)
    is_function = path is not None and _has_function(path, document, context)
    arguments = [_argument(name, type_, context) for name, type_ in document.reads.items()]
    gives = {str(name): _type(text, context) for name, text in document.gives.items()}
    read = tuple(argument for argument in arguments if argument is not None)
    given = {name: type_ for name, type_ in gives.items() if type_ is not None}
    if path is None or not is_function or len(read) != len(arguments) or len(given) != len(gives):
        return None
    function = Function(str(document.file), str(document.function), path, path.parent)
    return PythonStage(context.place, function, read, given, document.deadline)


def _file(document: PythonDocument, context: Context) -> Path | None:
    folder = (context.folder / FOLDER).resolve()
    path = (context.folder / document.file).resolve()
    if not path.is_relative_to(folder):
        context.found(document.file.place, f"`{document.file}` is outside the station's folder `{FOLDER}`")
        return None
    if not path.is_file():
        others = [f"{FOLDER}/{other.relative_to(folder)}" for other in sorted(folder.rglob("*.py"))]
        near = suggestion(document.file, others)
        context.found(document.file.place, f"the station has no file `{document.file}`{near}")
        return None
    return path


def _has_function(path: Path, document: PythonDocument, context: Context) -> bool:
    try:
        module = ast.parse(path.read_bytes())
    except SyntaxError as error:
        line = f" in line {error.lineno}" if error.lineno else ""
        context.found(document.file.place, f"`{document.file}` is no Python: {error.msg}{line}")
        return False
    except (OSError, ValueError, RecursionError, MemoryError) as error:
        context.found(document.file.place, f"`{document.file}` is no Python: {error}")
        return False
    defined = {part.name: part for part in module.body if isinstance(part, ast.FunctionDef)}
    function = defined.get(document.function)
    if function is None:
        near = suggestion(document.function, defined)
        message = f"`{document.file}` defines no function `{document.function}`{near}"
        context.found(document.function.place, message)
        return False
    return _takes(function, document, context)


def _takes(function: ast.FunctionDef, document: PythonDocument, context: Context) -> bool:
    """Whether the function can be called with exactly what the stage reads."""
    arguments = function.args
    named = [argument.arg for argument in (*arguments.args, *arguments.kwonlyargs)]
    without_default = arguments.args[: len(arguments.args) - len(arguments.defaults)] + [
        argument
        for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
        if default is None
    ]
    refused = [name for name in document.reads if name not in named and arguments.kwarg is None]
    for name in refused:
        hint = (
            suggestion(name, named) if name.isidentifier() else ": `rename` the field to a parameter's name before this"
        )
        context.found(name.place, f"`{document.function}` has no parameter `{name}`{hint}")
    missing = [argument.arg for argument in without_default if argument.arg not in document.reads]
    missing += [argument.arg for argument in arguments.posonlyargs]
    if missing:
        message = f"`{document.function}` needs {', '.join(missing)}, which the stage does not read"
        context.found(document.function.place, message)
    return not refused and not missing


def _argument(name: SourceText, text: SourceText, context: Context) -> Argument | None:
    found, type_ = context.field(name), _type(text, context)
    if found is None or type_ is None:
        return None
    path, given = found
    if not _readable(given, type_):
        context.found(text.place, f"`{name}` is {given} in the record, and the function reads {type_}")
        return None
    return Argument(path, type_)


def _readable(given: FieldType, wanted: FieldType) -> bool:
    """Whether values of the one type may be of the other."""
    if isinstance(given, ListType) and isinstance(wanted, ListType):
        lengths = {given.length, wanted.length} - {None}
        return len(lengths) <= 1 and _readable(given.element, wanted.element)
    if isinstance(wanted, IntegerRange):
        return isinstance(given, IntegerRange)
    if isinstance(wanted, BooleanType):
        return given == BOOLEAN
    return (is_numeric(wanted) and is_numeric(given)) or (is_textual(wanted) and is_textual(given))


def _type(text: SourceText, context: Context) -> FieldType | None:
    type_ = _read_type(text)
    if type_ is None:
        forms = "bool, real, text, a range such as 0..3, names such as {open, closed}, or a list such as real[6]"
        context.found(text.place, f"unknown type `{text}`: write {forms}")
    return type_


def _read_type(text: str) -> FieldType | None:
    if text in _SIMPLE:
        return _SIMPLE[text]
    if match := _LIST.fullmatch(text):
        element = _read_type(match[1])
        return None if element is None else ListType(element, int(match[2]) if match[2] else None)
    if match := _RANGE.fullmatch(text):
        low, high = int(match[1]), int(match[2])
        return IntegerRange(low, high) if low <= high else None
    if match := _NAMES.fullmatch(text):
        return EnumerationType(tuple(dict.fromkeys(name.strip() for name in match[1].split(","))))
    return None
