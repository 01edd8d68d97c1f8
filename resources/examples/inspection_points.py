# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes inspection/hemisphere-synthetic.csv: a hemisphere probed in the pattern of Chalvin 2020, section 6.2.

No part was measured for it. The deviations are synthetic, from a seed: three lobes, a slow wave along the height and noise,
of about the size of the paper's optimized spheres. The ball of 1.5 mm radius, and a set-up that is turned and moved.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

R0, BALL = 45.0, 1.5  # mm
SEED = 2020
FOLDER = Path(__file__).resolve().parent / "inspection"


def pattern() -> tuple[np.ndarray, np.ndarray]:
    """Height and azimuth (n,) of the points: a helix of 10 turns from 10 to 40 mm and circles at 15, 25 and 35 mm, one
    point every 0.5 mm."""
    fine = np.linspace(0.0, 1.0, 200_001)
    height, azimuth = 10.0 + 30.0 * fine, 20.0 * np.pi * fine
    radius = np.sqrt(R0**2 - height**2)
    points = np.column_stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height])
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    at = np.interp(np.arange(0.0, way[-1], 0.5), way, fine)
    heights, azimuths = [10.0 + 30.0 * at], [20.0 * np.pi * at]
    for level in (15.0, 25.0, 35.0):
        count = int(2.0 * np.pi * np.sqrt(R0**2 - level**2) / 0.5)
        heights.append(np.full(count, level))
        azimuths.append(2.0 * np.pi * np.arange(count) / count)
    return np.concatenate(heights), np.concatenate(azimuths)


def deviations(height: np.ndarray, azimuth: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """mm outside of the planned surface (n,)."""
    lobes = 0.06 * np.cos(3.0 * azimuth + 0.4) * (0.6 + height / R0)
    wave = 0.03 * np.sin(0.35 * height)
    return lobes + wave + rng.normal(0.0, 0.015, len(height))


def text() -> str:
    """The file."""
    rng = np.random.default_rng(SEED)
    height, azimuth = pattern()
    flat = np.sqrt(R0**2 - height**2)
    normal = np.column_stack([flat * np.cos(azimuth), flat * np.sin(azimuth), height]) / R0
    balls = normal * (R0 + deviations(height, azimuth, rng) + BALL)[:, None]
    tilt, turn = np.radians(0.4), np.radians(25.0)
    about_x = np.array(
        [[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]]
    )
    about_z = np.array(
        [[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
    )
    seen = balls @ (about_z @ about_x).T + [2.4, -1.7, 0.9]
    lines = [
        "# SYNTHETIC: no part was measured. Made by inspection_points.py in the pattern of Chalvin 2020, section 6.2.",
        "# centres of a ball of 1.5 mm radius; unit: mm",
        "x;y;z",
        *(";".join(f"{number:.4f}" for number in point) for point in seen),
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / "hemisphere-synthetic.csv").write_text(text(), encoding="utf-8")
