"""The state of emulated devices, kept in a file, so that those of another model can go on from there.

What exists in both models goes on: measured values, commands that were heard, and the numbers behind discretised
values. All else begins as the model says. What was under way sets out once more, and faults are over.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sequence_planner.language.types import Value
    from sequence_planner.simulation.devices import EmulatedDevices
    from sequence_planner.simulation.messages import Message


def standing_file(beside: Path) -> Path:
    """Return where the devices that run beside a controller, with its socket in `beside`, are kept; there once they are
    up.
    """
    return beside / "emulated.json"


@dataclass(frozen=True)
class DeviceState:
    """The values of measured variables and outputs, and what was said last on each topic; None is unknown."""

    values: dict[str, Value | None] = field(default_factory=dict)
    messages: dict[str, Message] = field(default_factory=dict)


def save_state(devices: EmulatedDevices, file: Path) -> None:
    """Write down how the devices stand, whole or not at all. Raises `OSError`."""
    document = {"values": devices.state, "messages": {topic: devices.report(topic) for topic in devices.spoken}}
    new = file.with_suffix(".new")
    new.write_text(json.dumps(document, default=_unknown), encoding="utf-8")
    new.replace(file)


def read(file: Path) -> DeviceState:
    """Return how devices stood; nothing where nothing was written, or it cannot be read."""
    try:
        document: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        return DeviceState(dict(document["values"]), dict(document["messages"]))
    except (OSError, ValueError, KeyError, TypeError):
        return DeviceState()


def _unknown(value: object) -> None:
    """Return None for what no file of JSON can hold, such as bytes: no discretised variable is made of it."""
