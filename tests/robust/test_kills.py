# SPDX-License-Identifier: LGPL-2.1-or-later
"""A command killed at any moment over earlier outputs leaves complete files of a single run, and
the next run removes the remains. Every run has another travel speed, which each of its files
states."""

import contextlib
import io
import json
import os
import random
import re
import signal
import subprocess
import time
import zipfile

import FreeCAD
import pytest

from freecad_am import api
from freecad_am.batch import console, row_table, staging
from freecad_am.batch import output_folder as outputs
from freecad_am.core.issues import InputError
from tests.batch.conftest import COMMANDS, used_by, wait_for_end

KINDS = ("plan", "plan", "export", "batch")
TICK = 0.01  # s, the system's resolution of processor time
SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
OLD = {
    "cup.FCStd": b"old",
    "program/CUP.LS": b"old",
    "program/CUP01.LS": b"old",
    "report.html": b"old",
}
NEW = {
    "cup.FCStd": b"new",
    "program/CUP.LS": b"new",
    "report.html": b"new",
    "waypoints.csv": b"new",
}
NEW["report.json"] = json.dumps(
    {"name": "cup", "programs": ["program/CUP.LS"], "issues": []}
).encode()
OLD["report.json"] = json.dumps(
    {"name": "cup", "programs": ["program/CUP.LS", "program/CUP01.LS"], "issues": []}
).encode()


def files(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def publish(folder, content, session=None):
    with outputs.Outputs(str(folder), session) as outputs_:
        for name, data in content.items():
            outputs_.write(name, data)
        outputs_.publish(outputs.earlier_outputs(outputs_.folder))


def in_child(work):
    """Return the status of a process that does the work."""
    pid = os.fork()
    if not pid:
        try:
            work()
            os._exit(0)
        except BaseException:
            os._exit(99)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def dying(monkeypatch, step, what):
    """Patch functions that change folders so that `what` runs before call number `step`."""
    calls = []

    def counted(real):
        def called(*arguments, **options):
            calls.append(arguments)
            if len(calls) == step:
                what()
            return real(*arguments, **options)

        return called

    for name in ("replace", "remove", "unlink", "rmdir", "makedirs", "mkdir"):
        monkeypatch.setattr(os, name, counted(getattr(os, name)))


@pytest.mark.parametrize("before", [OLD, {}], ids=["over an earlier set", "first"])
def test_killed_at_any_step_the_next_run_finds_one_set(monkeypatch, tmp_path, before):
    outcomes = set()
    for step in range(1, 60):
        out = tmp_path / str(step)
        out.mkdir()
        (out / "notes.txt").write_text("mine")
        if before:
            publish(out, before)

        def work(out=out, step=step):
            dying(monkeypatch, step, lambda: os._exit(9))
            publish(out, NEW)

        status = in_child(work)
        for name, data in files(out).items():
            assert name.startswith(".unfinished") or data in (
                before.get(name),
                NEW.get(name),
                b"mine",
            )
        with outputs.Outputs(str(out)):  # the next run, which does nothing
            pass
        output_files = files(out)
        assert output_files.pop("notes.txt") == b"mine"
        assert output_files in (before, NEW), (step, output_files)
        assert not list(out.glob(".*"))
        outcomes.add(output_files == NEW)
        if status == 0:
            break
        assert status == 9
    else:
        pytest.fail("the steps did not end")
    assert step > 8 and outcomes == {True, False}


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_asked_to_end_while_files_are_moved_it_ends_with_all_of_them(monkeypatch, tmp_path, number):
    for step in range(1, 60):
        out = tmp_path / str(step)
        publish(out, OLD)
        signal_file = tmp_path / f"told {step}"

        def work(out=out, step=step, signal_file=signal_file):
            session = console.Session()
            signal.signal(number, session._interrupt)
            dying(monkeypatch, step, lambda: os.kill(os.getpid(), number))
            try:
                publish(out, NEW, session)
            except KeyboardInterrupt:
                signal_file.write_text(session.outcome)
                os._exit(130)

        status = in_child(work)
        output_files = files(out)
        assert output_files in (OLD, NEW) and not list(out.glob(".*")), (step, output_files)
        if status == 0:
            break
        assert status == 130
        assert signal_file.read_text() == (
            "nothing was written" if output_files == OLD else "the outputs were already complete"
        )
    assert output_files == NEW and step > 8


def test_what_cannot_be_moved_leaves_the_earlier_set(tmp_path, monkeypatch):
    publish(tmp_path, OLD)
    real = os.access
    monkeypatch.setattr(
        os, "access", lambda path, mode: not str(path).endswith("program") and real(path, mode)
    )
    with pytest.raises(InputError, match=r"closed.*-o"):
        publish(tmp_path, NEW)
    assert files(tmp_path) == OLD


def test_two_runs_in_one_folder_are_told_and_leave_one_set(tmp_path):
    lines = []

    class Told(console.Session):
        def say(self, line):
            lines.append(line)

    first_run = outputs.Outputs(str(tmp_path), Told())
    assert not lines
    for name, data in OLD.items():
        first_run.write(name, data)
    publish(tmp_path, NEW, Told())
    assert len(lines) == 1 and lines[0].startswith("note[BUSY]") and "-o" in lines[0]
    assert {name for name in files(tmp_path) if not name.startswith(".")} == set(NEW)
    with first_run:
        first_run.publish(outputs.earlier_outputs(first_run.folder))
    assert files(tmp_path) == OLD


# whole commands ------------------------------------------------------------------------------------------------------


class Launched:
    """A command as its users start it."""

    def __init__(self, shop, words):
        self.before = used_by_ended()
        self.process = subprocess.Popen(
            [str(shop.launcher), *words],
            cwd=shop.folder,
            env=shop.environment(),
            start_new_session=True,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.pid = self.process.pid

    def at_work(self):
        return self.process.poll() is None

    def waited(self):
        """Return exit status, negative for a signal, and processor time in s."""
        return wait_for_end(self.process), used_by_ended() - self.before


class Copied:
    """The same in a copy of a process that has all modules, so that no kill happens during imports,
    which write nothing."""

    def __init__(self, shop, words):
        self.pid = COMMANDS.start(shop.folder, words)

    def at_work(self):
        return COMMANDS.at_work()

    def waited(self):
        return COMMANDS.waited()


def used_by_ended():
    """Return the processor time in s of the ended child processes."""
    return sum(os.times()[2:4])


class Bench:
    """Run commands over earlier outputs, kill them and check the remaining files."""

    def __init__(self, workshop, seed, start):
        self.shop, self.random, self.speed, self.begun = workshop, random.Random(seed), 4.0, start
        self.took, self.finished = {}, 0
        for kind in dict.fromkeys(KINDS):
            status, self.took[kind] = self.start(kind).waited()
            assert status == 0

    def start(self, kind):
        """Start a command with a new speed."""
        self.speed = round(self.speed + 0.01, 2)
        self.shop.write_job(
            self.shop.text.replace("layer_height: 4 mm", "layer_height: 8 mm")
            .replace("6 mm/s", f"{self.speed} mm/s")
            .replace(
                "post: fanuc", "post: fanuc\n  max_points: " + self.random.choice(["2000", "100"])
            ),
        )
        if kind == "plan":
            words = ["plan", "cup.yaml", "-o", "plan"]
        elif kind == "batch":
            (self.shop.folder / "rows.csv").write_text("strategy.layer_height\n8 mm\n9 mm\n")
            words = ["batch", "rows.csv", "--job", "cup.yaml", "-o", "batch", "-j", "2"]
        else:
            self.save()
            words = ["export", "saved.FCStd", "-o", "export"]
        return self.begun(self.shop, words)

    def save(self):
        """Save the document for the export, with the current speed."""
        path = self.shop.folder / "saved.FCStd"
        document = (
            FreeCAD.openDocument(str(path)) if path.exists() else FreeCAD.newDocument("Saved")
        )
        try:
            if path.exists():
                api.stages_of(document, "toolpath")[0].TravelSpeed = f"{self.speed} mm/s"
                document.save()
                return
            imported_part = api.open_part(document, str(self.shop.folder / "cup.step"))
            cell = api.make_cell(document, limits="paper", platform_diameter=100)
            feature = api.make_feature(document, imported_part, layer_height=8, chord_error=0.1)
            toolpath = api.make_toolpath(document, feature, cell, travel_speed=f"{self.speed} mm/s")
            api.make_program(document, api.make_joint_path(document, toolpath, cell), name="cup")
            document.saveAs(str(path))
        finally:
            FreeCAD.closeDocument(document.Name)

    def kill(self, kind):
        """Start a command and kill it at a random moment. Return the moment, as a share of its
        processor time, which does not depend on the load of the machine, and the signal."""
        process, number = self.start(kind), self.random.choice(SIGNALS)
        share = self.random.uniform(0.1, 1.02)
        while process.at_work() and used_by(process.pid)[0] < share * self.took[kind]:
            time.sleep(TICK)
        time.sleep(self.random.uniform(0.0, TICK))
        with contextlib.suppress(ProcessLookupError):
            (os.killpg if number == signal.SIGKILL or kind == "batch" else os.kill)(
                process.pid, number
            )
        process.waited()
        return f"{share:.3f} {signal.Signals(number).name}"

    def folders(self):
        top = self.shop.folder
        return [
            folder
            for folder in (top / "plan", top / "export", *sorted((top / "batch").glob("*")))
            if folder.is_dir()
        ]

    def assert_one_set(self):
        for folder in self.folders():
            if list(
                folder.glob(f"{staging.PREFIX}*/{staging.NOTE}")
            ):  # killed in the milliseconds in which files are moved
                for name, data in files(folder).items():
                    if not name.startswith(staging.PREFIX):
                        speed(name, data)  # each is complete
                with outputs.Outputs(
                    str(folder)
                ):  # and the next run finishes that first, whatever its own result
                    pass
                self.finished += 1
            file_speeds = {
                name: data
                for name, data in files(folder).items()
                if not name.startswith(".unfinished")
            }
            speeds = {name: speed(name, data) for name, data in file_speeds.items()}
            assert len(set(speeds.values()) - {None}) <= 1, speeds
            if file_speeds and folder.name != "export":
                programs = json.loads(file_speeds["report.json"])["programs"]
                assert set(file_speeds) == {
                    "cup.FCStd",
                    "report.json",
                    "report.html",
                    "waypoints.csv",
                    *programs,
                }
            called = re.findall(rb"CALL (CUP\d+)", file_speeds.get("program/CUP.LS", b""))
            part_files = {name for name in file_speeds if re.fullmatch(r"program/CUP\d+\.LS", name)}
            assert {f"program/{name.decode()}.LS" for name in called} == part_files

    def assert_no_litter(self):
        allowed = (".cache", row_table.NAME)  # the table that `batch --resume` reads is an output
        assert not [path for path in self.shop.folder.rglob(".*") if path.name not in allowed]


def speed(name, data):
    """Return the travel speed that a file states, None if it states none; fail if the file is
    incomplete."""
    if name.endswith(".json"):
        return float(json.loads(data)["process"]["travel_speed_mm_s"])
    if name.endswith(".html"):
        assert data.rstrip().endswith(b"</html>")
        return None
    if name.endswith(".csv"):
        lines = data.decode().splitlines()
        rows = [dict(zip(lines[0].split(","), line.split(","), strict=True)) for line in lines[1:]]
        return round(
            float(next(row["speed_mm_s"] for row in reversed(rows) if row["kind"] == "deposit")), 2
        )
    if name.endswith(".FCStd"):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            assert archive.testzip() is None
            text = archive.read("Document.xml").decode()
        return round(
            float(
                re.search(
                    r'<Property name="TravelSpeed".*?<Float value="([^"]*)"', text, re.DOTALL
                )[1]
            ),
            2,
        )
    assert data.rstrip().endswith(b"/END")
    match = re.search(rb"Travel speed ([\d.]+) mm/s", data)
    return float(match[1]) if match else None


def assert_survives(workshop, seed, kills, whole_every, start):
    bench = Bench(workshop, seed, start)
    bench.assert_one_set()
    for number in range(kills):
        kind = KINDS[number % len(KINDS)]
        moment = bench.kill(kind)
        print(f"kill {number} of {kind}, {moment}", flush=True)
        try:
            bench.assert_one_set()
            if number % whole_every == whole_every - 1:
                for kind_ in dict.fromkeys(KINDS):
                    assert bench.start(kind_).waited()[0] == 0, kind_
                bench.assert_one_set()
                bench.assert_no_litter()
        except AssertionError as error:
            raise AssertionError(
                f"seed {seed}, kill {number} of {kind}, {moment}: {error}"
            ) from error
    print(f"{kills} kills, {bench.finished} of them while files were moved")


def test_a_dozen_kills(workshop):
    assert_survives(workshop, seed=1, kills=12, whole_every=12, start=Copied)


@pytest.mark.long
def test_three_hundred_kills(workshop):
    seed = int(os.environ.get("ROBUST_SEED") or random.SystemRandom().randrange(1 << 30))
    print(f"seed {seed}: ROBUST_SEED={seed} runs the same kills")
    assert_survives(workshop, seed, kills=300, whole_every=20, start=Launched)
