"""Curves over sizes, as a picture: both axes are logarithmic."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil, floor, log2, log10

WIDTH, HEIGHT, LEFT, RIGHT, EDGE = 720, 400, 60, 220, 40
COLOURS = ("#0b6e99", "#c2410c", "#7c3aed", "#15803d", "#a16207", "#be185d")
INK, PAPER = "#4b5563", "#ffffff"

Curves = Mapping[str, Sequence[tuple[float, float]]]


def drawn(curves: Curves, unit: str) -> str:
    """An SVG with a curve for each name; sizes are powers of two, and values above 0."""
    sizes = sorted({size for points in curves.values() for size, _ in points})
    values = [value for points in curves.values() for _, value in points]
    low, high = floor(log10(min(values))), ceil(log10(max(values)))
    wide, tall = WIDTH - LEFT - RIGHT, HEIGHT - 2 * EDGE

    def x(size: float) -> float:
        return LEFT + wide * log2(size / sizes[0]) / max(log2(sizes[-1] / sizes[0]), 1)

    def y(value: float) -> float:
        return HEIGHT - EDGE - tall * (log10(value) - low) / max(high - low, 1)

    def text(left: float, top: float, words: str, anchor: str, colour: str = INK) -> str:
        return f'<text x="{left:.0f}" y="{top:.0f}" text-anchor="{anchor}" fill="{colour}">{words}</text>'

    parts = [f'<rect width="{WIDTH}" height="{HEIGHT}" fill="{PAPER}"/>']
    for power in range(low, high + 1):
        at = y(10.0**power)
        parts.append(f'<path d="M{LEFT} {at:.1f}h{wide}" stroke="{INK}" stroke-opacity="0.2"/>')
        parts.append(text(LEFT - 8, at + 4, f"{10.0**power:g} {unit}", "end"))
    parts += [text(x(size), HEIGHT - EDGE + 20, f"{size:g} \u00d7", "middle") for size in sizes]
    names = sorted(curves, key=lambda name: -curves[name][-1][1])
    for number, name in enumerate(names):
        colour, points = COLOURS[number % len(COLOURS)], curves[name]
        line = " ".join(f"{x(size):.1f},{y(value):.1f}" for size, value in points)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{x(size):.1f}" cy="{y(value):.1f}" r="3" fill="{colour}"/>' for size, value in points]
        top = EDGE + 20 * number
        parts.append(f'<path d="M{WIDTH - RIGHT + 16} {top - 4}h16" stroke="{colour}" stroke-width="2"/>')
        parts.append(text(WIDTH - RIGHT + 38, top, name, "start"))
    box = f'viewBox="0 0 {WIDTH} {HEIGHT}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {box} font-family="sans-serif" font-size="12">'
    return "\n".join((head, *parts, "</svg>", ""))
