"""Samples of settings: grids, random ones, and ones that are spread evenly."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np

from . import _arrays
from .errors import Error


def grid(values: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Every combination of values: ``grid({"wind.velocity": [(0, 0, 0), (0, 0, 2)], "style.seed": [1, 2]})``."""
    for key, listed in values.items():
        if isinstance(listed, str) or not isinstance(listed, Iterable):
            raise Error(f"{key} has the values {listed!r}, expected a list of them", "value")
    return [dict(zip(values, chosen, strict=True)) for chosen in product(*values.values())]


def random(ranges: Mapping[str, Any], count: int, *, seed: int = 0) -> list[dict[str, Any]]:
    """Samples of ranges (least, most) or lists of words, at random by a seed: ``random({"wind.gust": (0.0, 1.0)}, 8)``."""
    _check(ranges)
    count, generator = _arrays.count(count, "count"), np.random.default_rng(_arrays.count(seed, "seed"))
    return [_sample(ranges, generator.random(len(ranges))) for _ in range(count)]


def sobol(ranges: Mapping[str, Any], count: int, *, seed: int = 0) -> list[dict[str, Any]]:
    """Samples of ranges as :func:`random`, spread evenly: the first points of a Sobol sequence with a random shift."""
    _check(ranges)
    shift = np.random.default_rng(_arrays.count(seed, "seed")).random(len(ranges))
    return [_sample(ranges, (row + shift) % 1.0) for row in _sobol(_arrays.count(count, "count"), len(ranges))]


def _check(ranges: Mapping[str, Any]) -> None:
    for key, span in ranges.items():
        if isinstance(span, str) or not isinstance(span, Sequence) or not span:
            raise Error(f"{key} has the range {span!r}, expected (least, most) or a list of words", "value")


#: Degrees, coefficients and first direction numbers of Sobol sequences [Joe & Kuo 2008], from the second dimension on.
_DIRECTIONS = (
    (1, 0, (1,)), (2, 1, (1, 3)), (3, 1, (1, 3, 1)), (3, 2, (1, 1, 1)), (4, 1, (1, 1, 3, 3)), (4, 4, (1, 3, 5, 13)),
    (5, 2, (1, 1, 5, 5, 17)), (5, 4, (1, 1, 5, 5, 5)), (5, 7, (1, 1, 7, 11, 19)), (5, 11, (1, 1, 5, 1, 1)),
    (5, 13, (1, 1, 1, 3, 11)), (5, 14, (1, 3, 5, 5, 31)), (6, 1, (1, 3, 3, 9, 7, 49)), (6, 13, (1, 1, 1, 15, 21, 21)),
    (6, 16, (1, 3, 1, 13, 27, 49)),
)  # fmt: skip


def _sobol(count: int, dimensions: int) -> np.ndarray[Any, Any]:
    if dimensions > len(_DIRECTIONS) + 1:
        raise Error(f"{dimensions} ranges, expected {len(_DIRECTIONS) + 1} at most: take random samples", "value")
    bits = 32
    directions = np.zeros((dimensions, bits), dtype=np.uint64)
    for dimension in range(dimensions):
        if dimension == 0:
            numbers = [1] * bits
        else:
            degree, coefficients, first = _DIRECTIONS[dimension - 1]
            numbers = list(first)
            for at in range(degree, bits):
                number = numbers[at - degree] ^ (numbers[at - degree] << degree)
                for k in range(1, degree):
                    if coefficients >> (degree - 1 - k) & 1:
                        number ^= numbers[at - k] << k
                numbers.append(number)
        directions[dimension] = [number << (bits - 1 - at) for at, number in enumerate(numbers[:bits])]
    points = np.zeros((count, dimensions))
    state = np.zeros(dimensions, dtype=np.uint64)
    for index in range(1, count):
        lowest = ((index & -index).bit_length()) - 1
        state ^= directions[:, lowest]
        points[index] = state / 2.0**bits
    return points


def _sample(ranges: Mapping[str, Any], shares: Any) -> dict[str, Any]:
    chosen = {}
    for (key, span), share in zip(ranges.items(), shares, strict=True):
        if len(span) == 2 and all(isinstance(end, int | float) and not isinstance(end, bool) for end in span):
            least, most = span
            value = least + (most - least) * float(share)
            chosen[key] = round(value) if all(isinstance(end, int) for end in span) else value
        else:
            chosen[key] = span[min(int(share * len(span)), len(span) - 1)]
    return chosen
