# SPDX-License-Identifier: LGPL-2.1-or-later
"""The catalogue states which files of a program the controller has to run."""

import ast
import re
from pathlib import Path

import pytest

from freecad_am.posts import catalogue

pytestmark = pytest.mark.any_version

GOLDEN = Path(__file__).resolve().parent.parent / "golden"


@pytest.mark.parametrize(
    ("files", "main"),
    [
        (["CUP01.LS", "CUP.LS", "CUP02.LS"], "CUP.LS"),
        (["A1.MPF", "A101.SPF", "A102.SPF"], "A1.MPF"),
        (["cup01.ngc", "cup.ngc"], "cup.ngc"),
        (
            [
                "CUP/CUP.pjx",
                "CUP/start.pgx",
                "CUP/stop.pgx",
                "CUP/CUP01/start.pgx",
                "CUP/CUP01/CUP01.dtx",
            ],
            "CUP/start.pgx",
        ),
    ],
)
def test_it_is_the_one_that_calls_the_others(files, main):
    assert catalogue.main_file(files) == catalogue.main_file(reversed(files)) == main


@pytest.mark.parametrize("folder", ["val3/gauge", "siemens/tip", "linuxcnc/tip"])
def test_of_programs_that_are_written_it_names_all_parts(folder):
    files = [
        path.relative_to(GOLDEN / folder).as_posix()
        for path in (GOLDEN / folder).rglob("*")
        if path.is_file()
    ]
    main = catalogue.main_file(files)
    part_names = {
        match.group() for name in files if (match := re.search(r"(?i)(gauge|tip)\d\d", name))
    }
    text = (GOLDEN / folder / main).read_text(encoding="latin-1")
    assert len(part_names) == 2 and all(part_name in text for part_name in part_names)


def test_no_other_room_names_a_controller():
    """Only its post knows a controller: no constant elsewhere is the name of one, except the
    default post of a new job."""
    package = Path(catalogue.__file__).resolve().parent.parent
    named = {
        (path.relative_to(package).as_posix(), node.value)
        for path in package.rglob("*.py")
        if path.relative_to(package).parts[0] != "posts"
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and node.value in catalogue.NAMES
    }
    assert named == {("core/parameters/program.py", "fanuc")}
