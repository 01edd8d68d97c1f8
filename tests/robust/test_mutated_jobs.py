# SPDX-License-Identifier: LGPL-2.1-or-later
"""Each mutated job is carried out or rejected in time, and nothing is deposited outside its
part."""

import functools
import math
import re
from pathlib import Path

import numpy as np
import Part
import pytest
import yaml

from tests.robust import job_bases, mutations, rounds, triangles

STRIDE = (
    # a prime, so that neighbouring jobs have other families and machines, and each base has its
    # turn
    61
)
DEFLECTION = 0.05  # mm, deflection of the triangles that check the deposit points


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    """Return the folder of the small parts."""
    folder = tmp_path_factory.mktemp("parts")
    job_bases.write_parts(folder)
    return folder


def mutated_job(folder_, number, chance, folder):
    """Return the words of a command with a mutated job, and a function for the excess of its
    points."""
    jobs = job_bases.bases(str(folder_))
    base = jobs[number * STRIDE % len(jobs)][1]
    job = folder / "job.yaml"
    job.write_bytes(mutations.mutated(base, chance, folder_))
    if "place" in base:
        return ["place", "job.yaml", "-o", "out"], None
    page = [] if chance.random() < 0.1 else ["--no-page"]
    return ["plan", "job.yaml", "-o", "out", *page], functools.partial(largest_excess, job)


@functools.cache
def triangles_of(file):
    shape = Part.Shape()
    shape.read(file)
    vertices, facets = shape.tessellate(DEFLECTION)
    return np.array([[tuple(vertices[k]) for k in facet] for facet in facets])


def largest_excess(path, points, build):
    """Return how much the farthest deposit point exceeds the distance from the part that its job
    allows, in mm; 0 if unknown. Of several features, each point counts for the one that allows it
    most."""
    job = yaml.safe_load(path.read_bytes())
    if not len(points):
        return 0.0
    excesses = [
        _excess(path.parent, _merged(job, feature), points, build)
        for feature in job.get("features") or [{}]
    ]
    return float(np.min(excesses, axis=0).max())


def _merged(job, feature):
    """Return the sections that define a feature: its own keys over those of the job."""
    names = ("part", "substrate", "strategy", "process")
    return {name: {**_section(job, name), **_section(feature, name)} for name in names}


def _section(job, name):
    """Return a section as a mapping; the job file too treats a blank one as empty."""
    return job[name] if isinstance(job.get(name), dict) else {}


def _excess(folder, job, points, build):
    """Return how much each point (n,) exceeds the distance that a feature allows, in mm."""
    strategy, process, scan = job["strategy"], job["process"], job["substrate"]
    file = folder / job["part"]["file"]
    if file.suffix not in (".step", ".brep", ".igs"):
        return np.zeros(len(points))
    around = triangles_of(str(file.resolve()))
    distances = np.min(
        [triangles.distance(cut_points, around) for cut_points in cuts(points, build, strategy)],
        axis=0,
    )
    distances -= (
        length(scan.get("scan_within", 5.0)) if scan.get("scan") else 0.0
    )  # layers follow the scanned surface
    chord = length(strategy.get("chord_error", 0.01))
    if strategy.get("kind") in (
        "developable",
        "solid",
        "auto",
    ):  # of the parts in these jobs, the last becomes a solid
        inside = [
            triangles.inside(cut_points, around) for cut_points in cuts(points, build, strategy)
        ]
        distances = np.where(np.any(inside, axis=0), 0.0, distances)
        widest = max(
            length(strategy.get("bead_spacing", 5.0)), length(process.get("bead_width", 8.0))
        )
        return distances - (
            0.5 * widest + length(strategy.get("margin", 0.0)) + chord + DEFLECTION + 0.02
        )
    if strategy.get("kind") == "cladding":  # along the normals of its faces
        return distances - (
            strategy.get("layers", 1) * length(strategy.get("layer_height", 1.0))
            + chord
            + DEFLECTION
            + 0.02
        )
    if strategy.get("wall") == "middle":  # halfway between two walls of the part
        return distances - 10.0
    return distances - (chord + DEFLECTION + 0.02)


def cuts(points, build, strategy):
    """Return the points shifted to where the part may have been cut for their layers: plane layers
    at bottom, middle or top."""
    high = length(strategy.get("layer_height", 1.0)) if strategy.get("kind") == "solid" else 0.0
    high = (
        high if math.isfinite(high) else 0.0
    )  # an unreadable length is infinite as a tolerance, but a shift must be finite
    return [points + share * high * build for share in ((0.0, 0.5, 1.0) if high else (0.0,))]


def length(value):
    """Return a length in mm in the format of jobs; infinite in any other format."""
    if isinstance(value, (int, float)):
        return float(value)
    written = re.fullmatch(r"([-+.\de]*[.\d]) *([a-z]*)", str(value))
    try:
        return (
            float(written[1])
            * {"mm": 1.0, "": 1.0, "m": 1000.0, "in": 25.4, "um": 1e-3}[written[2]]
        )
    except (TypeError, ValueError, KeyError):
        return math.inf


def test_every_base_is_sound(parts):
    """The names of parts and machines are valid, so all of them are found."""
    for name, job in job_bases.bases(str(parts)):
        assert all(
            Path(job[key]["file"]).is_file() for key in ("part", "substrate") if key in job
        ), name


def test_mutated_jobs(parts, tmp_path):
    rounds.assert_sound(functools.partial(mutated_job, parts), 30, 6, tmp_path)


@pytest.mark.long
def test_ten_thousand_mutated_jobs(parts, tmp_path):
    rounds.assert_sound(
        functools.partial(mutated_job, parts), 10_000, rounds.seed_of_round(), tmp_path
    )
