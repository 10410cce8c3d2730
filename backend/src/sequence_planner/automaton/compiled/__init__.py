"""The tick for stations of any size: what a change cannot affect is not looked at again.

`rails` turns an expression into Python, `functions` compiles many of these at once, `closures` does without the
compiler where runs are few, `tables` says of an automaton which variable each predicate depends on, and `run` is a
station's state that goes from tick to tick with them. It means what the reference, `automaton.tick`, means, and is
tested against it on random automata.
"""

from sequence_planner.automaton.compiled.run import CompiledRun, Finished
from sequence_planner.automaton.compiled.tables import CompiledTick

__all__ = ["CompiledRun", "CompiledTick", "Finished"]
