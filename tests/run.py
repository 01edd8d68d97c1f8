# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the tests: plain and headless ones here, those of the window in FreeCAD under Xvfb; sums all up.

Arguments go to pytest, both times; `--long` among them adds the tests that are marked as long (docs/testing.md).
`--with-freecad 1.0` first among them runs what depends on FreeCAD's version in that version too (tests/versions/run.sh).
The tests are cut into parts, of which as many run at the same time as keep the cores busy; the last lines tell what they
took.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from tests.run_parts import (
    ROOT,
    TIMES,
    Part,
    failures,
    run_parts,
    say,
    tell_failures,
    tell_times,
    told_of,
    watched,
)

GUI = ROOT / "tests" / "gui"
WINDOW_TIMEOUT = (
    3000  # s for all tests of the window; one that hangs ends much sooner (tests/gui_runner.py)
)
HEADLESS_TIMEOUT = 2400  # s for a part without a window
LONG_TIMEOUT = 8 * 3600  # with long tests, and where tests are named
# folders and files of parts of their own, and one more part has all the rest: first the BESIDE ones that only compute,
# beside the windows; then the rest, and the others longest first and down to a minute, so that both cores end together
FOLDERS = (
    ("core/strategies",),
    ("core/filling", "core/slicing"),
    ("core/planning", "core/kinematics"),
    ("batch",),
    ("objects", "interop"),
    ("robust",),
    ("batch/test_wall_examples.py",),
    tuple(
        f"batch/test_{name}.py"
        for name in ("plan_command", "batch_command", "export_command", "interruption")
    ),
    ("brep",),
    tuple(
        f"batch/test_{name}.py"
        for name in (
            "examples",
            "thruster",
            "deflected_thruster",
            "staubli_example",
            "table_example",
        )
    ),
    ("posts", "core/geometry"),
)
BESIDE = 3
WINDOWS = (
    (
        "test_robust.py",
        *(
            f"test_{name}.py"
            for name in (
                "robust_events",
                "selected_job",
                "wall_clicks",
                "path",
                "panels",
                "cell_preview",
                "program_preview",
            )
        ),
    ),
    (
        "tutorials",
        *(
            f"test_{name}.py"
            for name in ("redundancy_map", "new_machine", "flow", "docks", "tree", "clicks")
        ),
    ),
)
# of a core: what a window has beside two others; what each of two BESIDE parts, far behind them, has of what they leave; and
# what other parts have, which wait for processes of theirs: with three a twelfth of the cores was idle, with four not
WAITING, LEFT, USUAL = 0.4, 0.6, 0.6
BEHIND = 15  # the niceness of the headless tests, so that no click in a window comes late for them
# what depends on FreeCAD's version (docs/testing.md tells why): documents, shapes and what is written of them, without those
# whose numbers are those of core, of triangles too; commands as they start, plan, export and are interrupted; of the window
# what is saved and opened, undone, typed, picked, done beside it, and what may crash it
HEADLESS_OF_VERSION = (
    *(
        f"tests/{name}"
        for name in ("objects", "brep", "kdl", "posts", "interop", "test_package.py")
    ),
    *(f"tests/batch/test_{name}.py" for name in ("plan_command", "export_command", "interruption")),
    *(
        f"--deselect=tests/batch/test_plan_command.py::test_{name}"
        for name in (
            "the_page_is_one_file_that_parses",
            "sections_left_out_end_the_job_early",
            "an_infeasible_job_writes_all_but_the_program",
            "a_toolpath_that_cannot_be_deposited_is_reported_too",
            "a_run_of_another_name_takes_the_place_of_the_last",
            "folders_in_the_place_of_files_leave_all_as_it_was",
            "machines_lists_those_that_plan_accepts",
            "a_large_job_is_told_before_its_work",
            "through_a_link_and_from_elsewhere",
            "progress_shows_on_a_terminal_and_is_gone_at_the_end",
        )
    ),
    *(
        f"--deselect=tests/{file}.py::test_{name}"
        for file, name in (
            (
                "batch/test_export_command",
                "what_an_earlier_longer_export_left_is_removed_and_nothing_else",
            ),
            ("batch/test_export_command", "what_cannot_be_carried_out_is_status_3"),
            ("brep/test_any_wall", "refusals_by_real_shapes"),
            (
                "brep/test_any_wall",
                "the_mesh_of_a_slanted_tube_has_no_edges_across[15.0-150.0-0.5-5.0]",
            ),
            ("brep/test_kernel_process", "both_come_to_the_same_numbers[blade]"),
            ("brep/test_kernel_process", "both_come_to_the_same_numbers[walls/"),
            (
                "brep/test_many_faces",
                "a_thousand_faces_that_are_not_of_revolution_are_soon_refused[gear]",
            ),
            ("brep/test_wall_input", "a_large_mesh"),
            ("interop/test_interop", "motion_and_toolpath_give_the_same_beads"),
            ("objects/test_api", "a_new_job_of_another_robot_can_be_carried_out"),
            ("objects/test_developable_feature", "a_bead_width_that_a_macro_gives_is_meant"),
            ("objects/test_developable_feature", "meshes_are_solids_too_and_repairs_are_told"),
            ("objects/test_inspection_documents", "feature_toolpath_shape_and_mesh_tell_the_same"),
            ("objects/test_scan", "a_fitted_wall_is_held_against_its_faces_once_it_is_fitted"),
            ("objects/test_sequence", "the_order_is_that_of_the_list"),
            ("objects/test_solid_feature", "a_damaged_mesh_is_filled_as_the_whole_one"),
            ("objects/test_solid_feature", "a_mesh_and_the_shape_it_is_of_are_filled_alike"),
            ("objects/test_solid_feature", "beads_lie_in_the_shape"),
            ("objects/test_surface_feature", "fixtures_count_and_renew_the_toolpath"),
            (
                "objects/test_table_documents",
                "what_makes_a_program_impossible_is_told_before_anything_is_planned",
            ),
        )
    ),
    *(
        f"--ignore=tests/objects/test_{name}.py"
        for name in (
            "layers_otherwise",
            "memory",
            "one_thread",
            "ready",
            "rotor_rapids",
            "samples",
            "suited_cell",
        )
    ),
    *(
        f"--ignore=tests/brep/test_{name}.py"
        for name in ("fine_mesh", "mesh_wall", "part_depths", "three_mf")
    ),
    *(
        f"--ignore=tests/posts/test_{name}.py"
        for name in (
            "contract",
            "driven_texts",
            "mutations",
            "nc_read",
            "fanuc_read",
            "staubli_read",
            "retreat",
            "weave",
            "schedules",
            "phases",
            "matrix",
            "plain_reading",
            "plain_texts",
            "fanuc_refusals",
            "lines",
            "resume",
            "ramps",
            "catalogue",
        )
    ),
)
# beads and figures of each kind of feature, which are core's; how far a deposit is off its part, and walls and meshes that
# others of their kind stand for: with the long tests, or by name
LONG_IN_VERSION = (
    *(
        f"--ignore=tests/objects/test_{name}.py"
        for name in (
            "developable_feature",
            "inspection_documents",
            "scan",
            "solid_feature",
            "suited_cell",
            "sequence",
        )
    ),
    *(f"--ignore=tests/brep/test_{name}.py" for name in ("off_part", "whole_mesh", "wall_joints")),
    *(
        f"--deselect=tests/brep/test_{test}"
        for test in (
            "any_wall.py::test_splines_loft_and_pipe",
            "any_wall.py::test_what_stands_on_the_platform_needs_no_substrate_either",
            "any_wall.py::test_the_mesh_of_a_slanted_tube_that_is_cut_has_no_edges_across",
            "many_faces.py::test_hundreds_of_rings_are_one_wall",
            "wall_kernel.py::test_walls_that_cross_themselves_are_refused[crossing_pipe]",
        )
    ),
    *(
        f"--deselect=tests/objects/test_{test}"
        for test in (
            "api.py::test_remedies_that_take_long_are_told_before_they_are_looked_for",
            "api.py::test_a_new_job_of_a_kuka_robot_with_the_torch_ends_with_a_program",
            "place.py::test_the_best_pose_of_a_macro_makes_the_job_feasible",
        )
    ),
    *(
        f"--deselect=tests/objects/test_surface_feature.py::test_{name}"
        for name in (
            "feature_and_toolpath",
            "renewed_when_the_substrate_changes",
            "needs_a_solid_substrate",
            "a_wall_that_reaches_below_the_platform_is_refused_with_its_depth",
            "tilts_that_take_long_are_told_before_they_are_searched_for",
            "fixtures_of_a_part_of_revolution_are_looked_at",
            "a_tube_is_planned_by_fronts_where_that_is_chosen",
        )
    ),
)
WINDOW_OF_VERSION = (
    *(
        f"tests/gui/test_{name}.py"
        for name in ("fields", "long_work", "picking", "reopen", "robust_events", "samples")
    ),
    "tests/gui/test_clicks.py::test_from_a_selected_shape_to_a_program_by_clicks",
    "tests/gui/test_robust.py::test_closed_panels_leave_nothing_behind",
    "tests/gui/test_robust.py::test_a_job_copied_into_another_document[True]",
    "tests/gui/test_robust.py::test_a_document_closed_while_a_panel_is_open",
    "--deselect=tests/gui/test_robust_events.py::test_a_parameter_follows_a_spreadsheet_until_that_goes",
    *(
        f"--deselect=tests/gui/test_long_work.py::test_cancel_ends_the_work_and_leaves_the_document_as_it_was[{stage}]"
        for stage in ("joints", "wall", "hub")
    ),
    "--deselect=tests/gui/test_reopen.py::test_directions_and_infeasible_points_are_drawn_on_demand",
)
# foreign interpreters read the texts of programs, which the golden files hold equal in all versions
NOT_OF_VERSION = "tests/posts/test_interpreters.py"
FAILED, NO_TESTS, UNABLE = 1, 5, 77  # statuses of pytest, and of tests/versions/run.sh
TOO_LONG = 124  # of timeout
SIGNS = {".": "passed", "F": "failed", "E": "failed", "s": "skipped"}  # of pytest, one per test
LONG = "--long"  # of tests/conftest.py
LEFT_OUT = ("--ignore=", "--deselect=")  # of pytest
FEW = 8  # tests of the window that are run again when they failed
SCREEN = "-screen 0 1400x900x24 -dpi 96 -nolisten tcp"
PREFERENCES = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<FCParameters><FCParamGroup Name="Root"><FCParamGroup Name="BaseApp"><FCParamGroup Name="Preferences">
<FCParamGroup Name="General"><FCText Name="AutoloadModule">RoboticAMWorkbench</FCText>
<FCBool Name="ShowSplasher" Value="0"/><FCText Name="Language">English</FCText></FCParamGroup>
<FCParamGroup Name="View"><FCBool Name="UseNavigationAnimations" Value="0"/><FCBool Name="ShowNaviCube" Value="0"/>
<FCBool Name="CornerCoordSystem" Value="0"/></FCParamGroup>
<FCParamGroup Name="Document"><FCBool Name="RecoveryEnabled" Value="0"/><FCBool Name="AutoSaveEnabled" Value="0"/>
</FCParamGroup><FCParamGroup Name="Mod"><FCParamGroup Name="Start"><FCBool Name="ShowOnStartup" Value="0"/>
<FCBool Name="FirstStart2024" Value="0"/></FCParamGroup></FCParamGroup></FCParamGroup>
<FCParamGroup Name="MainWindow"><FCBool Name="Maximized" Value="1"/></FCParamGroup></FCParamGroup></FCParamGroup>
</FCParameters>
"""


def private_home(folder: Path) -> dict[str, str]:
    """An environment with a fresh FreeCAD profile in the folder and this workbench linked into it."""
    (folder / "Mod").mkdir()
    (folder / "Mod" / "RoboticAM").symlink_to(ROOT)
    (folder / "user.cfg").write_text(PREFERENCES, encoding="utf-8")
    places = {
        f"XDG_{name}_HOME": str(folder / name.lower()) for name in ("CONFIG", "CACHE", "DATA")
    }
    runtime = folder / "runtime"
    runtime.mkdir(mode=0o700)
    return {
        **os.environ,
        **places,
        "XDG_RUNTIME_DIR": str(runtime),
        "FREECAD_USER_HOME": str(folder),
        # the start page's browser will not run as root otherwise
        "QTWEBENGINE_DISABLE_SANDBOX": "1",
        "LIBGL_ALWAYS_SOFTWARE": "1",
        "LP_NUM_THREADS": "0",
        "QT_QPA_PLATFORM": "xcb",
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
        # parts run at the same time, and threads of two would wait for one another's cores
        "OPENBLAS_NUM_THREADS": os.environ.get("OPENBLAS_NUM_THREADS", "1"),
        # hundreds of lines about another version's own modules
        **(
            {"PYTEST_ADDOPTS": "--disable-warnings"} if os.environ.get("FREECAD_AM_VERSION") else {}
        ),
    }


def counts(text: str) -> dict[str, int]:
    """Passed, failed and skipped of the last summary line, of pytest or of this runner; where pytest was asked to leave that
    away (-q), of the signs it wrote, if they are all there."""
    found = {"passed": 0, "failed": 0, "skipped": 0}
    summaries = re.findall(
        r"^total: .*|^.*\d+ (?:passed|failed|error|skipped).* in [\d.]+s.*", text, re.MULTILINE
    )
    signs = re.findall(r"^([.FEsxX]+) +\[ *(\d+)%\]$", text, re.MULTILINE)
    if not summaries and signs and signs[-1][1] == "100":
        written = "".join(line for line, _ in signs)
        for sign, word in SIGNS.items():
            found[word] += written.count(sign)
    for number, word in re.findall(
        r"(\d+) (passed|failed|errors?|skipped)", summaries[-1] if summaries else ""
    ):
        found["failed" if word.startswith("error") else word] += int(number)
    return found


def apart(arguments: list[str]) -> tuple[list[str] | None, list[str] | None]:
    """pytest's arguments for the headless run and for that of the window; None for nothing to run there."""
    paths = named(arguments)
    options = [word for word in arguments if word not in paths]
    places = {word: (ROOT / word.partition("::")[0]).resolve() for word in paths}
    inside = [word for word, place in places.items() if place.is_relative_to(GUI)]
    around = [word for word, place in places.items() if GUI.is_relative_to(place)]
    headless = [word for word in paths if word not in inside]
    window = inside or (["tests/gui"] if around or not paths else [])
    return (
        [*options, *headless, "--ignore=tests/gui"] if headless or not paths else None,
        [*options, *window] if window else None,
    )


def run_headless(arguments: list[str]) -> tuple[int, str]:
    """The tests that need no window, in the Python that runs this."""
    if os.environ.get("FREECAD_AM_VERSION"):
        arguments = [*arguments, f"--ignore={NOT_OF_VERSION}"]
    say("freecad-am: plain and headless tests")
    long = LONG in arguments or any("::" in word and not word.startswith("-") for word in arguments)
    limit = LONG_TIMEOUT if long else HEADLESS_TIMEOUT
    stopped = ["timeout", "-k", "5", str(limit)] if shutil.which("timeout") else []
    with tempfile.TemporaryDirectory() as folder:
        command = ["nice", "-n", str(BEHIND), *stopped, sys.executable, "-m", "pytest", *arguments]
        status, text = watched(command, private_home(Path(folder)))
    if status == TOO_LONG:
        say(f"freecad-am: the tests were stopped after {limit} s")
    return status, text


def named(arguments: list[str]) -> list[str]:
    """The folders, files and tests among pytest's arguments."""
    return [word for word in arguments if (ROOT / word.partition("::")[0]).exists()]


def cut(parts: Sequence[Sequence[str]], top: str) -> list[tuple[str, list[str]]]:
    """Names of parts and the arguments of each: what is named, but for what another part names, and last all the rest below
    the folder `top`."""
    named_of = [[f"{top}/{name}" for name in names] for names in parts]
    every = [place for places in named_of for place in places]
    made = []
    for places in [*named_of, [top]]:
        left = [
            place
            for place in every
            if place not in places and any(place.startswith(f"{one}/") for one in places)
        ]
        name = (
            places[0].rpartition("/")[2].removeprefix("test_").removesuffix(".py")
            if places != [top]
            else "rest"
        )
        made.append((name, [*places, *(f"--ignore={place}" for place in left)]))
    return made


def headless_parts(arguments: list[str]) -> list[Part]:
    """The headless tests, in several parts where no folder or file of theirs is asked for."""
    paths = named(arguments)
    if not os.environ.get("FREECAD_AM_VERSION") and (
        not paths or any("posts" in word for word in paths)
    ):
        sys.path.insert(0, str(ROOT))
        from tests.posts import interpreters

        interpreters.provide()
    if paths:
        return [Part("headless", lambda: run_headless(arguments))]
    return [
        Part(name, partial(run_headless, [*arguments, *places]), LEFT if number < BESIDE else USUAL)
        for number, (name, places) in enumerate(cut(FOLDERS, "tests"))
    ]


def window_parts(arguments: list[str]) -> list[Part]:
    """The tests of the window, in several FreeCADs where none of their files is asked for."""
    if named(arguments) != ["tests/gui"]:
        return [Part("window", partial(run_window_tests, arguments), WAITING)]
    options = [word for word in arguments if word != "tests/gui"]
    parts = cut(WINDOWS, "tests/gui")
    return [
        Part(f"window {name}", partial(run_window_tests, [*options, *places]), WAITING)
        for name, places in parts
    ]


def run_window_tests(arguments: list[str]) -> tuple[int, str]:
    """The tests of tests/gui in FreeCAD's main window.

    On a machine that is busy with something else a click or key of theirs may come too early. So a few that failed are
    run once more, in a new FreeCAD, and both times are told. A crash is a failure whatever comes after it.
    """
    say("freecad-am: tests of the window, under Xvfb")
    freecad = shutil.which("freecad") or shutil.which("FreeCAD")
    if not freecad or not shutil.which("xvfb-run"):
        say("freecad-am: no freecad or no xvfb-run: the tests of the window are NOT run")
        return 1, ""
    status, text, failed = in_window(freecad, arguments)
    # FreeCAD leaves a crash with the status of failed tests, but without pytest's summary
    ended = status == FAILED and counts(text)["failed"] > 0
    chosen = any(
        word.startswith("-") and word != LONG and not word.startswith(LEFT_OUT)
        for word in arguments
    )
    if not ended or len(failed) > FEW or chosen:
        return status, text
    say(f"freecad-am: {len(failed)} failed and run once more: {' '.join(failed)}")
    again, second, left = in_window(freecad, failed)
    first, passed = counts(text), counts(second)["passed"]
    told = (
        f"total: {first['passed'] + passed} passed, {len(failed) - passed} failed, {first['skipped']} skipped; "
        f"{passed} of them at the second try: {' '.join(failed)}"
    )
    say(told.replace("total", "freecad-am: window", 1))
    why = {**dict.fromkeys(left if passed else failed, ()), **failures(second)}
    return again or (FAILED if passed < len(failed) else 0), f"{told_of(why)}{told}\n"


def in_window(freecad: str, arguments: list[str]) -> tuple[int, str, list[str]]:
    """Status, output, and the tests that failed."""
    with tempfile.TemporaryDirectory() as folder:
        env = private_home(Path(folder))
        noted, last = Path(folder) / "failed", Path(folder) / "last"
        env["PYTEST_ARGUMENTS"] = shlex.join(arguments)
        env["FAILED_TESTS"], env["LAST_TEST"] = str(noted), str(last)
        env.pop("VIRTUAL_ENV", None)
        # with a folder of its own it would end with a status of its own where it cannot remove that
        screen = ["xvfb-run", "-a", "-f", str(Path(folder) / "Xauthority"), "-s", SCREEN]
        window = [*screen, "timeout", "-k", "5", str(WINDOW_TIMEOUT)]
        status, text = watched([*window, freecad, str(ROOT / "tests" / "gui_runner.py")], env)
        failed = (
            list(dict.fromkeys(noted.read_text(encoding="utf-8").splitlines()))
            if noted.exists()
            else []
        )
        if status and not any(counts(text).values()):
            at = last.read_text(encoding="utf-8") if last.exists() else "the beginning"
            why = (
                f"was stopped after {WINDOW_TIMEOUT} s"
                if status == TOO_LONG
                else f"ended with status {status}"
            )
            say(f"freecad-am: FreeCAD {why} at {at}")
            # those that failed before are in no summary of pytest's
            text += f"\n{told_of({**dict.fromkeys(failed, ()), at: [f'FreeCAD {why} here']})}"
        return status, text, failed


def run_in_version(version: str, arguments: Sequence[str]) -> tuple[int, str]:
    """Tests in another version of FreeCAD; status 0 where this machine cannot run them, which is told."""
    say(f"freecad-am: tests in FreeCAD {version}")
    status, text = watched(
        [str(ROOT / "tests" / "versions" / "run.sh"), version, *arguments], dict(os.environ)
    )
    # its runner sums up after its times, and the tests that passed at their second try failed before
    return (0 if status == UNABLE else status), text.rpartition(TIMES)[2]


def provide_version(version: str) -> None:
    """Make the system with that FreeCAD, beside the first tests: it takes minutes, and waits for the network mostly."""
    command = [str(ROOT / "tests" / "versions" / "run.sh"), version, "--make"]
    threading.Thread(
        target=lambda: subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, check=False
        ),
        daemon=True,
    ).start()


def all_parts(arguments: list[str]) -> list[Part]:
    """What is to be run, in the order in which the parts begin: windows first, as they wait most and need something beside
    them that does not, and the shortest last."""
    in_version = []
    if arguments[:1] == ["--with-freecad"] and len(arguments) > 1:
        version, arguments = arguments[1], arguments[2:]
        provide_version(version)
        options = [word for word in arguments if word == LONG]
        without = (*HEADLESS_OF_VERSION, *(() if options else LONG_IN_VERSION))
        in_version = [
            Part(f"{version} {name}", partial(run_in_version, version, [*options, *places]), load)
            for name, places, load in (
                ("headless", without, USUAL),
                ("window", WINDOW_OF_VERSION, WAITING),
            )
        ]
    headless, window = apart(arguments)
    windows = [] if window is None else window_parts(window)
    others = [] if headless is None else headless_parts(headless)
    return [
        *windows,
        *others[:BESIDE],
        *in_version,
        *others[len(FOLDERS) :],
        *others[BESIDE : len(FOLDERS)],
    ]


def compile_modules() -> None:
    """Once for all processes of the tests, several hundred, each of which would do it again: they write none. A file that
    is changed is noticed by what it holds."""
    words = ["-m", "compileall", "-q", "--invalidation-mode", "checked-hash", "freecad_am"]
    subprocess.run([sys.executable, *words], cwd=ROOT, capture_output=True, check=False)


def main() -> int:
    compile_modules()
    parts = all_parts(sys.argv[1:])
    began = time.monotonic()
    with tempfile.NamedTemporaryFile(prefix="freecad-am-times-") as times:
        os.environ["TEST_TIMES"] = os.environ.get("TEST_TIMES", times.name)
        run_parts(parts)
        written = Path(os.environ["TEST_TIMES"])
        tests = written.read_text(encoding="utf-8") if written.exists() else ""
    tell_times(parts, time.monotonic() - began, tests)
    total = [counts(part.text) for part in parts]
    summed = {word: sum(part[word] for part in total) for word in ("passed", "failed", "skipped")}
    silent = sum(
        part.status not in (0, NO_TESTS) and not told["failed"] for part, told in zip(parts, total)
    )
    failed = summed["failed"] + silent
    tell_failures(parts, (0, NO_TESTS))
    print(
        f"total: {summed['passed']} passed, {failed} failed, {summed['skipped']} skipped",
        flush=True,
    )
    return 0 if failed == 0 and summed["passed"] else 1


if __name__ == "__main__":
    sys.exit(main())
