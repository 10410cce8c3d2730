"""Packages brought into the folder of a station: from folders and git repositories, as files alone.

git is asked for the names and contents of files; nothing is checked out and nothing of a package is run.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import NamedTuple

from sequence_planner.model.documents import PackageSourceDocument, StationDocument
from sequence_planner.model.files import (
    LONGEST_FILE,
    MOST_CHARACTERS,
    MOST_FILES,
    is_of_package,
    is_package_name,
    package_files,
)
from sequence_planner.model.types.packages import (
    FOLDER,
    LOCK,
    MANIFEST,
    LockedPackage,
    PackageError,
    digest_of,
    read_lock,
    read_manifest,
    source_of,
)
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.model.yaml.saving import BYTE_ORDER_MARK

SECONDS = 300.0  # that git may take
_ADDRESS = re.compile(r"(?:https|ssh|file)://[^\s]+")
_REVISION = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_./-]*")
_LINK, _FILES = "120000", ("100644", "100755")
_ALLOWED = ("protocol.allow=never", *(f"protocol.{each}.allow=always" for each in ("https", "ssh", "file")))
_SAFE = tuple(part for each in _ALLOWED for part in ("-c", each))


class Brought(NamedTuple):
    """A package that was brought: whether it is another one than before, and what is locked of it."""

    name: str
    version: str
    revision: str | None
    hash: str
    is_new: bool


def bring_packages(folder: Path, station: StationDocument, update: Collection[str] = ()) -> list[Brought]:
    """Bring all packages that a station names: as they are locked, and those to `update` as their source has them now.

    What is here as it is locked stays, whatever has become of its source. One that station.yaml names another source of
    is not locked any more. Raises `PackageError` and `ModelError`; then nothing has changed.
    """
    locked = read_lock(folder)
    found = {str(name): _found(folder, str(name), source, locked, update) for name, source in station.packages.items()}
    brought = []
    for name, (files, revision) in found.items():
        version = str(read_manifest(files[MANIFEST], f"{name}: {MANIFEST}").version)
        before = locked.get(name)
        is_new = before is None or before.hash != digest_of(files)
        brought.append(Brought(name, version, revision, digest_of(files), is_new))
    for name, (files, _) in found.items():
        _put(files, folder / FOLDER / name)
    _write_lock(folder, station, brought)
    return brought


def _found(
    folder: Path,
    name: str,
    source: PackageSourceDocument,
    locked: Mapping[str, LockedPackage],
    update: Collection[str],
) -> tuple[dict[str, str], str | None]:
    """The files of a package and the commit they are of."""
    before = locked.get(name)
    if not is_package_name(name):
        raise PackageError(f"`{name}` is no name of a package: use letters, digits and `_`")
    is_kept = before is not None and name not in update and before.source == source_of(source)
    if before is not None and is_kept and digest_of(here := package_files(folder / FOLDER / name)) == before.hash:
        return here, None if before.revision is None else str(before.revision)
    revision = None
    if source.git is None:
        files = package_files((folder / str(source.path)).resolve())
    else:
        wanted = str(before.revision if before is not None and is_kept else source.revision)
        files, revision = _of_repository(name, str(source.git), wanted)
    _require_sound(name, files)
    if before is not None and is_kept and digest_of(files) != before.hash:
        raise PackageError(
            f"the package `{name}` cannot be brought as it is locked: {source_of(source)} has another one by now than "
            f"{LOCK} has the hash of. Bring {FOLDER}/{name} back from the history of the model, or let "
            f"`packages update {name}` lock what its source has now"
        )
    return files, revision


def _require_sound(name: str, files: Mapping[str, str]) -> None:
    if MANIFEST not in files:
        raise PackageError(f"the package `{name}`: there is no {MANIFEST} where it is brought from")
    if len(files) > MOST_FILES or sum(map(len, files.values())) > MOST_CHARACTERS:
        raise PackageError(
            f"the package `{name}` is too large: {MOST_FILES} files, {MOST_CHARACTERS} characters at most"
        )
    manifest = read_manifest(files[MANIFEST], f"{name}: {MANIFEST}")
    if manifest.name != name:
        raise PackageError(f"the package `{name}` calls itself `{manifest.name}`: call it so in station.yaml")
    for file, text in files.items():
        if file.endswith(".yaml"):
            read_text(text, f"{name}: {file}")


def _of_repository(name: str, address: str, revision: str) -> tuple[dict[str, str], str]:
    if not _ADDRESS.fullmatch(address):
        raise PackageError(
            f"the package `{name}`: `{address}` is no address that begins with https, ssh or file and ://"
        )
    if not _REVISION.fullmatch(revision) or ".." in revision:
        raise PackageError(f"the package `{name}`: `{revision}` is no tag, branch or commit")
    with tempfile.TemporaryDirectory() as beside:
        repository = Path(beside) / "repository"
        _git(name, None, "clone", "--quiet", "--bare", "--", address, str(repository))
        commit = _git(name, repository, "rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}").decode().strip()
        files: dict[str, str] = {}
        for line in _git(name, repository, "ls-tree", "-r", "-z", "--long", commit).split(b"\0"):
            if not line:
                continue
            about, _, path = line.decode("utf-8", "replace").partition("\t")
            mode, _, blob, size = about.split()
            if not is_of_package(path):
                continue
            if mode == _LINK or mode not in _FILES:
                raise PackageError(f"the package `{name}`: {path} is a link, and a package has files alone")
            if int(size) > LONGEST_FILE or len(files) >= MOST_FILES:
                raise PackageError(f"the package `{name}`: {path} is too large")
            files[path] = _text(name, path, _git(name, repository, "cat-file", "blob", blob))
        return files, commit


def _text(name: str, path: str, data: bytes) -> str:
    try:
        return data.decode("utf-8").removeprefix(BYTE_ORDER_MARK).replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise PackageError(f"the package `{name}`: {path} is not UTF-8 text") from error


def _git(name: str, repository: Path | None, *arguments: str) -> bytes:
    where = () if repository is None else ("--git-dir", str(repository))
    surroundings = {**os.environ, "GIT_TERMINAL_PROMPT": "0"}
    try:
        done = subprocess.run(
            ["git", *_SAFE, *where, *arguments],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=SECONDS,
            check=False,
            env=surroundings,
        )
    except FileNotFoundError as error:
        raise PackageError("packages are brought from repositories with `git`, which is not installed here") from error
    except subprocess.TimeoutExpired as error:
        raise PackageError(f"the package `{name}`: git has not answered within {SECONDS:g} s") from error
    if done.returncode:
        said = done.stderr.decode("utf-8", "replace").strip().split("\n")[-1] or "there is no such revision"
        raise PackageError(f"the package `{name}` cannot be brought: {said}")
    return done.stdout


def _put(files: Mapping[str, str], home: Path) -> None:
    """Let a folder hold these files and no others."""
    home.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=home.parent, prefix=".") as beside:
        new = Path(beside) / "new"
        for file, text in files.items():
            (new / file).parent.mkdir(parents=True, exist_ok=True)
            (new / file).write_text(text, encoding="utf-8", newline="")
        if home.is_symlink():
            home.unlink()
        elif home.exists():
            shutil.move(home, Path(beside) / "old")
        new.replace(home)


def _write_lock(folder: Path, station: StationDocument, brought: Collection[Brought]) -> None:
    sources = {str(name): source_of(source) for name, source in station.packages.items()}
    lines = ["# What was brought of each package: written by `sequence-planner packages`.\n"]
    for each in brought:
        revision = f'  revision: "{each.revision}"\n' if each.revision else ""
        source = sources[each.name].replace("\\", "\\\\").replace('"', '\\"')
        lines.append(
            f'{each.name}:\n  source: "{source}"\n  version: "{each.version}"\n{revision}  hash: "{each.hash}"\n'
        )
    (folder / LOCK).write_text("".join(lines), encoding="utf-8")
