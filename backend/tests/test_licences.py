"""What is installed to run the station, and what its page is made of, may be passed on with a product."""

from __future__ import annotations

import json
from email.message import Message
from importlib.metadata import PackageMetadata
from pathlib import Path
from typing import cast

import pytest

from licences import licences, locked, trouble, troubles
from support.places import BACKEND


def test_no_package_of_the_run_time_set_is_copyleft() -> None:
    lock = BACKEND / "requirements.lock"
    assert {"fastapi", "psycopg", "ortools"} <= set(locked(lock))
    assert troubles(lock) == []


def test_nothing_that_the_page_is_made_of_is_copyleft() -> None:
    packages = json.loads((BACKEND.parent / "frontend/package-lock.json").read_text())["packages"]
    told = {name: each.get("license", "") for name, each in packages.items() if name}
    assert len(told) > 100
    assert {name: why for name, licence in told.items() if (why := trouble(licence))} == {}


@pytest.mark.parametrize(
    "fine",
    [
        "MIT",
        "Apache-2.0 OR GPL-2.0-or-later",
        "(MIT OR CC0-1.0)",
        "BSD-3-Clause AND 0BSD AND MIT AND Zlib AND CC0-1.0",
        "LGPL-3.0-only",
        "MPL-2.0",
        "MIT AND (GPL-3.0-only OR ISC)",
        "Apache Software License",
        "MIT License\n\nCopyright (c) 2022 Somebody",
        " any-OSI ",
    ],
)
def test_what_is_taken(fine: str) -> None:
    assert trouble(fine) is None


@pytest.mark.parametrize(
    ("licence", "says"),
    [
        ("GPL-2.0-or-later", "`GPL-2.0-or-later` is copyleft"),
        ("AGPL-3.0-only", "is copyleft"),
        ("MIT AND GPL-3.0-only", "`GPL-3.0-only` is copyleft"),
        ("GPL-2.0-or-later WITH Classpath-exception-2.0", "is copyleft"),
        ("(AGPL-3.0-only OR SSPL-1.0)", "is copyleft"),
        ("GNU General Public License v3 (GPLv3)", "is not known"),
        ("Proprietary", "`Proprietary` is not known"),
        ("MIT OR", "is not known"),
        ("(MIT", "is not known"),
        ("MIT ISC", "is not known"),
        ("", "is not known"),
    ],
)
def test_what_is_refused(licence: str, says: str) -> None:
    assert says in (trouble(licence) or "")


def package(**fields: str | list[str]) -> PackageMetadata:
    message = Message()
    for name, values in fields.items():
        for value in [values] if isinstance(values, str) else values:
            message[name.replace("_", "-")] = value
    return cast(PackageMetadata, message)


def test_where_a_package_says_its_licence() -> None:
    approved = "License :: OSI Approved"
    gnu = f"{approved} :: GNU General Public License v2 (GPLv2)"
    assert licences(package(License_Expression="MIT", License="GPL", Classifier=gnu)) == ["MIT"]
    assert licences(package(License="MIT", Classifier=[gnu, f"{approved} :: MIT License", "Topic :: Software"])) == [
        "GNU General Public License v2 (GPLv2)",
        "MIT License",
    ]
    assert licences(package(License=" BSD-3-Clause ", Classifier=[approved])) == ["BSD-3-Clause"]
    assert licences(package(Name="silent")) == []


def test_what_is_wrong_is_named_with_what_to_do(tmp_path: Path) -> None:
    lock = tmp_path / "some.lock"
    lock.write_text(
        "# made\nmerge3==1.0.0 \\\n    --hash=sha256:00\nsilent==1 \\\nfine==1\n"
        "windows==1 ; sys_platform == 'win32' \\\n"
    )
    known = {
        "merge3": package(License_Expression="GPL-2.0-or-later"),
        "silent": package(Name="silent"),
        "fine": package(License="MIT"),
    }
    copyleft, silent = troubles(lock, known.__getitem__)
    assert copyleft.startswith("merge3: `GPL-2.0-or-later` is copyleft. Take another package")
    assert silent.startswith("silent: it names no licence")


def test_what_is_locked_and_not_installed_is_told(tmp_path: Path) -> None:
    lock = tmp_path / "some.lock"
    lock.write_text("no-such-package-anywhere==1\n")
    assert troubles(lock) == ["no-such-package-anywhere is locked and not installed: run make install"]
