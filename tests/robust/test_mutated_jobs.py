# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs to which something was done: each is carried out or refused, in time, and nothing is laid off its part."""

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
    61  # a prime: neighbouring jobs are of other families and machines, and each base has its turn
)
DEFLECTION = 0.05  # mm of the triangles that deposit points are held against


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    """The folder of the small parts."""
    folder = tmp_path_factory.mktemp("parts")
    job_bases.write_parts(folder)
    return folder


def mutated_job(parts, number, chance, folder):
    """The words of a command with a mutated job, and how far points are off what they may be."""
    known = job_bases.bases(str(parts))
    base = known[number * STRIDE % len(known)][1]
    job = folder / "job.yaml"
    job.write_bytes(mutations.mutated(base, chance, parts))
    if "place" in base:
        return ["place", "job.yaml", "-o", "out"], None
    page = [] if chance.random() < 0.1 else ["--no-page"]
    return ["plan", "job.yaml", "-o", "out", *page], functools.partial(off, job)


@functools.cache
def triangles_of(file):
    shape = Part.Shape()
    shape.read(file)
    vertices, facets = shape.tessellate(DEFLECTION)
    return np.array([[tuple(vertices[k]) for k in facet] for facet in facets])


def off(path, points, build):
    """By how much, mm, the farthest deposit point is farther off the part than its job allows; 0 where nobody can tell. Of
    several features each point is of the one that allows it most."""
    job = yaml.safe_load(path.read_bytes())
    if not len(points):
        return 0.0
    found = [
        _excess(path.parent, _merged(job, feature), points, build)
        for feature in job.get("features") or [{}]
    ]
    return float(np.min(found, axis=0).max())


def _merged(job, feature):
    """The sections that tell what a feature is: its own keys over those of the job."""
    names = ("part", "substrate", "strategy", "process")
    return {name: {**_section(job, name), **_section(feature, name)} for name in names}


def _section(job, name):
    """A section as a mapping: one of blanks is empty to the job file too."""
    return job[name] if isinstance(job.get(name), dict) else {}


def _excess(folder, job, points, build):
    """By how much, mm, each point (n,) is farther off than a feature allows."""
    strategy, process, scan = job["strategy"], job["process"], job["substrate"]
    file = folder / job["part"]["file"]
    if file.suffix not in (".step", ".brep", ".igs"):
        return np.zeros(len(points))
    around = triangles_of(str(file.resolve()))
    away = np.min(
        [triangles.distance(place, around) for place in cuts(points, build, strategy)], axis=0
    )
    away -= (
        length(scan.get("scan_within", 5.0)) if scan.get("scan") else 0.0
    )  # layers lie on what was scanned
    chord = length(strategy.get("chord_error", 0.01))
    if strategy.get("kind") in (
        "developable",
        "solid",
        "auto",
    ):  # of parts in these jobs the last comes to a solid
        inside = [triangles.inside(place, around) for place in cuts(points, build, strategy)]
        away = np.where(np.any(inside, axis=0), 0.0, away)
        widest = max(
            length(strategy.get("bead_spacing", 5.0)), length(process.get("bead_width", 8.0))
        )
        return away - (
            0.5 * widest + length(strategy.get("margin", 0.0)) + chord + DEFLECTION + 0.02
        )
    if strategy.get("kind") == "cladding":  # along the normals of its faces
        return away - (
            strategy.get("layers", 1) * length(strategy.get("layer_height", 1.0))
            + chord
            + DEFLECTION
            + 0.02
        )
    if strategy.get("wall") == "middle":  # halfway between two walls of the part
        return away - 10.0
    return away - (chord + DEFLECTION + 0.02)


def cuts(points, build, strategy):
    """Where the part may have been cut for the layers that points lie in: plane layers at bottom, middle or top."""
    high = length(strategy.get("layer_height", 1.0)) if strategy.get("kind") == "solid" else 0.0
    high = (
        high if math.isfinite(high) else 0.0
    )  # what lies off the part is judged by it too, endlessly mild
    return [points + share * high * build for share in ((0.0, 0.5, 1.0) if high else (0.0,))]


def length(value):
    """mm of a length as jobs write it; endless where it is written in another way."""
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
    """Names of parts and machines as they are: all of them are found."""
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
