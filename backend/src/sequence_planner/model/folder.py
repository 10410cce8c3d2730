"""What lies in a station's folder."""

from __future__ import annotations

FOLDERS = ("resources", "messages", "stages")
# What files below `messages` define, by what their names end with.
DEFINITIONS = {"msg": "message", "srv": "service", "action": "action"}
# The documents of a station beside its resources.
FILES = ("station.yaml", "operations.yaml", "specifications.yaml", "work_masters.yaml")
