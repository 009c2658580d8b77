# SPDX-License-Identifier: MIT
"""The rows of docs/validation.md: which number of ours stands beside which published one, and what is said of both."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from rootsoil_tools.published import Reference, reference
from rootsoil_tools.validation_cases import Number

# The two thresholds of all verdicts.
WITHIN = 0.1  # a number agrees in or this far (relative) outside of the published range; an error if it is no larger
LEAST_R2 = 0.9  # a curve agrees from this R^2 on

AGREES, FITTED, THEORY, DISAGREES = "agrees", "fitted to it", "agrees with theory", "disagrees"
NOT_COMPARABLE, NO_NUMBER, NOT_MEASURED = "not comparable", "no public number", "not measured"
VERDICTS = (AGREES, FITTED, THEORY, DISAGREES, NOT_COMPARABLE, NO_NUMBER, NOT_MEASURED)
# What a number of ours is: nothing was set by the published one; the scene was made to have it, or it follows from
# curves that were; it is an input, as the paper has it; it is compared with an independent theory.
PREDICTED, CALIBRATED, INPUT, EXACT = "predicted", "fitted", "taken over", "theory"
SUCCESS = {PREDICTED: AGREES, CALIBRATED: FITTED, INPUT: FITTED, EXACT: THEORY}


@dataclass(frozen=True)
class Row:
    """`key` of our number, and (quantity, species) of the published one in tools/data. `measure`: what both are, a
    number, an R^2 or a relative error. `apart`: why the two cannot be compared. A row without a verdict's number has
    text in its place."""

    group: str
    quantity: str
    key: str = ""
    source: tuple[str, str] | None = None
    origin: str = PREDICTED
    measure: str = "number"
    note: str = ""
    apart: str = ""
    ours: str = ""

    @property
    def reference(self) -> Reference | None:
        """The published number."""
        return reference(*self.source) if self.source else None


def outside(value: float, known: Reference) -> float:
    """Relative distance from a published range, with its sign; 0 inside."""
    if known.low <= value <= known.high:
        return 0.0
    end = known.low if value < known.low else known.high
    return value / end - 1.0 if end else math.copysign(math.inf, value)


def verdict(row: Row, found: Number | None) -> str:
    """One of VERDICTS."""
    if row.apart:
        return NOT_COMPARABLE
    known = row.reference
    if row.origin != EXACT and known is None:
        return NO_NUMBER
    if found is None or math.isnan(found.value):
        return NOT_MEASURED
    if row.measure == "R^2":
        fine = found.value >= LEAST_R2
    elif row.measure == "error":
        fine = abs(found.value) <= WITHIN
    else:
        assert known is not None
        fine = abs(outside(found.value, known)) <= WITHIN
    return SUCCESS[row.origin] if fine else DISAGREES


FIG3, FIG4, FIG5 = "Fig. 3: strain under pressure", "Fig. 4: Arabidopsis, unimpeded", "Fig. 5: pea, impeded"
VIDEOS, PUSH = "Videos S1 to S4", "Growth pressure and pushes"
BUCKLING, SOIL = "Buckling", "Soil"
PRESSURE = "maximum axial growth pressure"
BOTH_YIELD = "chosen for it: p = 0.7 MPa, Y from 0.05 to 0.6 MPa between 0.4 and 0.6 mm"


def strain_rows() -> list[Row]:
    """Fig. 3."""
    rows = [
        Row(
            FIG3,
            f"{direction} strain, {tissue}: mean relative error against Eq. 8",
            f"{direction} strain error, {tissue}",
            (f"{direction} strain: relative error", tissue),
            EXACT,
            "error",
        )
        for direction in ("axial", "radial")
        for tissue in ("isotropic", "balanced", "anisotropic")
    ]
    convergence = "the paper prints no convergence; ours is in [accuracy_cost.md](accuracy_cost.md)"
    return [*rows, Row(FIG3, "error over the number of cells", note=convergence)]


def curve_rows() -> list[Row]:
    """Fig. 4B. The paper's R^2 is its own; both are against Beemster & Baskin 1998."""
    rows = []
    for quantity, name, unit, note in (
        ("axial_strain_rate", "axial strain rate", "1/h", "the paper's would be 0.0022 /h if it is in 1/s"),
        ("cell_length", "cell length", "µm", ""),
        ("division_rate", "division rate", "1/h", ""),
    ):
        seeds = "divisions are few: the seed decides" if name == "division rate" else ""
        source = (f"R^2 of the {name}", "Arabidopsis")
        rows.append(Row(FIG4, f"{name}: R²", f"{quantity} R^2", source, CALIBRATED, "R^2", seeds))
        apart = f"the paper prints no unit (ours: {unit})"
        source = (f"RMSE of the {name}", "Arabidopsis")
        rows.append(Row(FIG4, f"{name}: RMSE", f"{quantity} RMSE", source, CALIBRATED, apart=apart, note=note))
    return rows


def arabidopsis_rows() -> list[Row]:
    """What follows from the curves."""

    def row(quantity: str, key: str, source: str, origin: str = CALIBRATED, note: str = "") -> Row:
        species = {
            "peak axial strain rate": "Arabidopsis and maize",
            "meristem length over root diameter": "98 species",
        }
        return Row(
            FIG4, quantity, f"arabidopsis {key}", (source, species.get(source, "Arabidopsis")), origin, note=note
        )

    return [
        row("peak axial strain rate (1/h)", "peak rate", "peak axial strain rate"),
        row("elongation rate (mm/h)", "tip speed", "root elongation rate", note="integral of the fitted strain rate"),
        row(
            "time in the meristem (h)",
            "hours in the meristem",
            "time in the meristem",
            note="from one cell behind the tip to where division ends, 0.6 mm; goes as the logarithm of that start",
        ),
        row(
            "time in the elongation zone (h)",
            "hours in the elongation zone",
            "time in the elongation zone",
            note="from 0.6 mm to where the rate is 5 % of its peak",
        ),
        row(
            "meristem length over diameter",
            "meristem over diameter",
            "meristem length over root diameter",
            note="0.6 mm: Beemster & Baskin's cells still divide at 0.57 mm",
        ),
        Row(
            FIG4,
            "radius, change in 10 h (relative)",
            "arabidopsis radius drift",
            note="the paper: stable for 8 h; it prints no radius",
        ),
        Row(
            FIG4,
            "growth zone lengthens from day 6 to 14",
            apart="roots of the model do not age",
            note="Beemster & Baskin 1998",
        ),
    ]


def pea_rows() -> list[Row]:
    """Fig. 5."""
    public = "data of Croser et al. 1999 are not public; ours: against the bell that was fitted to them"
    rows = [
        Row(
            FIG5,
            f"strain rate over 15 mm, p = {p} MPa: R²",
            f"pea rate R^2 to the printed bell, {p}",
            (f"R^2 of the axial strain rate p={p}", "pea"),
            CALIBRATED,
            "R^2",
            public,
        )
        for p in ("0.987", "0.625")
    ]

    def pea(quantity: str, key: str, source: str, origin: str = CALIBRATED, note: str = "") -> Row:
        return Row(FIG5, quantity, f"pea {key}", (source, "pea"), origin, note=note)

    peak = "peak axial strain rate p=1 (authors' own calibration target)"
    return [
        Row(
            FIG5,
            "strain rate against Eq. 6 at its p: R²",
            "pea rate R^2 to Eq. 6",
            None,
            EXACT,
            "R^2",
            "worst to best of seven p",
        ),
        *rows,
        pea("peak strain rate at p = 1 MPa (1/h)", "peak rate", peak),
        pea("growth zone, soft soil (mm)", "growth zone, soft", "growth zone in soft soil"),
        pea("growth zone, hard soil (mm)", "growth zone, hard", "growth zone in hard soil"),
        pea("radius, hard over soft soil, less 1", "wider in hard soil", "diameter increase soft to hard soil"),
        Row(
            FIG5,
            "radius along the root: R²",
            source=("R^2 of the radius p=0.5 and 0.825", "pea"),
            apart="the radii of the paper's ref. 16 are not public",
        ),
        Row(
            FIG5,
            "rates in the first millimetre, spread over p (1/h)",
            "pea first millimetre",
            note="the paper: identical, without a number",
        ),
        Row(
            FIG5,
            "radius, change in 10 h, p = 1 (relative)",
            "pea radius drift, soft",
            note="2.2 of the paper asks for a stable one, for 8 h, without a number",
        ),
        Row(FIG5, "radius, change in 10 h, p = 0.5 (relative)", "pea radius drift, hard", note="the same"),
        Row(FIG5, "the same, sets as printed (relative)", "as printed radius drift", note="p = 0.987"),
        Row(
            FIG5,
            "penetrometer resistance that halves the speed (MPa)",
            "pea resistance that halves",
            ("penetrometer resistance that halves elongation", "various"),
            note="Eq. 7 was fitted to rates, not to this; p = 1 MPa less a fourth of the resistance is the paper's",
        ),
        Row(
            FIG5,
            "division threshold over mean cell length",
            "pea threshold over length",
            ("division threshold over mean cell length", "Arabidopsis"),
            note="1/ln 2 = 1.443 in a steady population",
        ),
    ]


def video_rows() -> list[Row]:
    """S1 to S4."""

    def video(
        name: str, quantity: str, key: str, source: str, origin: str = PREDICTED, apart: str = "", note: str = ""
    ) -> Row:
        return Row(VIDEOS, f"{name}: {quantity}", key, (source, name), origin, apart=apart, note=note)

    start = "their length at the start is not printed"
    return [
        video(
            "S1",
            "volume after 50 h over the first",
            "arabidopsis S1 volume ratio",
            "volume over the first after 50 h",
            apart=start,
        ),
        video(
            "S1", "divisions of a cell in 50 h", "arabidopsis S1 divisions", "divisions of a cell in 50 h", apart=start
        ),
        Row(VIDEOS, "S2: two pressure differentials", note="no number is printed; ours is Fig. 5's series"),
        video("S3", "cells at the end", "S3 cells", "cells at the end", CALIBRATED, note="55 h, from 45,344 (45,000)"),
        video("S3", "elongation (mm)", "S3 elongation", "elongation", CALIBRATED),
        video(
            "S3",
            "generations",
            "S3 generations",
            "generations",
            note="divisions of the cell that divided most; with the first cells these are eight generations",
        ),
        video("S4", "cells at the end", "S4 cells", "cells at the end", CALIBRATED, note="30 h, from 2,036 (2,000)"),
        video(
            "S4",
            "elongation (mm)",
            "S4 elongation",
            "elongation",
            CALIBRATED,
            note="among grains, which the paper's has not",
        ),
        video("S4", "generations", "S4 generations", "generations", note="divisions of the cell that divided most"),
    ]


def push_rows() -> list[Row]:
    """Growth pressures and pushes, without a yield stress and with one."""
    rows = [
        Row(
            PUSH,
            f"growth pressure, {name}; no yield stress (MPa)",
            "growth pressure, no yield",
            (source, name),
            note=note,
        )
        for source, name, note in (
            (PRESSURE, "pea", "p = 1 MPa, as in the shipped scenes"),
            (PRESSURE, "dicots", "the same"),
            (PRESSURE, "monocots", "the same"),
            (PRESSURE, "cotton", "the same"),
            (PRESSURE, "sunflower", "the same"),
            (f"{PRESSURE} by dead load", "pea and cotton", "the same; another method"),
        )
    ]
    push = ("elongation rate half an hour after +100 mN of axial force", "pea")
    left = "rate left under 100 mN"
    uniform = "p = 0.7, Y = 0.2 MPa"
    return [
        *rows,
        Row(PUSH, f"{left}; no yield stress", "left after 100 mN, no yield", push, note="p = 1 MPa"),
        Row(
            PUSH,
            "growth pressure, dicots; uniform Y (MPa)",
            "growth pressure, uniform yield",
            (PRESSURE, "dicots"),
            CALIBRATED,
            note=f"chosen for it: {uniform}",
        ),
        Row(
            PUSH,
            f"{left}; uniform Y",
            "left after 100 mN, uniform yield",
            push,
            note=f"{uniform}, chosen for the pressure only",
        ),
        Row(
            PUSH,
            "growth pressure, pea; rising Y (MPa)",
            "growth pressure, rising yield",
            (PRESSURE, "pea"),
            CALIBRATED,
            note=BOTH_YIELD,
        ),
        Row(PUSH, f"{left}; rising Y", "left after 100 mN, rising yield", push, CALIBRATED, note="the same"),
        *[
            Row(
                PUSH,
                f"{what}, {name}: relative error",
                f"{what} error, {name} yield",
                None,
                EXACT,
                "error",
                "against the closed form of docs/decisions/0024",
            )
            for what in ("growth pressure", "left after 100 mN")
            for name in ("no", "uniform")
        ],
        Row(
            PUSH,
            "Young's modulus of the root (MPa)",
            "pea Young's modulus",
            ("Young's modulus of the root", "poplar"),
            INPUT,
            note="Table 1's is taken over; with growth alike, Euler loads go as it",
        ),
    ]


def other_rows() -> list[Row]:
    """Buckling and soil."""
    probe = ("penetrometer resistance over root resistance", "various")
    return [
        Row(
            BUCKLING,
            "Euler load of a column: relative error",
            "Euler load error",
            None,
            EXACT,
            "error",
            "against Euler and Engesser",
        ),
        Row(
            BUCKLING,
            "critical length of a root on a plate: relative error",
            "critical length error",
            None,
            EXACT,
            "error",
            "against Euler and Engesser",
        ),
        Row(
            BUCKLING,
            "measured lengths or loads at which roots buckle",
            note="Bizet et al. 2016 find Euler's formula in poplar, without a number we have",
        ),
        Row(
            SOIL,
            "penetrometer's resistance over the root's",
            "probe over root resistance",
            probe,
            note="four confining pressures; a rod of the root's width and friction, in the same grains",
        ),
        Row(
            SOIL,
            "tip force against flexibility",
            ours="0.52 of a rigid root's at 50 MPa",
            note="Fakih et al. 2019: it falls exponentially, up to the soil's hardness; ours in [soil.md](soil.md)",
        ),
    ]


def all_rows() -> list[Row]:
    """In the order of the page."""
    return [
        *strain_rows(),
        *curve_rows(),
        *arabidopsis_rows(),
        *pea_rows(),
        *video_rows(),
        *push_rows(),
        *other_rows(),
    ]


def verdicts(numbers: Mapping[str, Number]) -> list[tuple[Row, Number | None, str]]:
    """Every row with our number and its verdict."""
    return [(row, numbers.get(row.key), verdict(row, numbers.get(row.key))) for row in all_rows()]
