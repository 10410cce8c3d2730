"""The standard types are those of rosbags, though it is not asked for them."""

from __future__ import annotations

import subprocess
import sys

from rosbags.typesys import Stores, get_typestore

from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.standard_types import known_to_rosbags, standard_store


def test_the_fields_are_those_of_rosbags() -> None:
    ours, theirs = standard_store().fielddefs, known_to_rosbags()
    assert theirs
    assert {name: ours[name] for name in theirs} == theirs


def test_the_bytes_are_those_of_rosbags() -> None:
    theirs, registry = get_typestore(Stores.ROS2_JAZZY), MessageRegistry()
    for name in theirs.fielddefs:
        encoded = registry.encode(name, {})
        again = theirs.deserialize_cdr(encoded, name)
        assert bytes(theirs.serialize_cdr(again, name, little_endian=True)) == encoded, name
        ours, known = standard_store().types[name], theirs.types[name]
        assert list(vars(ours)["__dataclass_fields__"]) == list(vars(known)["__dataclass_fields__"])


def test_no_class_is_made_before_one_is_used() -> None:
    code = (
        "import sys; from sequence_planner.ros.types.messages import MessageRegistry; MessageRegistry()\n"
        "print(*(name for name in sys.modules if name.startswith(('rosbags.typesys.stores.', 'numpy'))))"
    )
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert printed.split() == []
