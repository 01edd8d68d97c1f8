# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of planned jobs with one thing changed at a random place: every one is refused, by the reader or by verifying.

None of these may pass: a program that passes is driven.
"""

import re
import zlib

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.mutations import KINDS, SMALLEST, mutated, stepped
from tests.posts.planned_jobs import CHORD_ERROR, SPANNING, WAYS, written

pytestmark = pytest.mark.any_version

DRAWS = 2
PARTS = 40  # points: the same job in parts


def found(way, files, most):
    """What is said about the files of a job: codes of errors."""
    cell, motion, program, _ = written(way, most)
    try:
        result = verify(cell, motion, program, files, catalogue.load(way[0]), CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


def spoilt(way, kind, draw):
    """A text with that kind of damage, and the size of its parts; None where the text has nothing of that kind."""
    pattern, change = KINDS[way[0]][kind]
    rng = np.random.default_rng([zlib.crc32(repr((way, kind)).encode()), draw])
    most = PARTS if draw % 2 or "part" in kind else 2000
    return mutated(written(way, most)[3], pattern, change, rng), most


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.parametrize("most", [2000, PARTS])
def test_what_is_written_passes(way, most):
    assert found(way, written(way, most)[3], most) == set()
    files = written(way, most)[3]
    parts = (
        files["job.script"].count(b"  def job") if way[0] == "ur" else len(files)
    )  # functions in one file
    assert (parts > (4 if way[0] == "staubli" else 1)) == (most == PARTS)


@pytest.mark.always(*(f"0-{way}" for way in SPANNING))
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
@pytest.mark.parametrize("first", [0, pytest.param(1, marks=pytest.mark.long)])
def test_what_is_damaged_is_refused(way, first):
    """By turns the job in one text and in parts."""
    passed, tried = [], set()
    for number, kind in enumerate(KINDS[way[0]]):
        draw = (number + first) % DRAWS
        files, most = spoilt(way, kind, draw)
        if files is None:
            continue
        assert files != written(way, most)[3]
        tried.add(kind)
        if not found(way, files, most):
            before = written(way, most)[3]
            for name in files:
                lines = zip(before[name].decode().split("\n"), files[name].decode().split("\n"))
                passed += [(kind, draw, name, old, new) for old, new in lines if old != new][:1]
    assert not passed
    assert len(tried) >= 20


@pytest.mark.always(*SPANNING)
@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_the_least_change_of_a_number_that_is_more_than_its_digits_explain_is_refused(way):
    passed, tried = [], 0
    for kind, (pattern, steps) in SMALLEST[way[0]].items():
        rng = np.random.default_rng(zlib.crc32(repr((way, kind)).encode()))
        for _ in range(DRAWS):
            files = mutated(written(way)[3], pattern, stepped(steps), rng)
            tried += files is not None
            passed += [kind] if files is not None and not found(way, files, 2000) else []
    assert not passed and tried >= 3 * DRAWS


@pytest.mark.parametrize("name", ["yaskawa track", "yaskawa track and positioner"])
def test_a_share_of_the_axes_speeds_is_known_as_well_with_axes_that_slide_and_turn_beside_the_robot(
    name,
):
    """Digits of the track are millimetres, and its speed is too: neither counts for the axes that turn."""
    way = ("yaskawa", "joint", "time", name)
    ((file, content),) = written(way)[3].items()
    text = content.decode()
    shares = list(re.finditer(r"VJ=(\d+\.\d\d)", text))
    assert len(shares) > 40
    for share in shares[1:]:  # the first move of all goes at its own
        other = f"{float(share[1]) + 0.04:.2f}"
        assert found(
            way, {file: (text[: share.start(1)] + other + text[share.end(1) :]).encode()}, 2000
        ), share[0]


def test_every_kind_of_damage_was_done():
    for post, kinds in KINDS.items():
        done = {
            kind
            for way in WAYS
            if way[0] == post
            for kind in kinds
            if spoilt(way, kind, 0)[0] is not None
        }
        assert done == set(kinds), post
