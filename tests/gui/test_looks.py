# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels and docks are readable in light and dark themes and fit on small screens and at 200 %. For
each screen, a separate FreeCAD opens all of them and measures its screen (tests/gui/looks.py)."""

import json
import os
import shutil
import subprocess

import pytest

from tests.window import ROOT, private_home

TIMEOUT_S = 500  # s, on a busy machine


SMALL_SCREEN, LARGE_SCREEN = ("1366x768", "96"), ("1920x1080", "192")
FEW_PAGES, ALL_PAGES = "2", "9"  # maximum number of pages of a panel


@pytest.mark.parametrize(
    ("screen", "dpi", "pages"),
    [
        (*SMALL_SCREEN, FEW_PAGES),
        (*LARGE_SCREEN, FEW_PAGES),
        (*SMALL_SCREEN, ALL_PAGES),
        (*LARGE_SCREEN, ALL_PAGES),
    ],
    ids=["small", "200 %", "small to the end", "200 % to the end"],
)
@pytest.mark.always("small", "200 %")
def test_all_is_read_and_seen(tmp_path, screen, dpi, pages):
    home, output_folder = tmp_path / "home", tmp_path / "seen"
    home.mkdir()
    output_folder.mkdir()
    env = {
        **private_home(home),
        "LOOKS_FOLDER": str(output_folder),
        "LOOKS_PAGES": pages,
        "LOOKS_ROOT": str(ROOT),
        "QT_FONT_DPI": dpi,
    }
    options = f"-screen 0 {screen}x24 -dpi 96 -nolisten tcp"
    program = shutil.which("freecad") or shutil.which("FreeCAD")
    script = str(ROOT / "tests" / "gui" / "looks.py")
    subprocess.run(
        ["xvfb-run", "-a", "-f", str(home / "Xauthority"), "-s", options]
        + ["timeout", str(TIMEOUT_S), program, script],
        env=env,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
    )
    pictures = os.environ.get("ROBOTIC_AM_PICTURES")
    for picture in output_folder.glob("*.png") if pictures else ():
        shutil.copy(picture, os.path.join(pictures, f"looks-{screen}-{picture.name}"))
    result = output_folder / "looks.json"
    assert result.exists(), "FreeCAD did not come to the end"
    wrong = json.loads(result.read_text(encoding="utf-8"))
    assert not wrong, "\n".join(wrong)
    docks = {picture.stem.split("-")[1] for picture in output_folder.glob("dark-*.png")}
    assert {"Path", "Simulate", "Plots", "SpinMap", "Placement", "NewJob", "Cell"} <= docks
