# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tooltips and choices of every kind of object are among the texts to translate."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "resources" / "translations"))

import collect  # noqa: E402


def test_the_helps_of_every_object_are_collected():
    kinds = {
        name
        for path in (ROOT / "freecad_am" / "objects").rglob("*.py")
        for name in re.findall(
            r"^class (\w+)\((?:Feature)?Stage\)", path.read_text(encoding="utf-8"), re.MULTILINE
        )
    }
    kinds.remove("FeatureStage")  # this base class has no properties of its own
    assert len(kinds) > 9 and {stage.__name__ for stage in collect.STAGES} == kinds
