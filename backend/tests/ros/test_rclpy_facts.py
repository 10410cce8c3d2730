"""What our source takes for granted of rclpy is what a genuine rclpy has.

The facts are those of an installation (`jazzy/rclpy.json`). The stubs are made from them, so mypy holds our source
against them; what mypy is not shown here is found by walking the source itself.
"""

from __future__ import annotations

import ast
import importlib
import importlib.util
import inspect
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jazzy_facts import rclpy_facts

from support.places import BACKEND, SOURCES

FACTS = rclpy_facts()
USERS = sorted(
    path for path in SOURCES.rglob("*.py") if re.search(r"^\s*(from|import) rclpy\b", path.read_text(), re.M)
)


def parameters(signature: str) -> inspect.Signature:
    """Return the parameters that a signature of the facts has, whatever their types."""
    names: dict[str, Any] = {}
    [made] = ast.parse(f"def made{re.sub(r'~[A-Za-z]+', 'object', signature)}: ...").body
    assert isinstance(made, ast.FunctionDef)
    every = [*made.args.args, *made.args.kwonlyargs, made.args.vararg, made.args.kwarg]
    for each in every:
        if each is not None:
            each.annotation = None
    made.returns = None
    exec(compile(ast.fix_missing_locations(ast.Module([made], [])), "facts", "exec"), names)
    return inspect.signature(names["made"])


def called(fact: str | dict[str, Any], name: str) -> inspect.Signature:
    """Return what a function or a class of the facts is called with."""
    if isinstance(fact, str):
        return parameters(fact)
    if fact["init"] != "(**kwargs)":
        return parameters(fact["init"])
    properties = [each for each, what in fact["members"].items() if what == "property"]
    assert properties, name
    return inspect.Signature(
        [inspect.Parameter(each, inspect.Parameter.KEYWORD_ONLY, default=...) for each in properties]
    )


class Used(ast.NodeVisitor):
    """Notes where a module uses what rclpy does not have."""

    def __init__(self) -> None:
        self.wrong: list[str] = []
        self.seen = 0
        self._names: dict[str, tuple[str, str]] = {}  # as imported -> module and name
        self._kinds: dict[str, tuple[str, str]] = {}  # expression -> class

    def visit_Import(self, node: ast.Import) -> None:
        for each in node.names:
            if each.name.split(".")[0] == "rclpy":
                self._note(each.name in FACTS, f"no module {each.name}")
                self._names[each.asname or each.name] = (each.name, "")

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        module = node.module or ""
        if module.split(".")[0] == "rclpy":
            for each in node.names:
                self._note(each.name in FACTS.get(module, {}), f"{module} has no {each.name}")
                self._names[each.asname or each.name] = (module, each.name)

    def visit_arg(self, node: ast.arg) -> None:
        self._is(node.arg, node.annotation)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        self._is(ast.unparse(node.target), node.annotation)
        self.generic_visit(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        if isinstance(node.value, ast.Call):
            for target in node.targets:
                self._is(ast.unparse(target), node.value.func)
        self.generic_visit(node)

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        outer = dict(self._kinds)
        self.generic_visit(node)
        self._kinds = {**outer, **{each: kind for each, kind in self._kinds.items() if each.startswith("self.")}}

    def visit_Attribute(self, node: ast.Attribute) -> None:
        found = self._fact(node.value)
        if found is not None:
            fact, where = found
            self._note(node.attr in fact.get("members", fact), f"{where} has no {node.attr} (line {node.lineno})")
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        signature = self._signature(node.func)
        if signature is not None:
            positional = [None for each in node.args if not isinstance(each, ast.Starred)]
            keywords = {each.arg: None for each in node.keywords if each.arg is not None}
            try:
                signature.bind_partial(*positional, **keywords)
            except TypeError as error:
                self._note(False, f"{ast.unparse(node.func)}: {error} (line {node.lineno})")
        self.generic_visit(node)

    def _is(self, name: str, kind: ast.expr | None) -> None:
        """Note that an expression is an instance of a class of rclpy, if it is one."""
        if isinstance(kind, ast.Name) and isinstance(FACTS.get(self._of(kind.id)[0], {}).get(kind.id), dict):
            self._kinds[name] = self._names[kind.id]
        else:
            self._kinds.pop(name, None)

    def _of(self, name: str) -> tuple[str, str]:
        return self._names.get(name, ("", ""))

    def _fact(self, node: ast.expr) -> tuple[dict[str, Any], str] | None:
        """Return the facts of a module, a class or an instance that an expression stands for."""
        written = ast.unparse(node)
        if written in self._kinds:
            module, name = self._kinds[written]
            return FACTS[module][name], name
        module, name = self._of(written)
        if module and not name:
            return FACTS[module], module
        fact = FACTS.get(module, {}).get(name)
        return (fact, name) if isinstance(fact, dict) else None

    def _signature(self, node: ast.expr) -> inspect.Signature | None:
        """Return what the facts say that a called expression takes."""
        if isinstance(node, ast.Name):
            module, name = self._of(node.id)
            fact = FACTS.get(module, {}).get(name)
            return None if fact is None or (isinstance(fact, dict) and "init" not in fact) else called(fact, name)
        if isinstance(node, ast.Attribute) and (found := self._fact(node.value)) is not None:
            fact, where = found
            method = fact.get("members", fact).get(node.attr)
            if isinstance(method, str) and method.startswith("("):
                is_method = "members" in fact
                return called(method.replace("(self, ", "(").replace("(self)", "()") if is_method else method, where)
        return None

    def _note(self, is_there: bool, text: str) -> None:
        self.seen += 1
        if not is_there:
            self.wrong.append(text)


def used_in(source: str) -> Used:
    used = Used()
    used.visit(ast.parse(source))
    return used


def test_what_we_use_of_rclpy_is_there() -> None:
    assert USERS
    found = {path.name: used_in(path.read_text()) for path in USERS}
    assert {name: used.wrong for name, used in found.items() if used.wrong} == {}
    assert sum(used.seen for used in found.values()) > 60


@pytest.mark.parametrize(
    ("source", "wrong"),
    [
        ("from rclpy.service import RequestHeader", "rclpy.service has no RequestHeader"),
        ("import rclpy\nrclpy.create_nodes()", "rclpy has no create_nodes (line 2)"),
        ("from rclpy.qos import HistoryPolicy\nHistoryPolicy.KEEP_SOME", "HistoryPolicy has no KEEP_SOME (line 2)"),
        (
            "from rclpy.node import Node\ndef f(node: Node) -> None:\n    node.create_topic()",
            "Node has no create_topic (line 3)",
        ),
        (
            "from rclpy.node import Node\nclass A:\n    def f(self):\n        self.n = Node('a')\n"
            "    def g(self):\n        self.n.create_client(1, 'b', qos=2)",
            "self.n.create_client: got an unexpected keyword argument 'qos' (line 6)",
        ),
        (
            "from rclpy.qos import QoSProfile\nQoSProfile(depths=1)",
            "QoSProfile: got an unexpected keyword argument 'depths' (line 2)",
        ),
    ],
)
def test_what_is_not_there_is_found(source: str, wrong: str) -> None:
    assert used_in(source).wrong == [wrong]


def test_the_stubs_are_made_from_the_facts(tmp_path: Path) -> None:
    script, facts = BACKEND / "stubs" / "make_rclpy.py", Path(__file__).parent / "jazzy" / "rclpy.json"
    subprocess.run([sys.executable, str(script), str(facts), str(tmp_path)], check=True)
    made, kept = (read(folder) for folder in (tmp_path, BACKEND / "stubs" / "rclpy"))
    assert made == kept, "make them again: see stubs/make_rclpy.py"


def read(folder: Path) -> dict[str, str]:
    """Return the stubs of a folder, whatever the layout of their lines and the order of their imports."""
    found = {}
    for path in folder.glob("*.pyi"):
        body = ast.parse(path.read_text()).body
        imports = {
            f"{each.module} {name.name}" for each in body if isinstance(each, ast.ImportFrom) for name in each.names
        }
        rest = [ast.dump(each) for each in body if not isinstance(each, ast.ImportFrom)]
        found[path.name] = "\n".join([*sorted(imports), *rest])
    return found


def facts_of_classes() -> Iterator[tuple[str, str, str, str]]:
    """Yield module, class, member and signature of all methods."""
    for module, facts in FACTS.items():
        for name, fact in facts.items():
            if isinstance(fact, dict):
                for member, what in {**fact["members"], "__init__": fact.get("init", "")}.items():
                    yield module, name, member, what


@pytest.mark.skipif(
    importlib.util.find_spec("rclpy") is None,
    reason="rclpy is not importable here: run this suite where ROS 2 Jazzy is installed",
)
def test_the_facts_are_those_of_the_rclpy_that_is_here() -> None:
    checked = 0
    for module, name, member, what in facts_of_classes():
        kind = getattr(importlib.import_module(module), name)
        assert hasattr(kind, member), f"{module}.{name}.{member}"
        if what.startswith("(") and module != "rclpy._rclpy_pybind11":
            here = [*inspect.signature(getattr(kind, member)).parameters]
            there = [*parameters(what).parameters]
            assert [each for each in here if each != "self"] == [each for each in there if each != "self"]
            checked += 1
    assert checked > 30
