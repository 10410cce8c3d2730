"""Prints the OpenAPI document: `python -m sequence_planner.server.openapi > frontend/openapi.json`.

The same source always gives the same text, so that a committed copy shows by its difference what changed.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.server.app import create_app
from sequence_planner.server.settings import Settings


def document() -> str:
    """The OpenAPI document as sorted, indented JSON with a final newline."""
    nowhere = Path("controller.sock")
    settings = Settings(controller_socket=nowhere, page=Path("page"), database="sqlite:////nowhere/station.sqlite")
    app = create_app(settings, ControllerClient(nowhere))
    return json.dumps(app.openapi(), indent=2, sort_keys=True, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    sys.stdout.write(document())
