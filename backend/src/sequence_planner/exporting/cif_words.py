"""Identifiers of the language CIF: its words, which need a `$` in front to be names."""

from __future__ import annotations

import re

from sequence_planner.exporting.names import word

CIF_WORDS = frozenset(
    re.findall(
        r"\w+",
        """
        alg alphabet annotation any attr automaton bool break case const cont continue controllable def der dict
        disables disc dist do edge elif else end enum equation event external false file final for func goto group
        id if import initial input int invariant list location marked monitor namespace needs now plant post pre
        print printfile real requirement return self set string supervisor svgcopy svgfile svgin svgmove svgout
        switch tau text time to true tuple type uncontrollable urgent value void when while acosh acos asinh asin
        atanh atan cosh cos sinh sin tanh tan abs cbrt ceil del empty exp floor fmt ln log max min pop pow round
        scale sign size sqrt bernoulli beta binomial constant erlang exponential gamma geometric lognormal normal
        poisson random triangle uniform weibull and div in mod not or sample sub
        """,
    )
)


def identifier(name: str) -> str:
    """A word that resembles `name`, escaped if it means something in CIF: `robot.pose` becomes `robot_pose`."""
    plain = word(name)
    return f"${plain}" if plain in CIF_WORDS else plain
