"""Tokens, codes, ids and normalized names of `auth`, and its entries in the audit journal."""

from __future__ import annotations

import re
import secrets
import unicodedata
from hashlib import sha256

from pydantic import JsonValue
from sqlalchemy import Connection

from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.core.actor import Actor
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry
from sequence_planner.texts.message import Message, message

# Names of people, watches and keys: as they are kept, as they are found by, and as they look.
#
# A name is shown to people who decide by it who has control or whose watch they let in, so two names of one kind may
# not look the same. Unicode has many ways to write what looks the same: compatibility forms (normalisation form KC, UAX
# #15, takes them away), case (caseless matching, Unicode 3.13), invisible characters, and letters that look alike (UTS
# #39; here those of Latin, Cyrillic and Greek, which keyboards have).

LONGEST_NAME = 100  # characters
UNKNOWN = "unknown"  # who tried a name that nobody has
_MOST_MARKS = 3  # combining marks on one letter; no living script puts more there
_UNFIT = frozenset({"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"})  # control, invisible, half, private or unknown ones
_BLANK = frozenset("\u034f\u115f\u1160\u17b4\u17b5\u2800\u3164\uffa0") | {chr(at) for at in range(0xFE00, 0xFE10)}
# Pairs: a letter, and the Latin one that it looks like. Capital and small ones look different, so both stand here.
_LATIN = "il Il 1l |l 0o ıl ʟl ɑa ɡg ɪl"
_CYRILLIC = "Аa Вb Еe Кk Мm Нh Оo Рp Сc Тt Хx Іl Јj Ѕs Үy аa еe оo рp сc уy хx іl јj ѕs ԁd һh ӏl ԛq ԝw"
_GREEK = "Αa Βb Εe Ζz Ηh Ιl Κk Μm Νn Οo Ρp Τt Υy Χx αa ιl κk τt νv οo ρp υu"
_ALIKE = {ord(pair[0]): pair[1] for pair in f"{_LATIN} {_CYRILLIC} {_GREEK}".split()}


def clean_name(text: str) -> str:
    """A name as it is kept: in normalisation form KC, with single blanks between words.

    Raises `IdentityRefused` (`invalid-name`, 422) unless it has 1 to 100 characters, a letter or digit among them, and
    none that does not show or changes the direction of writing.
    """
    if len(text) > 4 * LONGEST_NAME:
        raise _unfit(message("refused.invalid-name.too-long", longest=LONGEST_NAME))
    name = " ".join(unicodedata.normalize("NFKC", text).split())
    if not 1 <= len(name) <= LONGEST_NAME:
        raise _unfit(message("refused.invalid-name.length", longest=LONGEST_NAME))
    if any(unicodedata.category(each) in _UNFIT or each in _BLANK for each in text + name):
        raise _unfit(message("refused.invalid-name.hidden"))
    if not any(each.isalnum() for each in name):
        raise _unfit(message("refused.invalid-name.no-letter"))
    if _piled(name):
        raise _unfit(message("refused.invalid-name.marks", most=_MOST_MARKS))
    return name


def name_key(text: str) -> str:
    """Return what a name is found by: regardless of case and of surrounding and repeated blanks. Any text has one."""
    folded = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", text).casefold())
    return " ".join(folded.split())


def name_shape(name: str) -> str:
    """Return what a name looks like at a glance: letters that look alike are one, and marks and punctuation do not
    count.
    """
    bare = "".join(each for each in unicodedata.normalize("NFKD", name) if unicodedata.category(each)[0] != "M")
    return "".join(each for each in bare.translate(_ALIKE).casefold().translate(_ALIKE) if each.isalnum())


def short(text: str, most: int = 200) -> str:
    """A text that anybody may have sent, such as the name of a browser: so many characters, each of which shows."""
    return "".join("\ufffd" if unicodedata.category(each) in _UNFIT else each for each in text[:most])


def _piled(name: str) -> bool:
    marks = 0
    for each in unicodedata.normalize("NFD", name):
        marks = marks + 1 if unicodedata.combining(each) else 0
        if marks > _MOST_MARKS:
            return True
    return False


def _unfit(detail: Message) -> IdentityRefused:
    return IdentityRefused("invalid-name", detail, 422)


# Entries of this package in the journal.


def record(connection: Connection, by: Actor, action: str, subject: str, now: float, **details: JsonValue) -> None:
    """Write that something was done, in the transaction that does it."""
    append(connection, Entry(actor=by, action=action, subject=subject, details=details), now)


# Tokens, codes and ids: all drawn from the system's source of randomness; of what is secret only a hash is kept.

_ID = re.compile(r"[0-9a-z]{1,40}")


def new_id() -> str:
    """An id that may be seen by anybody: 16 hexadecimal digits, never used before."""
    return secrets.token_hex(8)


def is_id(text: str) -> bool:
    """Return whether `text` could be an id at all; what could not is not asked of a database."""
    return _ID.fullmatch(text) is not None


def new_token() -> str:
    """A secret of 32 random bytes, fit for a URL's fragment, a cookie and a header."""
    return secrets.token_urlsafe(32)


def new_code() -> str:
    """Eight decimal digits that a person types: worth something only while few guesses are allowed."""
    return f"{secrets.randbelow(10**8):08}"


def hash_of(secret: str) -> str:
    """SHA-256 in hexadecimal digits. With 256 random bits in what is hashed, no slower hash is needed."""
    return sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()


def same(one: str, other: str) -> bool:
    """Return whether two hashes are the same, found out in a time that does not tell where they differ."""
    return secrets.compare_digest(one, other)
