"""Models that drafts are made from."""

from __future__ import annotations

from pathlib import Path

from sequence_planner.model.files import read_files
from support.places import BOLT_TIGHTENING

SPECIFICATIONS = "specifications.yaml"


def bolts(**changed: tuple[str, str]) -> dict[str, str]:
    """The files of the bolt tightening station; of each file that is named, by its stem, a text replaced by another."""
    files = read_files(BOLT_TIGHTENING)
    for stem, (old, new) in changed.items():
        (path,) = [each for each in files if Path(each).stem == stem and each.endswith(".yaml")]
        assert old in files[path]
        files[path] = files[path].replace(old, new)
    return files
