"""Python functions from expressions: few calls of the compiler for many of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

from sequence_planner.automaton.compiled.rails import TooComplex, predicate_rails, truth, value
from sequence_planner.expressions.evaluation import Valuation, evaluate, holds
from sequence_planner.expressions.syntax import Expression
from sequence_planner.expressions.types import Value

Function = Callable[[Valuation], Any]
Predicate = Callable[[Valuation], object]  # of a true result, if it certainly holds, and else of a false one
Truth = Callable[[Valuation], bool | None]
Evaluation = Callable[[Valuation], Value | None]

_BATCH = 100  # sources for one call of the compiler: many more take longer per source, and so do many fewer


class Compiler:
    """Compiles expressions that will be evaluated in states with the keys `names`.

    What Python cannot compile, because it nests too deeply or is too long, is interpreted instead.
    """

    def __init__(self, names: Iterable[str]) -> None:
        self._keys = {name: name for name in names}

    def predicates(self, expressions: Iterable[Expression]) -> list[Predicate]:
        """For each expression, whether it certainly holds."""
        return self._functions(expressions, lambda expression: predicate_rails(expression).true, holds)

    def truths(self, expressions: Iterable[Expression]) -> list[Truth]:
        """For each expression its truth: True, False or None."""
        return self._functions(expressions, truth, evaluate)

    def values(self, expressions: Iterable[Expression]) -> list[Evaluation]:
        """For each expression its value, or None while it is unknown."""
        return self._functions(expressions, value, evaluate)

    def _functions(
        self,
        expressions: Iterable[Expression],
        source: Callable[[Expression], str],
        interpreter: Callable[[Expression, Valuation], object],
    ) -> list[Function]:
        """The functions in the order of their expressions; the same source is compiled once."""
        wanted: list[str | Function] = []
        for expression in expressions:
            try:
                wanted.append(source(expression))
            except TooComplex:
                wanted.append(partial(interpreter, expression))
        sources = list(dict.fromkeys(each for each in wanted if isinstance(each, str)))
        compiled: dict[str, Function] = {}
        for start in range(0, len(sources), _BATCH):
            batch = sources[start : start + _BATCH]
            compiled |= zip(batch, self._compiled(batch), strict=True)
        return [compiled[each] if isinstance(each, str) else each for each in wanted]

    def _compiled(self, sources: Sequence[str]) -> list[Function]:
        functions = eval(f"[{','.join(f'lambda s: {source}' for source in sources)}]", {"__builtins__": {}})
        for function in functions:
            # Looking up the very string that is the key takes half as long as looking up one that equals it.
            code = function.__code__
            function.__code__ = code.replace(co_consts=tuple(_same(self._keys, each) for each in code.co_consts))
        return list(functions)


def _same(keys: Mapping[str, str], constant: object) -> object:
    return keys.get(constant, constant) if isinstance(constant, str) else constant
