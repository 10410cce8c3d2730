"""The version of this program, as the package that is installed says it."""

from __future__ import annotations

from importlib.metadata import version
from typing import Final

VERSION: Final = version("sequence-planner")
