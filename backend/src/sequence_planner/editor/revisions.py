"""Revisions of a model: its files as somebody saved them under a name, each a commit of a git repository.

The repository is the station's own. Whoever wants to can clone it; nothing is done to one that the folder of the model
may be in.
"""

from __future__ import annotations

import re
import stat
from collections.abc import Iterator
from pathlib import Path

from dulwich.index import commit_tree
from dulwich.object_store import BaseObjectStore, MemoryObjectStore
from dulwich.objects import Blob, Commit, ObjectID
from dulwich.objectspec import parse_commit
from dulwich.refs import Ref
from dulwich.repo import Repo

from sequence_planner.core.actor import SYSTEM, Actor
from sequence_planner.editor.revision import Revision, in_commit
from sequence_planner.model.files import Files, content_of, text_of
from sequence_planner.model.paths import EditError
from sequence_planner.texts.message import message

BRANCH = Ref(b"refs/heads/main")
LONGEST_NAME = 100  # characters
BEFORE = "As the station was"
_ID = re.compile("[0-9a-f]{40}")
_AT = "@station"


class Revisions:
    """The revisions that are kept in the repository at `folder`, which is made with the first of them."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def save(self, files: Files, base: Files, name: str, text: str, by: Actor, now: float) -> Revision:
        """Save `files` under a name; the first one follows `base`, the files that it was made from. Raises `EditError`
        for a name that is empty, too long or taken, and where nothing differs from the last revision.
        """
        name = " ".join(name.split())
        if not 0 < len(name) <= LONGEST_NAME:
            raise EditError(message("edit.revision-name", most=LONGEST_NAME))
        known = list(self.all())
        if any(each.name == name for each in known):
            raise EditError(message("edit.revision-taken", name=name))
        if known and known[0].tree == tree_of(files):
            raise EditError(message("edit.revision-same", name=known[0].name))
        with self._repository() as repository:
            if not known and base and base != files:
                _commit(repository, base, BEFORE, "", SYSTEM, now)
            return _revision(_commit(repository, files, name, text.strip(), by, now))

    def all(self) -> Iterator[Revision]:
        """All of them, newest first."""
        if not (self._folder / "HEAD").exists():
            return
        with self._repository() as repository:
            if BRANCH in repository.refs.allkeys():
                for entry in repository.get_walker(include=[repository.refs[BRANCH]]):
                    yield _revision(entry.commit)

    def find(self, id: str) -> Revision:
        """One of them. Raises `EditError` where there is none."""
        found = next((each for each in self.all() if each.id == id), None) if _ID.fullmatch(id) else None
        if found is None:
            raise EditError(message("edit.no-revision", revision=id))
        return found

    def files(self, id: str) -> dict[str, str]:
        """The files of a revision. Raises `EditError` where there is none."""
        self.find(id)
        with self._repository() as repository:
            commit = parse_commit(repository, id.encode())
            entries = repository.object_store.iter_tree_contents(commit.tree)
            contents = ((entry.path.decode(), repository[entry.sha].as_raw_string()) for entry in entries)
            return {path: text for path, content in contents if (text := text_of(path, content)) is not None}

    def _repository(self) -> Repo:
        if (self._folder / "HEAD").exists():
            return Repo(str(self._folder))
        self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        return Repo.init_bare(str(self._folder), default_branch=b"main")


def tree_of(files: Files) -> str:
    """The hash of the files together; the same as that of another revision only if they are the same."""
    return _tree(MemoryObjectStore(), files).decode()


def _tree(store: BaseObjectStore, files: Files) -> ObjectID:
    blobs: list[tuple[bytes, ObjectID, int]] = []
    for path, text in sorted(files.items()):
        blob = Blob.from_string(content_of(path, text))
        store.add_object(blob)
        blobs.append((path.encode(), blob.id, stat.S_IFREG | 0o644))
    return commit_tree(store, blobs)


def _commit(repository: Repo, files: Files, name: str, message: str, by: Actor, now: float) -> Commit:
    store = repository.object_store
    commit = Commit()
    commit.tree = _tree(store, files)
    commit.parents = [repository.refs[BRANCH]] if BRANCH in repository.refs.allkeys() else []
    who = f"{in_commit(by.name)} <{in_commit(by.id)}{_AT}>".encode()
    commit.author = commit.committer = who
    commit.author_time = commit.commit_time = int(now)
    commit.author_timezone = commit.commit_timezone = 0
    commit.encoding = b"UTF-8"
    commit.message = f"{name}\n\n{message}\n".encode() if message else f"{name}\n".encode()
    store.add_object(commit)
    repository.refs[BRANCH] = commit.id
    return commit


def _revision(commit: Commit) -> Revision:
    name, _, message = commit.message.decode(errors="replace").partition("\n")
    by, _, author = commit.author.decode(errors="replace").removesuffix(">").rpartition(" <")
    return Revision(
        commit.id.decode(),
        name,
        message.strip(),
        by,
        float(commit.commit_time),
        commit.tree.decode(),
        author.removesuffix(_AT),
    )
