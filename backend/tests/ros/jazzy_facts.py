"""Facts of a genuine ROS 2 Jazzy, for where none is installed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pydantic import BaseModel

FACTS = Path(__file__).with_name("jazzy")


class Announced(BaseModel):
    """An endpoint as a genuine node announces it."""

    direction: str
    topic: str
    type: str
    user_data: str
    depth: int | None
    transient_local: bool

    @property
    def tells(self) -> dict[str, str]:
        """What the user data say, by key."""
        return dict(part.split("=", 1) for part in self.user_data.split(";") if part)


def announced() -> list[Announced]:
    """Return all endpoints of `endpoints.json`."""
    found = json.loads((FACTS / "endpoints.json").read_text(encoding="utf-8"))["endpoints"]
    return [Announced.model_validate(each) for each in found]


def rclpy_facts() -> dict[str, dict[str, Any]]:
    """Return what rclpy has, by module: the signature of a function, and what a class has."""
    facts: dict[str, dict[str, Any]] = json.loads((FACTS / "rclpy.json").read_text(encoding="utf-8"))["modules"]
    return facts
