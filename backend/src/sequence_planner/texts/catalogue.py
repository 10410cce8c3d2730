"""All texts that people read of a running station, in English, by their ids.

`make types` writes them for the page: those of `front`, which are read with every page, those of `findings` and
`wrong`, and the others. Its Swedish ones are in files of the same names in `frontend/src/lib/text/sv`.
"""

from __future__ import annotations

from typing import Final

from sequence_planner.texts.alarms import ALARMS
from sequence_planner.texts.findings import FINDINGS
from sequence_planner.texts.front import FRONT
from sequence_planner.texts.refusals import REFUSALS
from sequence_planner.texts.station import STATION
from sequence_planner.texts.wrong import WRONG

TEXTS: Final = FRONT | ALARMS | STATION | REFUSALS | FINDINGS | WRONG


if __name__ == "__main__":
    import json
    import sys
    from pathlib import Path

    for name, texts in (("front", FRONT), ("messages", ALARMS | STATION | REFUSALS), ("findings", FINDINGS | WRONG)):
        written = json.dumps(texts, indent="\t", ensure_ascii=False)
        Path(sys.argv[1], f"{name}.json").write_text(f"{written}\n", encoding="utf-8")
