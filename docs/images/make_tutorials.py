# SPDX-License-Identifier: LGPL-2.1-or-later
"""Does the tutorials again, as their tests do: the pictures they take go into docs/tutorials/images, the documents they end
with into resources/examples/samples.

    python3 docs/images/make_tutorials.py [PAGE...]

Needs what the tests of the window need, and Pillow. Pictures are kept with 256 colours, which takes a fifth of the room.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
TESTS, PICTURES = ROOT / "tests" / "gui" / "tutorials", ROOT / "docs" / "tutorials" / "images"
SAMPLES = ROOT / "resources" / "examples" / "samples"
GALLERY = ROOT / "docs" / "images" / "gallery"
SMALL = {  # the pictures of the gallery, and which part of each
    "hemisphere-job": "view", "tube-wall": "all", "tube-layers": "above", "hemisphere-map": "all",
    "hemisphere-simulation": "left", "tube-plots": "all", "rotor-speeds": "above", "rotor-axes": "left",
}
PARTS = {  # pixels: the window without toolbars, the 3D view alone, above a dock, left of one
    "all": (0, 97, 1398, 870), "view": (334, 98, 1398, 686), "above": (334, 98, 1260, 610), "left": (334, 98, 1040, 488),
}
WIDE = 420
RECORDED = ("hemisphere", "tube-on-pipe")  # the documents that are kept
COLOURS = 256


def main(pages: list[str]) -> int:
    """Status of the tests; nothing is replaced unless all of them passed."""
    tests = [str(path) for path in sorted(TESTS.glob("test_*.py")) if not pages or path.stem.split("_")[-1] in pages]
    with tempfile.TemporaryDirectory() as folder:
        env = {**os.environ, "ROBOTIC_AM_PICTURES": folder}
        status = subprocess.run([sys.executable, str(ROOT / "tests" / "run.py"), *tests], env=env, check=False).returncode
        if status == 0:
            PICTURES.mkdir(exist_ok=True)
            for path in sorted((Path(folder) / "tutorials").glob("*.png")):
                keep(path)
            GALLERY.mkdir(exist_ok=True)
            for name, part in SMALL.items():
                shrink(Path(folder) / "tutorials" / f"{name}.png", part)
            SAMPLES.mkdir(exist_ok=True)
            for path in (Path(folder) / "tutorials").glob("*.FCStd"):
                if path.stem in RECORDED:
                    shutil.copyfile(path, SAMPLES / path.name)
    return status


def keep(path: Path) -> None:
    """Write a picture with few colours; edges of text stay as they are, for nothing is dithered."""
    with Image.open(path) as picture:
        few = picture.convert("RGB").quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
        few.save(PICTURES / path.name, optimize=True)


def shrink(path: Path, part: str) -> None:
    """Write a part of a picture for the gallery."""
    with Image.open(path) as picture:
        cut = picture.convert("RGB").crop(PARTS[part])
        small = cut.resize((WIDE, round(WIDE * cut.height / cut.width)), Image.Resampling.LANCZOS)
        small.quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(
            GALLERY / path.name, optimize=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
