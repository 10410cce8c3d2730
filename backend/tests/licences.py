"""Judges licences of what runs with the station: nothing may oblige whoever passes it on to open all of it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from importlib.metadata import PackageMetadata, PackageNotFoundError, metadata
from pathlib import Path
from typing import Final

from packaging.requirements import Requirement

# By SPDX. Weak copyleft (MPL, EPL, LGPL) obliges to what was changed in the package itself alone.
FINE: Final = frozenset(
    [
        *(
            "0BSD",
            "Apache-2.0",
            "BSD-2-Clause",
            "BSD-3-Clause",
            "BSL-1.0",
            "CC0-1.0",
            "ISC",
            "MIT",
            "MIT-0",
            "OFL-1.1",
            "PSF-2.0",
        ),
        *("Python-2.0", "Unlicense", "Zlib"),
        *("EPL-2.0", "LGPL-2.1-only", "LGPL-2.1-or-later", "LGPL-3.0-only", "LGPL-3.0-or-later", "MPL-2.0"),
    ]
)
REFUSED: Final = re.compile(r"(A?GPL|SSPL|EUPL|OSL|CC-BY-SA|CC-BY-NC|RPL|CPAL|QPL)-", re.IGNORECASE)
# What packages say in words of their own, in place of SPDX.
WORDS: Final = {
    "3-Clause BSD License": "BSD-3-Clause",
    "Apache 2.0": "Apache-2.0",
    "Apache Software License": "Apache-2.0",
    "BSD License": "BSD-3-Clause",
    "EPL-2.0, BSD-3-Clause": "EPL-2.0 AND BSD-3-Clause",
    "ISC License (ISCL)": "ISC",
    "MIT License": "MIT",
    "Mozilla Public License 2.0 (MPL 2.0)": "MPL-2.0",
    "Python Software Foundation License": "PSF-2.0",
    "any-OSI": "MIT",  # whichever one likes
}
_CLASSIFIER: Final = "License :: OSI Approved :: "
_TOKEN: Final = re.compile(r"\(|\)|[^\s()]+")


def trouble(licence: str) -> str | None:
    """Why a licence is not taken, None where it is: an SPDX expression, or what a package says in its own words."""
    words = licence.strip()
    expression = WORDS.get(words, WORDS.get(words.partition("\n")[0].strip(), words))
    try:
        return _Expression(expression).trouble
    except (IndexError, ValueError):
        return f"`{words[:60]}` is not known"


class _Expression:
    """An SPDX expression: of `OR` one has to be fine, of `AND` both."""

    def __init__(self, text: str) -> None:
        self._left = _TOKEN.findall(text)
        self.trouble = self._one_of()
        if self._left:
            raise ValueError(text)

    def _one_of(self) -> str | None:
        found = [self._all_of()]
        while self._take("OR"):
            found.append(self._all_of())
        return None if None in found else found[0]

    def _all_of(self) -> str | None:
        found = [self._single()]
        while self._take("AND"):
            found.append(self._single())
        return next((each for each in found if each is not None), None)

    def _single(self) -> str | None:
        if self._take("("):
            inner = self._one_of()
            if not self._take(")"):
                raise ValueError("a bracket is open")
            return inner
        name = self._left.pop(0)
        if self._take("WITH"):
            name += f" WITH {self._left.pop(0)}"
        if name in FINE:
            return None
        return f"`{name}` is copyleft" if REFUSED.match(name) else f"`{name}` is not known"

    def _take(self, token: str) -> bool:
        if self._left and self._left[0].upper() == token:
            self._left.pop(0)
            return True
        return False


def licences(found: PackageMetadata) -> list[str]:
    """What a package says of itself, each of which has to be fine; empty if it says nothing."""
    if expression := found.get_all("License-Expression"):
        return list(expression)
    classifiers = [each for each in found.get_all("Classifier") or [] if each.startswith("License ::")]
    told = [each.removeprefix(_CLASSIFIER) for each in classifiers if each != _CLASSIFIER.removesuffix(" :: ")]
    text = "".join(found.get_all("License") or []).strip()
    return told or ([text] if text else [])


def locked(lock: Path) -> Iterator[str]:
    """The packages of a lock file that belong on this machine."""
    for line in lock.read_text(encoding="utf-8").splitlines():
        if re.match(r"[A-Za-z0-9]", line):
            requirement = Requirement(line.rstrip(" \\"))
            if requirement.marker is None or requirement.marker.evaluate():
                yield requirement.name


def troubles(lock: Path, read: Callable[[str], PackageMetadata] = metadata) -> list[str]:
    """What is wrong with the licences of a lock file's packages, and what to do."""
    found = []
    for name in locked(lock):
        try:
            told = licences(read(name))
        except PackageNotFoundError:
            found.append(f"{name} is locked and not installed: run make install")
            continue
        why = next((each for each in map(trouble, told) if each), None) if told else "it names no licence"
        if why is not None:
            found.append(
                f"{name}: {why}. Take another package, or write it yourself. Where its licence is fine, see what it "
                "says and name that in tests/licences.py"
            )
    return found
