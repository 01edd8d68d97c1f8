# SPDX-License-Identifier: LGPL-2.1-or-later
"""Does the tutorials again, as their tests do: the pictures they take go into docs/tutorials/images, the documents they end
with into resources/examples/samples.

    python3 docs/images/make_tutorials.py [PAGE...]

Needs what the tests of the window need, and Pillow.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
TESTS, PICTURES = ROOT / "tests" / "gui" / "tutorials", ROOT / "docs" / "tutorials" / "images"
SAMPLES = ROOT / "resources" / "examples" / "samples"
GALLERY = ROOT / "docs" / "images" / "gallery"
SMALL = {  # the pictures of the gallery, and which part of each
    "hemisphere-job": "view",
    "tube-wall": "all",
    "tube-layers": "above",
    "hemisphere-map": "all",
    "hemisphere-simulation": "left",
    "tube-plots": "all",
    "rotor-speeds": "above",
    "rotor-axes": "middle",
}
PARTS = {  # pixels: the window without toolbars, the 3D view alone, above a dock, left of one
    "all": (0, 97, 1398, 870),
    "view": (334, 98, 1398, 845),
    "above": (334, 98, 1270, 605),
    "left": (334, 98, 1040, 640),
    "middle": (334, 220, 1040, 845),
}
HIGH = 400
COLOURS, EXACT = (
    256,
    96,
)  # of a picture: how many, and how many of them the most frequent as they are
RECORDED = ("hemisphere", "tube-on-pipe")  # the documents that are kept


def main(pages: list[str]) -> int:
    """Status of the tests; nothing is replaced unless all of them passed."""
    tests = [
        str(path)
        for path in sorted(TESTS.glob("test_*.py"))
        if not pages or path.stem.split("_")[-1] in pages
    ]
    with tempfile.TemporaryDirectory() as folder:
        env = {**os.environ, "ROBOTIC_AM_PICTURES": folder}
        run = [sys.executable, "-m", "tests.run", "--long"]
        # each in a window of its own, where no panel has the size that another tutorial gave it
        status = max(
            subprocess.run([*run, test], cwd=ROOT, env=env, check=False).returncode
            for test in tests
        )
        if status == 0:
            PICTURES.mkdir(exist_ok=True)
            for path in sorted((Path(folder) / "tutorials").glob("*.png")):
                keep(path)
            GALLERY.mkdir(exist_ok=True)
            for name, part in SMALL.items():
                taken = Path(folder) / "tutorials" / f"{name}.png"
                if taken.exists():
                    shrink(taken, part)
            SAMPLES.mkdir(exist_ok=True)
            for path in (Path(folder) / "tutorials").glob("*.FCStd"):
                if path.stem in RECORDED:
                    shutil.copyfile(path, SAMPLES / path.name)
    return status


def keep(path: Path) -> None:
    """Write a picture with few colours, which takes a third of the room: the plain ones of the window stay as they are."""
    with Image.open(path) as picture:
        whole = picture.convert("RGB")
    colours, counts = np.unique(np.asarray(whole).reshape(-1, 3), axis=0, return_counts=True)
    ranked = colours[np.argsort(-counts, kind="stable")]
    rest = Image.fromarray(ranked[None, EXACT:]).quantize(
        COLOURS - EXACT, method=Image.Quantize.MAXCOVERAGE
    )
    palette = Image.new("P", (1, 1))
    palette.putpalette(
        [*ranked[:EXACT].ravel().tolist(), *rest.getpalette()[: 3 * (COLOURS - EXACT)]]
    )
    whole.quantize(palette=palette, dither=Image.Dither.NONE).save(
        PICTURES / path.name, optimize=True
    )


def shrink(path: Path, part: str) -> None:
    """Write a part of a picture for the gallery."""
    with Image.open(path) as picture:
        cut = picture.convert("RGB").crop(PARTS[part])
        small = cut.resize((round(HIGH * cut.width / cut.height), HIGH), Image.Resampling.LANCZOS)
        small.save(GALLERY / path.name, optimize=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
