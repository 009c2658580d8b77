# SPDX-License-Identifier: MIT
"""Force chains as lines, and slopes over time."""

from __future__ import annotations

import numpy as np
import pytest
from rootsoil_tools import measure, soil
from rootsoil_tools.runs import Frame


@pytest.fixture
def frame() -> Frame:
    """Two grains that touch each other; one touches the root, the other a wall. Not in the order of their ids."""
    grains = {
        "grain_id": np.array([9, 7]),
        "position": np.array([[2.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
        "radius": np.array([0.5, 0.4]),
    }
    contacts = {
        "first_id": np.array([-1, 7, 9]),
        "second_id": np.array([7, 9, -2]),
        "position": np.array([[0.6, 0.0, 0.0], [1.45, 0.0, 0.0], [2.5, 0.0, 0.0]]),
        "force": np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 2.0], [1.0, 0.0, 0.0]]),
    }
    return Frame(1.0, {}, {"grains": grains, "soil_contacts": contacts})


def test_force_lines(frame: Frame):
    """From centre to centre between grains, else from the centre to the contact; the force's magnitude."""
    lines, force = soil.force_lines(frame)
    np.testing.assert_array_equal(lines[:, :, 0], [[0.6, 1.0], [1.0, 2.0], [2.0, 2.5]])
    np.testing.assert_allclose(force, [5.0, 2.0, 1.0])


def test_extent(frame: Frame):
    low, high = soil.extent(frame)
    np.testing.assert_allclose(low, [0.6, -0.5])
    np.testing.assert_allclose(high, [2.5, 0.5])


def test_running_slope_and_mean():
    """A straight line has its slope everywhere, ends included; the first row does not count in a mean."""
    time = np.linspace(0.0, 2.0, 21)
    np.testing.assert_allclose(measure.running_slope(time, 3.0 - 2.0 * time, 0.5), -2.0)
    values = np.where(np.arange(21) == 0, 100.0, 1.0)
    np.testing.assert_allclose(measure.running_mean(time, values, 0.5), 1.0)
