"""Makes an sdist and, of that, a wheel, both with the built page and the example stations:
python packaging/distribute.py PAGE FOLDER.
"""

from __future__ import annotations

import contextlib
import shutil
import sys
import tarfile
import tempfile
from pathlib import Path

from setuptools import build_meta

BACKEND = Path(__file__).resolve().parents[1]
README = '[project]\nreadme = "README.md"\n'  # which lies beside the project only where it is distributed
LEFT_OUT = shutil.ignore_patterns("__pycache__", "*.egg-info", "page", "models")


def distribute(page: Path, to: Path) -> list[Path]:
    """Write both to the folder `to`; `page` is the folder of the built page. Their paths."""
    if not (page / "index.html").is_file():
        raise SystemExit(f"{page} holds no built page: make page")
    to = to.resolve()
    to.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        staged = Path(folder) / "staged"
        shutil.copytree(BACKEND / "src", staged / "src", ignore=LEFT_OUT)
        shutil.copytree(page, staged / "src" / "sequence_planner" / "page")
        shutil.copytree(BACKEND.parent / "models", staged / "src" / "sequence_planner" / "models", ignore=LEFT_OUT)
        project = (BACKEND / "pyproject.toml").read_text(encoding="utf-8")
        (staged / "pyproject.toml").write_text(project.replace("[project]\n", README, 1), encoding="utf-8")
        shutil.copy(BACKEND.parent / "README.md", staged)
        with contextlib.chdir(staged):
            sdist = to / build_meta.build_sdist(str(to))
        with tarfile.open(sdist) as archive:
            archive.extractall(folder, filter="data")
        with contextlib.chdir(Path(folder) / sdist.name.removesuffix(".tar.gz")):
            wheel = to / build_meta.build_wheel(str(to))
    return [sdist, wheel]


if __name__ == "__main__":
    for each in distribute(Path(sys.argv[1]).resolve(), Path(sys.argv[2])):
        sys.stderr.write(f"{each}\n")
