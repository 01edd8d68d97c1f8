# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of planned jobs with one random change are all rejected, by the reader or by verification.
None may pass, because a program that passes is run."""

import re
import zlib

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.mutations import KINDS, SMALLEST_REJECTED, mutated, step_number
from tests.posts.planned_jobs import CHORD_ERROR, SPANNING, WAYS, write_program

pytestmark = pytest.mark.any_version

DRAWS = 2
PARTS = 40  # points: the same job in parts


def error_codes(variant, files, max_points):
    """Return the codes of the errors in the files of a job."""
    cell, motion, program, _ = write_program(variant, max_points)
    try:
        result = verify(cell, motion, program, files, catalogue.load(variant[0]), CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


def damage_text(variant, kind, draw):
    """Return a text with that kind of damage and the size of its parts; None if the text has no
    match for it."""
    pattern, change = KINDS[variant[0]][kind]
    rng = np.random.default_rng([zlib.crc32(repr((variant, kind)).encode()), draw])
    max_points = PARTS if draw % 2 or "part" in kind else 2000
    return mutated(write_program(variant, max_points)[3], pattern, change, rng), max_points


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.parametrize("most", [2000, PARTS])
def test_what_is_written_passes(way, most):
    assert error_codes(way, write_program(way, most)[3], most) == set()
    files = write_program(way, most)[3]
    in_parts = (
        files["job.script"].count(b"  def job") if way[0] == "ur" else len(files)
    )  # functions in one file
    assert (in_parts > (4 if way[0] == "staubli" else 1)) == (most == PARTS)


@pytest.mark.always(*(f"0-{variant}" for variant in SPANNING))
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.parametrize("first", [0, pytest.param(1, marks=pytest.mark.long)])
def test_what_is_damaged_is_refused(way, first):
    """The job is damaged in one text and in parts, by turns."""
    passed, kinds_done = [], set()
    for number, kind in enumerate(KINDS[way[0]]):
        draw = (number + first) % DRAWS
        files, max_points = damage_text(way, kind, draw)
        if files is None:
            continue
        assert files != write_program(way, max_points)[3]
        kinds_done.add(kind)
        if not error_codes(way, files, max_points):
            intact = write_program(way, max_points)[3]
            for name in files:
                lines = zip(intact[name].decode().split("\n"), files[name].decode().split("\n"))
                passed += [(kind, draw, name, old, new) for old, new in lines if old != new][:1]
    assert not passed
    assert len(kinds_done) >= 20


@pytest.mark.always(*SPANNING)
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_the_least_change_of_a_number_that_is_more_than_its_digits_explain_is_refused(way):
    passed, attempts = [], 0
    for kind, (pattern, steps) in SMALLEST_REJECTED[way[0]].items():
        rng = np.random.default_rng(zlib.crc32(repr((way, kind)).encode()))
        for _ in range(DRAWS):
            files = mutated(write_program(way)[3], pattern, step_number(steps), rng)
            attempts += files is not None
            passed += [kind] if files is not None and not error_codes(way, files, 2000) else []
    assert not passed and attempts >= 3 * DRAWS


@pytest.mark.parametrize("name", ["yaskawa track", "yaskawa track and positioner"])
def test_a_share_of_the_axes_speeds_is_known_as_well_with_axes_that_slide_and_turn_beside_the_robot(
    name,
):
    """The track's rounding and speed are in mm: neither counts for the revolute axes."""
    variant = ("yaskawa", "joint", "time", name)
    ((file, content),) = write_program(variant)[3].items()
    text = content.decode()
    shares = list(re.finditer(r"VJ=(\d+\.\d\d)", text))
    assert len(shares) > 40
    for share in shares[1:]:  # the very first move has its own speed
        changed_share = f"{float(share[1]) + 0.04:.2f}"
        assert error_codes(
            variant,
            {file: (text[: share.start(1)] + changed_share + text[share.end(1) :]).encode()},
            2000,
        ), share[0]


def test_every_kind_of_damage_was_done():
    for post, kinds in KINDS.items():
        kinds_done = {
            kind
            for variant in WAYS
            if variant[0] == post
            for kind in kinds
            if damage_text(variant, kind, 0)[0] is not None
        }
        assert kinds_done == set(kinds), post
