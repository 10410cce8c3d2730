"""All texts that people read of a running station, in English, by their ids.

`make types` writes them for the page, whose Swedish ones are in `frontend/src/lib/text/sv/messages.json`.
"""

from __future__ import annotations

from typing import Final

from sequence_planner.texts.alarms import ALARMS
from sequence_planner.texts.station import STATION

TEXTS: Final = ALARMS | STATION


if __name__ == "__main__":
    import json
    import sys
    from pathlib import Path

    Path(sys.argv[1]).write_text(json.dumps(TEXTS, indent="\t", ensure_ascii=False) + "\n", encoding="utf-8")
