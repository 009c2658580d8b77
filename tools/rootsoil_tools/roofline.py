# SPDX-License-Identifier: MIT
"""What limits the pair loops: operations and bytes a pair, counted by hand, and what the machine can do.

Counted from root_sph/dynamics/pair_loop.cpp as it stands there: every addition and multiplication of the source is one
operation, a product of a matrix and a vector is n (2n - 1) of them. Bytes are those that have to pass at least once:
what a pair has of its own is read, and its slip written; what a cell has is read once in the whole loop, since spatial
order keeps a cell in the cache until its last pair, and a sum is read and written. What a cache fetches besides is not
counted.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

REAL, INDEX_PAIR, ROW = 8, 8, 8  # bytes of a double, of Pair, of an entry of PairList::row


@dataclass(frozen=True)
class Loop:
    """A pair loop: operations and bytes of each pair, and bytes of each cell."""

    operations: int
    bytes_of_pair: int
    bytes_of_cell: int

    def bytes_per_pair(self, pairs_per_cell: float) -> float:
        """With a pair's share of its cells."""
        return self.bytes_of_pair + self.bytes_of_cell / pairs_per_cell


def gradient_loop(n: int) -> Loop:
    """compute_velocity_gradients in n dimensions."""
    operations = n + 2 * n * n + 2 * n * n  # du  # sum += du (x) g_ij  # gradient[j] -= du (x) g_ji
    vector, matrix = n * REAL, n * n * REAL
    return Loop(
        operations,
        bytes_of_pair=INDEX_PAIR + 2 * vector,  # g_ij and g_ji
        bytes_of_cell=ROW + vector + 3 * matrix,  # velocity; gradient: set to zero, then read and written
    )


def force_loop(n: int, damped: bool) -> Loop:
    """resist_slips and add_stress_forces in n dimensions, with growth; with inertia slips are damped, and kept in every
    pass."""
    product = n * (2 * n - 1)
    operations = (
        2 * n  # r, from where the window began, and du
        + 2 * (product + n)  # v_i, v_j
        + 4  # stiffness, and times the step
        + (5 if damped else 0)  # damping
        + 6 * n  # f_i, f_j
        + (6 * n if damped else 0)  # slips that are kept
        + 3 * n  # f_i + f_j onto i and j
        + 4 * n * n  # their moments onto i and j
        + 2 * product + n  # A_i g_ij - A_j g_ji
        + 2 * n  # onto i and j
    )  # fmt: skip
    vector, matrix = n * REAL, n * n * REAL
    return Loop(
        operations,
        # twice the cells; g_ij, g_ji; weight, retention; two slips in, and out where they are kept
        bytes_of_pair=2 * INDEX_PAIR + 2 * vector + 2 * REAL + (4 if damped else 2) * vector,
        # nominal force, in and out and in, and gradient; velocity, start; force, in and out twice; damping
        bytes_of_cell=2 * ROW + 4 * matrix + 6 * vector + (REAL if damped else 0),
    )


@dataclass(frozen=True)
class Machine:
    """What one core does: bytes from and to memory (GB/s), additions and multiplications (GFLOP/s)."""

    triad_GB_s: float
    matrix_product_GFLOP_s: float
    in_cache_GFLOP_s: float


def best_s(body: Callable[[], object], clock: Callable[[], float], times: int = 5) -> float:
    """The shortest time of several."""
    body()  # memory is there from then on
    spent = []
    for _ in range(times):
        start = clock()
        body()
        spent.append(clock() - start)
    return min(spent)


def measure_machine(megabytes: int = 256) -> Machine:
    """Now, with numpy.

    The triad z = x + a y in two passes over arrays of `megabytes`, far larger than any cache: five words a place. The
    fused multiply-add is that of a product of matrices (its processor time: BLAS may use more cores); without it and
    without a blocked loop, z = x + a y in arrays that stay in the second-level cache.
    """
    n = megabytes * 2**20 // REAL
    x, y, z = np.ones(n), np.ones(n), np.ones(n)

    def triad() -> None:
        np.multiply(y, 0.5, out=z)
        np.add(z, x, out=z)

    triad_s = best_s(triad, time.perf_counter)
    few, often = 2**14, 500
    u, v, w = x[:few].copy(), y[:few].copy(), z[:few].copy()

    def in_cache() -> None:
        for _ in range(often):
            np.multiply(v, 0.5, out=w)
            np.add(w, u, out=w)

    in_cache_s = best_s(in_cache, time.process_time)
    side = 1024
    a = np.random.default_rng(1).random((side, side))
    product_s = best_s(lambda: a @ a, time.process_time)
    return Machine(5 * REAL * n / triad_s / 1e9, 2 * side**3 / product_s / 1e9, 2 * few * often / in_cache_s / 1e9)
