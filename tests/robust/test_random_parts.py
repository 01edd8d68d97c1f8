# SPDX-License-Identifier: LGPL-2.1-or-later
"""Each random part is planned, rejected or infeasible, in time, and the deposit of a plan is on the
part."""

import functools

import pytest
import yaml

from tests.robust import random_parts, rounds
from tests.robust.test_mutated_jobs import parts  # noqa: F401


def random_part(machines, number, chance, folder):
    """Return the words of a command with a random part, and a function for the excess of its
    points."""
    job, off = random_parts.write(chance, folder, machines)
    (folder / "job.yaml").write_text(yaml.safe_dump(job), encoding="utf-8")
    page = [] if chance.random() < 0.1 else ["--no-page"]
    return ["plan", "job.yaml", "-o", "out", *page], off


def test_random_parts(parts, tmp_path):  # noqa: F811
    rounds.assert_sound(
        functools.partial(random_part, random_parts.machines(str(parts))), 8, 83101, tmp_path
    )


@pytest.mark.long
def test_a_thousand_random_parts(parts, tmp_path):  # noqa: F811
    make = functools.partial(random_part, random_parts.machines(str(parts)))
    rounds.assert_sound(make, 1000, rounds.seed_of_round(), tmp_path)
