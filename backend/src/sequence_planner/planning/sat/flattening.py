"""Clauses over the gates of a circuit, as few as say what is asked of it.

A gate is defined no further than clauses tell its values apart (Plaisted and Greenbaum 1986). One that stands in no
more than one clause as it is, and in one negated, is replaced there by its parts, and no solver sees it (Eén and Biere
2005).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence, Set

_MOST = 10  # literals that a clause may become; with more, the gate is worth its definition

_OFTEN = 256  # gates from one pause to the next

Clause = list[int]


def flattened(
    clauses: Iterable[Sequence[int]],
    gates: dict[tuple[int, ...], int],
    above: int,
    asked: Set[int],
    pause: Callable[[], object] = lambda: None,
) -> list[Clause]:
    """`clauses` with all that they mean by `gates`, each of them a conjunction of parts, parts before wholes.

    Gates up to the variable `above` are taken for inputs. Of the variables `asked` either value may be asked for, too.
    `pause` is called now and then, and may raise.
    """
    flat = _Flat(clauses)
    for number, (parts, gate) in enumerate(reversed(gates.items())):
        if gate <= above:
            break
        if number % _OFTEN == 0:
            pause()
        if gate in asked or not flat.replaced(gate, parts):
            flat.define(gate, parts, gate in asked)
    return flat.clauses


class _Flat:
    """Clauses, found by their literals."""

    def __init__(self, clauses: Iterable[Sequence[int]]) -> None:
        self.clauses: list[Clause] = []
        self._having: dict[int, list[Clause]] = defaultdict(list)
        for clause in clauses:
            self._add([*clause])

    def replaced(self, gate: int, parts: tuple[int, ...]) -> bool:
        """Return whether `gate` stands in so few clauses that it has been replaced in them."""
        having, negated = self._having[gate], self._having[-gate]
        if len(having) > 1 or len(negated) > 1:
            return False
        if any(len(clause) * len(parts) > _MOST or _meets(clause, parts) for clause in (*having, *negated)):
            return False
        for clause in having:
            clause.remove(gate)
            first, *others = parts
            for part in others:
                self._add([*clause, part])
            self._extend(clause, (first,))
        for clause in negated:
            clause.remove(-gate)
            self._extend(clause, [-part for part in parts])
        return True

    def define(self, gate: int, parts: tuple[int, ...], asked: bool) -> None:
        """Add as much of the definition of `gate` as matters to the clauses; all of it if it is `asked` for."""
        wanted, unwanted = asked or bool(self._having[gate]), asked or bool(self._having[-gate])
        if wanted:
            for part in parts:
                self._add([-gate, part])
        if unwanted:
            self._add([gate, *(-part for part in parts)])

    def _add(self, clause: Clause) -> None:
        self.clauses.append(clause)
        for literal in clause:
            self._having[literal].append(clause)

    def _extend(self, clause: Clause, literals: Iterable[int]) -> None:
        for literal in literals:
            clause.append(literal)
            self._having[literal].append(clause)


def _meets(clause: Clause, parts: Iterable[int]) -> bool:
    """Return whether any of `parts` is in `clause` already, in whichever sense."""
    return any(part in clause or -part in clause for part in parts)
