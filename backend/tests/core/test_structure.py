"""Rules of the packages that `docs/architecture.md` names: who may import whom, and how large things may be."""

from __future__ import annotations

import ast
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

import sequence_planner
from support.places import DOCS

ROOT = Path(sequence_planner.__file__).parent
NAME = sequence_planner.__name__

# From what knows least to what knows most: a package imports from those before it.
LAYERS = (
    "core",
    "forking",
    "process",
    "db",
    "language",
    "model",
    "automaton",
    "ros",
    "pipelines",
    "synthesis",
    "planning",
    "analysis",
    "simulation",
    "export",
    "journal",
    "standby",
    "execution",
    "controller",
    "history",
    "auth",
    "mes",
    "editor",
    "backup",
    "retention",
    "server",
    "startup",
    "cli",
)
PURE = {"asyncio", "threading", "socket", "sqlalchemy", "structlog", "multiprocessing", "subprocess"}
MOST_MODULES = 12  # in a folder
MOST_LINES = 800  # in a module
MOST_ALIKE = 9  # public classes that share their name with another one


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
            outside = {
                (node.module or "" if isinstance(node, ast.ImportFrom) else alias.name).split(".")[0]
                for node in ast.walk(tree(name))
                if isinstance(node, ast.Import | ast.ImportFrom)
                for alias in node.names
            }
            assert not outside & PURE, name


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
