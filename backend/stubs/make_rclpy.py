"""Write the stubs of rclpy from the facts of a genuine one.

    python stubs/make_rclpy.py tests/ros/jazzy/rclpy.json stubs/rclpy && ruff check --fix stubs && ruff format stubs

Names, parameters and what they are called with come from the facts alone. Where the facts leave a type open (rclpy has
many parameters and properties without one), `TYPES` says what our source relies on; whatever is left is `Any`.
"""

from __future__ import annotations

import ast
import json
import re
import sys
from pathlib import Path
from typing import Any

#: Types by `Class.member`, `Class.member.parameter` and `Class.member.return`.
TYPES = {
    "Client.handle": "rclpy._rclpy_pybind11.Client",
    "Client.take_response.return": "Tuple[Any, Any]",
    "Duration.nanoseconds": "int",
    "Future.add_done_callback.callback": "Callable[[rclpy.task.Future], None]",
    "Future.add_done_callback.return": "None",
    "Future.exception.return": "Optional[Exception]",
    "Future.result.return": "object",
    "Future.set_result.return": "None",
    "Node.create_publisher.msg_type": "type",
    "Node.create_subscription.msg_type": "type",
    "Node.destroy_node.return": "None",
    "QoSProfile.deadline": "rclpy.duration.Duration",
    "QoSProfile.depth": "int",
    "QoSProfile.durability": "rclpy.qos.DurabilityPolicy",
    "QoSProfile.history": "rclpy.qos.HistoryPolicy",
    "QoSProfile.liveliness": "rclpy.qos.LivelinessPolicy",
    "QoSProfile.liveliness_lease_duration": "rclpy.duration.Duration",
    "QoSProfile.reliability": "rclpy.qos.ReliabilityPolicy",
    "Service.handle": "rclpy._rclpy_pybind11.Service",
    "Service.service_take_request.return": "Tuple[Any, Any]",
    "Subscription.take_message.return": "Any",
    "Subscription.handle": "rclpy._rclpy_pybind11.Subscription",
    "TopicEndpointInfo.endpoint_gid": "List[int]",
    "TopicEndpointInfo.node_name": "str",
    "TopicEndpointInfo.node_namespace": "str",
    "TopicEndpointInfo.qos_profile": "rclpy.qos.QoSProfile",
    "TopicEndpointInfo.topic_type": "str",
    "TopicEndpointInfo.topic_type_hash": "rclpy.type_hash.TypeHash",
    "TypeHash.value": "bytes",
    "TypeHash.version": "int",
    "deserialize_message.return": "object",
    "qos_policy_name_from_kind.return": "str",
}
CPP = "rclpy._rclpy_pybind11"
#: Of a status of the middleware all properties are numbers.
NUMBERS = re.compile(r"QoS\w+Info\.\w+")
#: Classes of the C++ part that rclpy gives another name or place.
PLACES = {"rclpy._rclpy_pybind11.SignalHandlerOptions": "rclpy.signals.SignalHandlerOptions"}
BUILTIN = {"List": "list", "Tuple": "tuple", "Dict": "dict", "Type": "type"}
KNOWN = {"str", "int", "bool", "float", "bytes", "object", "type", "tuple", "list", "dict", "None", "Exception"}


class Module:
    """One stub as it is written."""

    def __init__(self, name: str, facts: dict[str, dict[str, Any]]) -> None:
        self._name = name
        self._facts = facts
        self._imports: set[tuple[str, str]] = set()

    def text(self) -> str:
        """Return the stub."""
        body = [
            self._function(name, fact, name) if isinstance(fact, str) else self._class(name, fact)
            for name, fact in self._facts[self._name].items()
        ]
        imports = [f"from {module} import {name}" for module, name in sorted(self._imports)]
        return "\n".join(["# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.", *imports, *body, ""])

    def _class(self, name: str, fact: dict[str, Any]) -> str:
        kind = str(fact.get("is", ""))
        if kind == "IntEnum":
            self._imports.add(("enum", kind))
        members: dict[str, str] = fact["members"]
        lines = []
        if "init" in fact:
            init = str(fact["init"]).replace("(**kwargs)", self._keywords(name, members))
            lines.append(self._function("__init__", f"(self, {init[1:]}".replace(", )", ")"), f"{name}.init"))
        for member, what in members.items():
            if what == name:
                lines.append(f"{member} = ..." if kind == "IntEnum" else f"{member}: {name}")
            elif what == "property":
                lines.append(f"{member}: {self._type(TYPES.get(f'{name}.{member}') or self._number(name, member))}")
            else:
                lines.append(self._function(member, what, f"{name}.{member}"))
        return f"class {name}{f'({kind})' if kind else ''}:\n" + "\n".join(f"    {line}" for line in lines or ["..."])

    def _number(self, name: str, member: str) -> str:
        return "int" if NUMBERS.fullmatch(f"{name}.{member}") else "Any"

    def _keywords(self, name: str, members: dict[str, str]) -> str:
        """Return the keywords of a class that takes any: its properties."""
        return "(*, " + ", ".join(f"{each}: {TYPES.get(f'{name}.{each}', 'Any')} = ..." for each in members) + ")"

    def _function(self, name: str, signature: str, path: str) -> str:
        # A type variable of no use without its class is any type.
        [made] = ast.parse(f"def {name}{re.sub(r'~[A-Za-z]+', 'Any', signature)}: ...").body
        assert isinstance(made, ast.FunctionDef)
        arguments = made.args
        every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
        for each in every:
            if each is not None and each.arg != "self":
                written = None if each.annotation is None else ast.unparse(each.annotation)
                each.annotation = _parsed(self._type(TYPES.get(f"{path}.{each.arg}") or written))
        returned = "None" if name == "__init__" else None if made.returns is None else ast.unparse(made.returns)
        made.returns = _parsed(self._type(TYPES.get(f"{path}.return") or returned))
        ellipsis = ast.Constant(...)
        arguments.defaults = [ellipsis for _ in arguments.defaults]
        arguments.kw_defaults = [None if each is None else ellipsis for each in arguments.kw_defaults]
        return " ".join(ast.unparse(made).split())

    def _type(self, written: str | None) -> str:
        """Return a type as this stub writes it, with what it needs imported."""
        return ast.unparse(self._modern(_parsed(written or "Any")))

    def _modern(self, node: ast.expr) -> ast.expr:
        if isinstance(node, ast.Subscript):
            outer = ast.unparse(node.value)
            inner = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
            if outer in ("Optional", "Union"):
                each = [ast.unparse(self._modern(part)) for part in inner]
                return _parsed(" | ".join(dict.fromkeys([*each, *(["None"] if outer == "Optional" else [])])))
            node.value = self._named(outer, called=True)
            made = [self._modern(part) for part in inner]
            node.slice = ast.Tuple(made) if len(made) > 1 else made[0]
            return node
        if isinstance(node, ast.List):
            return ast.List([self._modern(part) for part in node.elts])
        return node if isinstance(node, ast.Constant) and node.value is None else self._named(ast.unparse(node))

    def _named(self, written: str, called: bool = False) -> ast.expr:
        if written == "...":
            return ast.Constant(...)
        module, _, name = PLACES.get(written.strip("'"), written.strip("'")).rpartition(".")
        name = BUILTIN.get(name, name)
        holder = module or next((each for each in self._facts if each != CPP and name in self._facts[each]), "")
        if holder == CPP and self._name != CPP:  # Its classes bear the names of those that hold them.
            package, _, module = CPP.partition(".")
            known = name in self._facts[CPP]
            self._imports.add((package, module) if known else ("typing", "Any"))
            return _parsed(f"{module}.{name}" if known else "Any")
        if name in self._facts.get(holder, {}):
            if holder != self._name:
                self._imports.add((holder, name))
        elif name == "Callable":
            self._imports.add(("collections.abc", name))
            if not called:
                self._imports.add(("typing", "Any"))
                return _parsed("Callable[..., Any]")
        elif module or name not in KNOWN:
            name = "Any"
            self._imports.add(("typing", name))
        return _parsed(name)


def _parsed(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def main(facts: Path, folder: Path) -> None:
    """Write a stub for each module of the facts."""
    modules = json.loads(facts.read_text(encoding="utf-8"))["modules"]
    folder.mkdir(parents=True, exist_ok=True)
    for name in modules:
        file = folder / f"{name.partition('.')[2] or '__init__'}.pyi"
        file.write_text(Module(name, modules).text(), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
