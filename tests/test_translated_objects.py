# SPDX-License-Identifier: LGPL-2.1-or-later
"""Helps and choices of every kind of object are among the texts that have to be translated."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "resources" / "translations"))

import collect  # noqa: E402


def test_the_helps_of_every_object_are_collected():
    found = {
        name
        for path in (ROOT / "freecad_am" / "objects").rglob("*.py")
        for name in re.findall(
            r"^class (\w+)\((?:Feature)?Stage\)", path.read_text(encoding="utf-8"), re.MULTILINE
        )
    }
    found.remove("FeatureStage")  # which has no fields of its own
    assert len(found) > 9 and {stage.__name__ for stage in collect.STAGES} == found
