"""Numbers of things, as people read them."""

from __future__ import annotations


def counted(number: int, one: str, many: str = "") -> str:
    """A number with what is counted: `1 ability`, `2 abilities`; without `many` an `s` is added to `one`."""
    return f"{number} {one if number == 1 else many or f'{one}s'}"
