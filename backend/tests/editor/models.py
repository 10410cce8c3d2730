"""Models that drafts are made from."""

from __future__ import annotations

from pathlib import Path

from sequence_planner.model.files import read_files

BOLTS = Path(__file__).parents[3] / "models" / "bolt_tightening"
SPECIFICATIONS = "specifications.yaml"


def bolts(**changed: tuple[str, str]) -> dict[str, str]:
    """The files of the bolt tightening station; of each file that is named, by its stem, a text replaced by another."""
    files = read_files(BOLTS)
    for stem, (old, new) in changed.items():
        (path,) = [each for each in files if Path(each).stem == stem and each.endswith(".yaml")]
        assert old in files[path]
        files[path] = files[path].replace(old, new)
    return files
