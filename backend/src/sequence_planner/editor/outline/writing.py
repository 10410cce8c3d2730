"""YAML of an outline's documents: words in their quotes, and what several kinds of devices say alike."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.editor.outline.outline import OutlineItem, Stand
from sequence_planner.model.yaml.editor import in_brackets


def titled(named: OutlineItem) -> str:
    """Return what people read of it."""
    return spoken(named.title) or named.name.replace("_", " ").strip()


def spoken(text: str) -> str:
    """Return a text in one line, without what cannot be read."""
    return " ".join("".join(each if each.isprintable() else " " for each in text).split())


def in_both(english: str, swedish: str) -> str:
    """Return a text in both languages in which the pages speak."""
    return in_brackets({"en": english, "sv": swedish})


def in_one_line(values: Iterable[str]) -> str:
    """Return a list in one line of what is YAML already."""
    return f"[{', '.join(values)}]"


def enumeration(name: str, values: Iterable[OutlineItem], before: Mapping[str, str] | None = None) -> str:
    """Return an entry of `enumerations` with the titles of its values; those of `before` come first, each with its
    title as YAML.
    """
    titles = {**(before or {}), **{each.name: in_brackets(titled(each)) for each in values}}
    told = "".join(f"      {each}: {title}\n" for each, title in titles.items())
    return f"  {name}:\n    values: {in_one_line(titles)}\n    titles:\n{told}"


def stands(where: Iterable[Stand]) -> list[str]:
    """Return the conditions that robots are in these poses and stay there."""
    return [f"{each.robot}.place == {each.pose} and {each.robot}.target == {each.pose}" for each in where]


def all_of(conditions: Iterable[str]) -> str:
    """Return all conditions in one, as YAML: there is at least one, and none is an `or` without brackets."""
    return " and ".join(conditions)


def camel(name: str) -> str:
    """Return a name as message types are called: `arm_2` is `Arm2`."""
    return "".join(part[:1].upper() + part[1:] for part in name.split("_") if part) or "Device"
