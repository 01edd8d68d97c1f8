# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random parts: each is planned, refused or infeasible, in time, and what is planned lies on it."""

import functools

import pytest
import yaml

from tests.robust import random_parts, rounds
from tests.robust.test_mutated_jobs import parts  # noqa: F401


def random_part(machines, number, chance, folder):
    """The words of a command with a random part, and how far points are off what they may be."""
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
    made = functools.partial(random_part, random_parts.machines(str(parts)))
    rounds.assert_sound(made, 1000, rounds.seed_of_round(), tmp_path)
