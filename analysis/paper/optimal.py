"""The paper's baseline: the time that robots need to go straight to their places in the same final formation.

The paper (sections 4 and 5.2) moves them in a perfect world: at full speed, without collisions, knowing where to go.
It does not say which robot goes to which place, so both readings are computed:

- `same_robot`: every robot goes to the place where it ended up itself.
- `best_assignment`: places are given out anew, so that the last robot arrives as early as possible.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import maximum_bipartite_matching

Point = tuple[float, float]


def steps(metres: float, max_speed: float, control_period: float) -> float:
    """Control steps that a robot needs for a distance."""
    return metres / max_speed / control_period


def same_robot(starts: Sequence[Point], places: Sequence[Point]) -> float:
    """The longest way, metres, when the robot that starts at `starts[i]` goes to `places[i]`."""
    return max((math.dist(start, place) for start, place in zip(starts, places, strict=True)), default=0.0)


def best_assignment(starts: Sequence[Point], places: Sequence[Point]) -> float:
    """The longest way, metres, when any robots take the places, so that this is least.

    A bottleneck assignment: the least length for which the ways that are no longer can fill every place. With tens of
    robots a search over the sorted lengths is quick.
    """
    if not places:
        return 0.0
    lengths = np.array([[math.dist(place, start) for start in starts] for place in places])
    candidates = np.unique(lengths)
    low, high = 0, len(candidates) - 1
    while low < high:
        middle = (low + high) // 2
        if _fills_every_place(lengths <= candidates[middle]):
            high = middle
        else:
            low = middle + 1
    return float(candidates[low])


def _fills_every_place(allowed: np.ndarray) -> bool:
    matching = maximum_bipartite_matching(csr_matrix(allowed), perm_type="column")
    return bool((matching >= 0).all())
