# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels and docks can be read in light and dark themes and have their room on small screens and at 200 %.

Each screen is one FreeCAD of its own, which opens all of them and measures what its screen shows (tests/gui/looks.py).
"""

import json
import os
import shutil
import subprocess

import pytest

from tests.window import ROOT, private_home

TIMEOUT = 500  # s, on a busy machine


SMALL, LARGE = ("1366x768", "96"), ("1920x1080", "192")
FEW, ALL = "2", "9"  # pages of a panel, at most


@pytest.mark.parametrize(
    ("screen", "dpi", "pages"),
    [(*SMALL, FEW), (*LARGE, FEW), (*SMALL, ALL), (*LARGE, ALL)],
    ids=["small", "200 %", "small to the end", "200 % to the end"],
)
@pytest.mark.always("small", "200 %")
def test_all_is_read_and_seen(tmp_path, screen, dpi, pages):
    home, seen = tmp_path / "home", tmp_path / "seen"
    home.mkdir()
    seen.mkdir()
    env = {
        **private_home(home),
        "LOOKS_FOLDER": str(seen),
        "LOOKS_PAGES": pages,
        "LOOKS_ROOT": str(ROOT),
        "QT_FONT_DPI": dpi,
    }
    options = f"-screen 0 {screen}x24 -dpi 96 -nolisten tcp"
    program = shutil.which("freecad") or shutil.which("FreeCAD")
    script = str(ROOT / "tests" / "gui" / "looks.py")
    subprocess.run(
        ["xvfb-run", "-a", "-f", str(home / "Xauthority"), "-s", options]
        + ["timeout", str(TIMEOUT), program, script],
        env=env,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
    )
    pictures = os.environ.get("ROBOTIC_AM_PICTURES")
    for picture in seen.glob("*.png") if pictures else ():
        shutil.copy(picture, os.path.join(pictures, f"looks-{screen}-{picture.name}"))
    result = seen / "looks.json"
    assert result.exists(), "FreeCAD did not come to the end"
    wrong = json.loads(result.read_text(encoding="utf-8"))
    assert not wrong, "\n".join(wrong)
    docks = {picture.stem.split("-")[1] for picture in seen.glob("dark-*.png")}
    assert {"Path", "Simulate", "Plots", "SpinMap", "Placement", "NewJob", "Cell"} <= docks
