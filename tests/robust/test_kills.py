# SPDX-License-Identifier: LGPL-2.1-or-later
"""Killed at any moment over earlier outputs: each file whole, the set of one run, and no litter after the next run.

Every run has another travel speed, which each of its files tells.
"""

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
from tests.batch.conftest import COMMANDS, ended, used_by

KINDS = ("plan", "plan", "export", "batch")
TICK = 0.01  # s, in which the system counts what of the processor was used
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
    with outputs.Outputs(str(folder), session) as made:
        for name, data in content.items():
            made.write(name, data)
        made.publish(outputs.earlier_outputs(made.folder))


def in_child(work):
    """The status of a process that does the work."""
    pid = os.fork()
    if not pid:
        try:
            work()
            os._exit(0)
        except BaseException:
            os._exit(99)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def dying(monkeypatch, step, what):
    """Patches what changes folders so that `what` is done before the call number `step`."""
    calls = []

    def counted(real):
        def called(*given, **more):
            calls.append(given)
            if len(calls) == step:
                what()
            return real(*given, **more)

        return called

    for name in ("replace", "remove", "unlink", "rmdir", "makedirs", "mkdir"):
        monkeypatch.setattr(os, name, counted(getattr(os, name)))


@pytest.mark.parametrize("before", [OLD, {}], ids=["over an earlier set", "first"])
def test_killed_at_any_step_the_next_run_finds_one_set(monkeypatch, tmp_path, before):
    seen = set()
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
        with outputs.Outputs(str(out)):  # the next run, which comes to nothing
            pass
        found = files(out)
        assert found.pop("notes.txt") == b"mine"
        assert found in (before, NEW), (step, found)
        assert not list(out.glob(".*"))
        seen.add(found == NEW)
        if status == 0:
            break
        assert status == 9
    else:
        pytest.fail("the steps did not end")
    assert step > 8 and seen == {True, False}


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_asked_to_end_while_files_are_moved_it_ends_with_all_of_them(monkeypatch, tmp_path, number):
    for step in range(1, 60):
        out = tmp_path / str(step)
        publish(out, OLD)
        told = tmp_path / f"told {step}"

        def work(out=out, step=step, told=told):
            session = console.Session()
            signal.signal(number, session._interrupt)
            dying(monkeypatch, step, lambda: os.kill(os.getpid(), number))
            try:
                publish(out, NEW, session)
            except KeyboardInterrupt:
                told.write_text(session.outcome)
                os._exit(130)

        status = in_child(work)
        found = files(out)
        assert found in (OLD, NEW) and not list(out.glob(".*")), (step, found)
        if status == 0:
            break
        assert status == 130
        assert told.read_text() == (
            "nothing was written" if found == OLD else "the outputs were already complete"
        )
    assert found == NEW and step > 8


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

    first = outputs.Outputs(str(tmp_path), Told())
    assert not lines
    for name, data in OLD.items():
        first.write(name, data)
    publish(tmp_path, NEW, Told())
    assert len(lines) == 1 and lines[0].startswith("note[BUSY]") and "-o" in lines[0]
    assert {name for name in files(tmp_path) if not name.startswith(".")} == set(NEW)
    with first:
        first.publish(outputs.earlier_outputs(first.folder))
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
        """Exit status, negative for a signal, and s of the processor."""
        return ended(self.process), used_by_ended() - self.before


class Copied:
    """The same in a copy of a process that has all modules: none of the kills comes while these are imported, which writes
    nothing."""

    def __init__(self, shop, words):
        self.pid = COMMANDS.start(shop.folder, words)

    def at_work(self):
        return COMMANDS.at_work()

    def waited(self):
        return COMMANDS.waited()


def used_by_ended():
    """s of the processor of the processes that were started here and ended."""
    return sum(os.times()[2:4])


class Bench:
    """Runs commands over earlier outputs, kills them and looks at what is left."""

    def __init__(self, workshop, seed, start):
        self.shop, self.random, self.speed, self.begun = workshop, random.Random(seed), 4.0, start
        self.took, self.finished = {}, 0
        for kind in dict.fromkeys(KINDS):
            status, self.took[kind] = self.start(kind).waited()
            assert status == 0

    def start(self, kind):
        """A command of a speed that none before had."""
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
        """The document that is exported, of the speed at hand."""
        path = self.shop.folder / "saved.FCStd"
        document = (
            FreeCAD.openDocument(str(path)) if path.exists() else FreeCAD.newDocument("Saved")
        )
        try:
            if path.exists():
                api.stages_of(document, "toolpath")[0].TravelSpeed = f"{self.speed} mm/s"
                document.save()
                return
            part = api.open_part(document, str(self.shop.folder / "cup.step"))
            cell = api.make_cell(document, limits="paper", platform_diameter=100)
            feature = api.make_feature(document, part, layer_height=8, chord_error=0.1)
            toolpath = api.make_toolpath(document, feature, cell, travel_speed=f"{self.speed} mm/s")
            api.make_program(document, api.make_joint_path(document, toolpath, cell), name="cup")
            document.saveAs(str(path))
        finally:
            FreeCAD.closeDocument(document.Name)

    def kill(self, kind):
        """Start a command and kill it at some moment: the moment, as a share of what it takes of the processor, which a busy
        machine leaves as it is, and the signal."""
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
                        speed(name, data)  # each is whole
                with outputs.Outputs(
                    str(folder)
                ):  # and the next run, whatever comes of it, finishes that first
                    pass
                self.finished += 1
            found = {
                name: data
                for name, data in files(folder).items()
                if not name.startswith(".unfinished")
            }
            speeds = {name: speed(name, data) for name, data in found.items()}
            assert len(set(speeds.values()) - {None}) <= 1, speeds
            if found and folder.name != "export":
                programs = json.loads(found["report.json"])["programs"]
                assert set(found) == {
                    "cup.FCStd",
                    "report.json",
                    "report.html",
                    "waypoints.csv",
                    *programs,
                }
            called = re.findall(rb"CALL (CUP\d+)", found.get("program/CUP.LS", b""))
            parts = {name for name in found if re.fullmatch(r"program/CUP\d+\.LS", name)}
            assert {f"program/{name.decode()}.LS" for name in called} == parts

    def assert_no_litter(self):
        kept = (".cache", row_table.NAME)  # what `batch --resume` goes by is an output
        assert not [path for path in self.shop.folder.rglob(".*") if path.name not in kept]


def speed(name, data):
    """The travel speed that a file tells, None where it tells none; fails where the file is not whole."""
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
    found = re.search(rb"Travel speed ([\d.]+) mm/s", data)
    return float(found[1]) if found else None


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
                for other in dict.fromkeys(KINDS):
                    assert bench.start(other).waited()[0] == 0, other
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
