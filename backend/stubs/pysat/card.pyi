from collections.abc import Sequence
from types import TracebackType
from typing import Self

from pysat.formula import CNFPlus, IDPool

class NoSuchEncodingError(Exception): ...
class UnsupportedBound(Exception): ...

class EncType:
    pairwise: int
    seqcounter: int
    sortnetwrk: int
    cardnetwrk: int
    bitwise: int
    ladder: int
    totalizer: int
    mtotalizer: int
    kmtotalizer: int
    native: int

class CardEnc:
    @classmethod
    def atmost(
        cls,
        lits: Sequence[int],
        bound: int = 1,
        top_id: int | None = None,
        vpool: IDPool | None = None,
        encoding: int = 1,
    ) -> CNFPlus: ...
    @classmethod
    def atleast(
        cls,
        lits: Sequence[int],
        bound: int = 1,
        top_id: int | None = None,
        vpool: IDPool | None = None,
        encoding: int = 1,
    ) -> CNFPlus: ...
    @classmethod
    def equals(
        cls,
        lits: Sequence[int],
        bound: int = 1,
        top_id: int | None = None,
        vpool: IDPool | None = None,
        encoding: int = 1,
    ) -> CNFPlus: ...

class ITotalizer:
    lits: list[int]
    ubound: int
    top_id: int
    cnf: CNFPlus
    rhs: list[int]
    nof_new: int
    def __init__(self, lits: Sequence[int] = [], ubound: int = 1, top_id: int | None = None) -> None: ...
    def __enter__(self) -> Self: ...
    def __exit__(
        self, exc_type: type[BaseException] | None, exc: BaseException | None, traceback: TracebackType | None
    ) -> None: ...
    def delete(self) -> None: ...
    def increase(self, ubound: int = 1, top_id: int | None = None) -> None: ...
    def extend(self, lits: Sequence[int] = [], ubound: int | None = None, top_id: int | None = None) -> None: ...
