"""Whether two stations run the same model: a digest of its files, the Python stages of its pipelines among them."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from sequence_planner.workshop.files import STAGES, read_files


def digest_of(folder: Path) -> str:
    """64 hexadecimal digits over the texts of the model in `folder`. Raises `OSError`."""
    stages = {str(path.relative_to(folder)): path.read_bytes().hex() for path in (folder / STAGES).rglob("*.py")}
    texts = json.dumps([read_files(folder), stages], sort_keys=True)
    return hashlib.sha256(texts.encode()).hexdigest()
