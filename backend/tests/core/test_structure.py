"""Rules of the packages that `docs/architecture.md` names: who may import whom, and how large things may be."""

from __future__ import annotations

import ast
import json
from collections import Counter, defaultdict
from functools import cache
from pathlib import Path

import pytest

import sequence_planner
from support.places import DOCS

ROOT = Path(sequence_planner.__file__).parent
NAME = sequence_planner.__name__

# From what knows least to what knows most: a package imports from those before it.
LAYERS = (
    "texts",
    "core",
    "forking",
    "process",
    "db",
    "language",
    "model",
    "automaton",
    "mimic",
    "ros",
    "pipelines",
    "synthesis",
    "planning",
    "analysis",
    "simulation",
    "scenarios",
    "export",
    "journal",
    "standby",
    "execution",
    "controller",
    "history",
    "auth",
    "mes",
    "editor",
    "language_server",
    "backup",
    "retention",
    "server",
    "startup",
    "cli",
)
# What the core of a running station must not know: clocks, threads, networks, databases, and the packages that do.
CLOCKS_AND_NETWORKS = {"asyncio", "threading", "socket", "sqlalchemy", "structlog", "multiprocessing", "subprocess"}
IMPURE = (
    CLOCKS_AND_NETWORKS | {"time", "pydantic"} | {f"{NAME}.{each}" for each in ("db", "process", "ros", "pipelines")}
)
# A type of JSON; and what time a record is written at, which decides nothing.
KNOWN_TO_RECORDS = {"execution.record.codec": {"pydantic"}, "execution.record.recorder": {"pydantic", "time"}}
# Modules that do not know each other, or folders whose modules know nothing of those beside them; and what still does.
INDEPENDENT = {
    "ros.transports.cyclonedds": ("ros.transports.rclpy", "ros.transports.rosbridge", "ros.transports.memory"),
    "ros.transports.rclpy": ("ros.transports.cyclonedds", "ros.transports.rosbridge", "ros.transports.memory"),
    "ros.transports.rosbridge": ("ros.transports.cyclonedds", "ros.transports.rclpy", "ros.transports.memory"),
    "ros.transports.memory": ("ros.transports.cyclonedds", "ros.transports.rclpy", "ros.transports.rosbridge"),
    "planning.sat": ("planning.pdr", "planning.heuristic"),
    "planning.pdr": ("planning.sat", "planning.heuristic"),
    "planning.heuristic": ("planning.sat", "planning.pdr"),
}
MOST_MODULES = 12  # in a folder
MOST_LINES = 800  # in a module
MOST_ALIKE = 9  # public classes that share their name with another one
MOST_IMPORTS = 15  # modules of the program that a module imports
FEWER_IMPORTS = {"controller.controller": 8}  # of those that are to stay simpler than others
MOST_NAMESAKES = 4  # modules that define a public function of the same name, unless it is one of these
PROTOCOL_VERBS = {
    "answering",
    "causes",
    "close",
    "handle",
    "on_event",
    "process",
    "render",
    "run",
    "start",
    "update",
    "upgrade",
    "view",
    "view_part",
}
# What was above these limits when they were set. A number in it is never raised, and what is below the limit leaves it.
EXCEPTIONS = json.loads(Path(__file__).with_name("structure_exceptions.json").read_text(encoding="utf-8"))


@cache
def modules() -> dict[str, Path]:
    """Every module of the program by its dotted name without the program's own."""
    found = {}
    for path in ROOT.rglob("*.py"):
        parts = path.relative_to(ROOT).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def tree(name: str) -> ast.Module:
    """The syntax tree of a module."""
    return ast.parse(modules()[name].read_text(encoding="utf-8"))


@cache
def imports(name: str) -> frozenset[str]:
    """Modules of the program that a module imports, wherever in it, those for its types included."""
    found = set()
    for node in ast.walk(tree(name)):
        if isinstance(node, ast.ImportFrom) and f"{node.module}.".startswith(f"{NAME}."):
            base = (node.module or "").removeprefix(NAME).removeprefix(".")
            for alias in node.names:
                within = f"{base}.{alias.name}".removeprefix(".")
                found.add(within if within in modules() else base)
    return frozenset(found - {name})


def test_packages_import_from_those_before_them() -> None:
    """Nothing below knows of what is above."""
    place = {layer: number for number, layer in enumerate(LAYERS)}
    packages = {name.split(".")[0] for name in modules() if (ROOT / name.split(".")[0]).is_dir()} - {""}
    assert packages == set(LAYERS)
    upward = [
        f"{name} imports {other}"
        for name in sorted(modules())
        for other in sorted(imports(name))
        if (of := name.split(".")[0]) in place and (to := other.split(".")[0]) in place and place[to] > place[of]
    ]
    assert not upward


def test_no_module_imports_itself_by_way_of_others() -> None:
    """An order exists in which all modules can be read."""
    left = {name: set(imports(name)) for name in modules()}
    while ready := [name for name, needs in left.items() if not needs & left.keys()]:
        for name in ready:
            del left[name]
    assert not left, f"in circles or behind one: {sorted(left)}"


def test_the_core_of_a_running_station_is_pure() -> None:
    """The same events lead to the same state, so it must not look at anything else."""
    for name in modules():
        if name.split(".")[0] == "execution":
            known = {
                node.module or "" if isinstance(node, ast.ImportFrom) else alias.name
                for node in ast.walk(tree(name))
                if isinstance(node, ast.Import | ast.ImportFrom)
                for alias in node.names
            }
            impure = {each for each in IMPURE for one in known if f"{one}.".startswith(f"{each}.")}
            assert impure <= KNOWN_TO_RECORDS.get(name, set()), name


def independent() -> dict[str, tuple[str, ...]]:
    """Of modules and folders those that they must not import from."""
    routes = [name for name in modules() if name.startswith("server.api.")]
    return INDEPENDENT | {each: tuple(other for other in routes if other != each) for each in routes}


@pytest.mark.parametrize(("one", "others"), independent().items(), ids=independent())
def test_what_is_independent_does_not_know_what_stands_beside_it(one: str, others: tuple[str, ...]) -> None:
    """One transport, one way to plan, the routes of one subject can be read, and taken out, alone."""
    assert any(name == one or name.startswith(f"{one}.") for name in modules()), "there is no such module"
    known = {
        f"{name} imports {other}"
        for name in modules()
        if f"{name}.".startswith(f"{one}.")
        for other in imports(name)
        if any(f"{other}.".startswith(f"{each}.") for each in others)
    }
    assert known <= set(EXCEPTIONS["imports"])


def test_no_module_imports_much_more_than_a_dozen_others() -> None:
    """Who reads a module has to know few others; what makes texts is known to all who say something to people."""
    most = EXCEPTIONS["fan_out"] | FEWER_IMPORTS
    numbers = {name: len(set(imports(name)) - {"texts.message"}) for name in modules()}
    assert not {name: n for name, n in numbers.items() if n > most.get(name, MOST_IMPORTS)}


def test_a_function_is_found_by_its_name() -> None:
    """What many modules call by the same name are a few verbs of protocols."""
    homes: dict[str, set[str]] = defaultdict(set)
    for name in modules():
        for node in ast.walk(tree(name)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and not node.name.startswith("_"):
                homes[node.name].add(name)
    numbers = {name: len(where) for name, where in homes.items() if name not in PROTOCOL_VERBS}
    assert not {name: n for name, n in numbers.items() if n > EXCEPTIONS["functions"].get(name, MOST_NAMESAKES)}


def test_folders_and_modules_fit_in_the_head() -> None:
    """At most a dozen modules lie in a folder, and none is too long to be read."""
    folders = Counter(path.parent for path in modules().values() if path.name != "__init__.py")
    assert not {str(each.relative_to(ROOT)): number for each, number in folders.items() if number > MOST_MODULES}
    lengths = {name: len(path.read_text(encoding="utf-8").splitlines()) for name, path in modules().items()}
    assert not {name: length for name, length in lengths.items() if length > MOST_LINES}


def test_classes_have_names_of_their_own() -> None:
    """Who looks for a class by its name finds one."""
    names = Counter(
        node.name
        for name in modules()
        for node in tree(name).body
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
    )
    assert sum(number > 1 for number in names.values()) <= MOST_ALIKE


@pytest.mark.parametrize("layer", LAYERS)
def test_each_package_is_in_the_picture(layer: str) -> None:
    """A newcomer finds every package in the table of `docs/architecture.md`."""
    assert f"`{layer}`" in (DOCS / "architecture.md").read_text(encoding="utf-8")
