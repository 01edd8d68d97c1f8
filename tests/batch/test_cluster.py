# SPDX-License-Identifier: LGPL-2.1-or-later
"""`batch --scheduler` plans rows with the workers of a Dask cluster."""

import contextlib
import csv
import importlib.util
import io
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import types
import zipfile
from pathlib import Path

import Mesh
import Part
import pytest

from freecad_am.batch import freecad_am_row_worker, row_table, rows, versions
from freecad_am.core.issues import InputError

dask = pytest.mark.skipif(
    importlib.util.find_spec("distributed") is None,
    reason="needs Dask: apt install python3-distributed",
)
HEIGHTS = (13, 15, 18, 20)
WRITTEN = (
    "CreationDate",
    "LastModifiedDate",
    "Uid",
)  # entries of a document that differ each time it is saved


class Cluster:
    """Two workers with a folder of their own."""

    def __init__(self, *words):
        self.folder = Path(
            tempfile.mkdtemp(prefix="cluster-")
        )  # not in a folder of pytest, which is closed to other users
        self.folder.chmod(0o777)
        self.process = subprocess.Popen(
            [
                sys.executable,
                str(Path(__file__).with_name("local_cluster.py")),
                str(self.folder),
                *words,
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
            env={**os.environ, "HOME": str(self.folder), "FREECAD_USER_HOME": str(self.folder)},
        )
        self.address = json.loads(self.process.stdout.readline())

    def workers(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def end(self):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()


@pytest.fixture(scope="module")
def cluster():
    two_workers = Cluster()
    yield two_workers
    two_workers.end()


def start_batch(workshop, *words):
    return subprocess.Popen(
        [str(workshop.launcher), "batch", "rows.csv", "--job", "cup.yaml", *words],
        cwd=workshop.folder,
        text=True,
        env=workshop.environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


def done_rows(folder):
    """Return the folders of finished rows."""
    return sorted(path.parent for path in folder.glob("row-*/report.json"))


def wait_for(folder, count, process, patience=300):
    until = time.monotonic() + patience
    while len(done_rows(folder)) < count:
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < until
        time.sleep(0.02)


def nothing_left(cluster):
    """Return whether the workers have no batch folder after some time; a row of a lost worker may
    still run."""
    until = time.monotonic() + 60
    while (remaining := list(cluster.folder.rglob("freecad-am-*"))) and time.monotonic() < until:
        time.sleep(0.1)
    assert not remaining
    return True


def comparable(content, name):
    """Return an output file without times and dates, which differ between runs of the same job."""
    if name.endswith("report.json"):
        report = json.loads(content)
        assert report.pop("timing_s")
        return re.sub(r'"[a-z_]*time_s": [0-9.e-]+', "", json.dumps(report))
    if name.endswith(".FCStd"):
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = {entry: archive.read(entry) for entry in archive.namelist()}
        text = entries.pop("Document.xml").decode()
        for key in WRITTEN:
            text, count = re.subn(
                rf'(<Property name="{key}"[^>]*>\s*<\w+ value=")[^"]*', r"\1", text
            )
            assert count == 1, key
        text = re.sub(r'(<Object type=[^>]* id=")\d+', r"\1", text)
        text = re.sub(r'(<Property name="Seconds"[^>]*>\s*<Float value=")[^"]*', r"\1", text)
        return {**entries, "Document.xml": text.splitlines()}
    if name.endswith("report.html"):
        return re.sub(rb"<td>[0-9]+\.[0-9]{3} s</td>", b"", content)
    return content


def same(outputs, expected):
    """Return whether two sets of outputs are of the same job."""
    assert set(outputs) == set(expected)
    for name in outputs:
        assert comparable(outputs[name], name) == comparable(expected[name], name), name
    return True


def write_rows(workshop, heights=HEIGHTS):
    (workshop.folder / "rows.csv").write_text(
        "strategy.layer_height\n" + "".join(f"{h} mm\n" for h in heights)
    )


@dask
@pytest.mark.parametrize(
    "heights",
    [HEIGHTS, pytest.param([10 + k / 20 for k in range(200)], marks=pytest.mark.long)],
    ids=["a few rows", "200 rows"],
)
def test_same_bytes_as_without_and_a_lost_worker_loses_nothing(workshop, cluster, heights):
    """The workers cannot read the files: they run as another user, and the folder is closed."""
    write_rows(workshop, heights)
    workshop.folder.chmod(0o700)
    workers_ = cluster.workers()
    process = start_batch(workshop, "--scheduler", cluster.address, "-o", "there")
    wait_for(workshop.folder / "there", 1, process)
    os.kill(workers_[0], signal.SIGKILL)
    out, err = process.communicate(timeout=1800)
    assert process.returncode == 0, err
    assert [row["exit"] for row in csv.DictReader(io.StringIO(out))] == ["0"] * len(heights)
    assert set(cluster.workers()) != set(workers_)
    assert (
        len(
            re.findall(
                r"^note\[WORKER\] tcp://\S+: FreeCAD [\d.]+, OpenCASCADE [\d.]+, ", err, re.M
            )
        )
        >= 2
    )
    assert "VERSIONS" not in err
    local_batch = start_batch(workshop, "-o", "here", "-j", "2")
    # many rows take longer than the timeout of `run`
    assert local_batch.communicate(timeout=1800)[0] == out
    for row in done_rows(workshop.folder / "here"):
        assert same(workshop.files(f"here/{row.name}"), workshop.files(f"there/{row.name}"))
    assert nothing_left(cluster)


@dask
@pytest.mark.long
def test_interrupted_and_resumed(workshop, cluster):
    write_rows(workshop)
    process = start_batch(workshop, "--scheduler", cluster.address, "-o", "rows")
    top = workshop.folder / "rows"
    wait_for(top, 2, process)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130 and "--resume" in err, err[-1500:]
    finished_times = {row.name: (row / "report.json").stat().st_mtime_ns for row in done_rows(top)}
    assert 2 <= len(finished_times) < len(HEIGHTS)
    assert not list(top.rglob(".unfinished*"))
    assert nothing_left(cluster)
    command = workshop.run(
        "batch", "rows.csv", "--job", "cup.yaml", "-o", "rows", "--resume", "-j", "2"
    )
    assert command.status == 0 and f"{len(finished_times)} of {len(HEIGHTS)} rows" in command.err
    assert len(done_rows(top)) == len(HEIGHTS)
    assert [row["strategy.layer_height"] for row in csv.DictReader(io.StringIO(command.out))] == [
        f"{h} mm" for h in HEIGHTS
    ]
    assert all(
        int(row["layers"]) > 2 and row["exit"] == "0"
        for row in csv.DictReader(io.StringIO(command.out))
    )
    for name, when in finished_times.items():
        assert (top / name / "report.json").stat().st_mtime_ns == when


@dask
def test_a_cluster_of_another_version_or_none(workshop):
    write_rows(workshop)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        nobody = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    for address in (nobody, "no such address", "tcp://nowhere.invalid:8786"):
        command = workshop.run("batch", "rows.csv", "--job", "cup.yaml", "--scheduler", address)
        assert command.status == 2 and command.err.startswith(
            "error[SCHEDULER] --scheduler: no scheduler answers"
        ), command.err
        assert "Traceback" not in command.err
    old_cluster = Cluster("1999.1.0")
    try:
        command = workshop.run(
            "batch", "rows.csv", "--job", "cup.yaml", "--scheduler", old_cluster.address
        )
    finally:
        old_cluster.end()
    assert command.status == 2
    assert re.search(
        r"error\[SCHEDULER\] --scheduler: \S+ scheduler has distributed 1999.1.0, but the command has \d",
        command.err,
    )
    assert not (workshop.folder / "out").exists()


@dask
def test_a_cluster_without_workers_or_with_one_that_cannot_plan(workshop, cluster, monkeypatch):
    from freecad_am.batch import cluster as module

    write_rows(workshop)
    (_, result), session = (
        row_table.read(str(workshop.folder / "rows.csv"), str(workshop.job)),
        Told(),
    )
    assert len(result) == len(HEIGHTS)
    monkeypatch.setattr(module.Cluster, "_workers", lambda self: {})
    with pytest.raises(InputError, match="has no workers; start workers with: dask worker tcp://"):
        module.Cluster(cluster.address, session)
    monkeypatch.undo()
    broken = io.BytesIO()
    with zipfile.ZipFile(broken, "w") as archive:
        archive.writestr("freecad-am", "echo no FreeCAD here >&2; exit 2")
    monkeypatch.setattr(versions, "package", broken.getvalue)
    with pytest.raises(
        InputError, match="the worker cannot plan: no FreeCAD here; install FreeCAD on its machine"
    ):
        module.Cluster(cluster.address, session)
    monkeypatch.undo()
    monkeypatch.setattr(versions, "found_versions", lambda: {"FreeCAD": "9.9.9"})
    with module.Cluster(cluster.address, session):
        pass
    assert sum("note[WORKER]" in line for line in session.lines) == 2
    assert (
        sum(
            bool(re.match(r"warning\[VERSIONS\] tcp://\S+: this machine has FreeCAD 9.9.9", line))
            for line in session.lines
        )
        == 2
    )


class Told:
    """A session that keeps the reported issues."""

    def __init__(self):
        self.lines = []

    def say(self, line):
        self.lines.append(line)


@dask
def test_a_result_that_was_lost_with_its_worker_is_waited_for(monkeypatch):
    """Dask recomputes the result, because its worker may be lost after the row has finished."""
    from freecad_am.batch import cluster as module

    monkeypatch.setattr("distributed.wait", lambda *_, **__: None)
    futures = [
        types.SimpleNamespace(status=status)
        for status in ("pending", "lost", "finished", "error", "cancelled")
    ]
    assert module._first_done(futures) == futures[2:]


@dask
def test_rows_that_begin_after_the_end_leave_nothing(monkeypatch, tmp_path):
    worker = types.SimpleNamespace(local_directory=str(tmp_path), address="here")
    monkeypatch.setattr("distributed.get_worker", lambda: worker)
    freecad_am_row_worker._batch("one")
    assert len(list(tmp_path.iterdir())) == 1
    freecad_am_row_worker.stop("one", worker)
    freecad_am_row_worker.stop("two", worker)  # before any row of it
    for token in ("one", "two"):
        with pytest.raises(RuntimeError, match="the batch has ended"):
            freecad_am_row_worker.plan_row({"files": [], "links": []}, [b""], token, {})
    assert not list(tmp_path.iterdir())


NOWHERE = {"machines": [], "home": "/nowhere"}


def order(row):
    """Return the job of a row as sent to a worker."""
    return {"label": row.label, "values": row.tree().values, "path": row.path, "dry": False}


def test_without_dask_that_is_told(workshop, monkeypatch):
    from freecad_am.batch import cluster as module

    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError) as error:
        module.Cluster("tcp://127.0.0.1:1", Told())
    assert error.value.code == "NO_DASK" and "python3-distributed" in error.value.message
    command = workshop.run("batch", "rows.csv", "--job", "cup.yaml", "--scheduler", "x", "-j", "2")
    assert command.status == 2 and "-j" in command.err


def test_files_travel_with_a_job(workshop, tmp_path):
    """The job gives the same bytes with its whole folder moved away, wherever its files are."""
    home = workshop.folder / "home"
    for name in ("cell", "meshes", "around", "tables"):
        (home / name).mkdir(parents=True)
    Mesh.createBox(9.0, 9.0, 9.0).write(str(home / "around" / "post.stl"))
    machine = json.loads(
        (Path(versions.ROOT) / "freecad_am/machines/fanuc-arcmate120ic.json").read_text()
    )
    machine["id"], machine["shapes"] = "mine", {"base": {"file": "../meshes/base.stl"}}
    (home / "cell" / "mine.json").write_text(json.dumps(machine))
    (home / "meshes" / "base.stl").write_bytes((home / "around" / "post.stl").read_bytes())
    (home / "cell" / "cell.yaml").write_text(
        "machine: ./mine.json\nlimits: paper\nplatform_diameter: 100 mm\nobstacles: [{file: ../around/post.stl, pose: "
        "[3000, 0, 0, 0, 0, 0]}]\n"
    )
    text = workshop.text.replace(
        "cell:\n  limits: paper\n  platform_diameter: 100 mm", "cell: home/cell/cell.yaml"
    )
    workshop.write_job(text.replace("layer_height: 4 mm", "layer_height: 20 mm"))
    write_rows(workshop, (20,))
    assert workshop.run("batch", "rows.csv", "--job", "cup.yaml", "-o", "out").status == 0
    original = workshop.files("out/row-001")
    _, (row,) = row_table.read(str(workshop.folder / "rows.csv"), str(workshop.job))
    named = {
        str(Path(name).relative_to(workshop.folder)) for name in row.files if os.path.isfile(name)
    }
    inside = {"cell/cell.yaml", "cell/mine.json", "around/post.stl", "meshes/base.stl"}
    assert named == {"cup.step", *(f"home/{name}" for name in inside)}
    files = [(name, Path(name).read_bytes()) for name in row.files if os.path.isfile(name)]
    worker_folder = tmp_path.with_name(f"{tmp_path.name}-worker")
    worker_folder.mkdir()
    worker = freecad_am_row_worker.Batch(str(worker_folder))
    workshop.folder.rename(worker_folder / "away")
    try:
        worker.unpack(versions.package(), files, [])
        result = worker.run(NOWHERE, {**order(row), "folder": str(worker_folder / "row")})["result"]
        assert result["exit"] == 0, result
        paths_found = {
            str(path.relative_to(worker_folder / "row")): path.read_bytes()
            for path in (worker_folder / "row").rglob("*")
            if path.is_file()
        }
        assert same(original, paths_found)
        assert b"/nowhere" not in b"".join(paths_found.values()) and str(
            worker_folder
        ).encode() not in b"".join(paths_found.values())
    finally:
        worker.stop()
        (worker_folder / "away").rename(workshop.folder)
    assert not os.path.exists(worker.path)


def test_what_a_lost_worker_leaves_removes_itself(workshop, tmp_path_factory):
    """The process of a row ends when its stdin closes, and removes the folder of the batch."""
    folder = tmp_path_factory.mktemp("worker")
    write_rows(workshop, (20,))
    _, (row,) = row_table.read(str(workshop.folder / "rows.csv"), str(workshop.job))
    worker = freecad_am_row_worker.Batch(str(folder))
    worker.unpack(versions.package(), [], [])
    assert worker.run(NOWHERE, None)["versions"]["FreeCAD"]
    process = worker._start(NOWHERE)
    request = {**order(row), "folder": str(folder / "row")}
    process.stdin.write(json.dumps({"folder": worker.path, "order": request}) + "\n")
    process.stdin.close()
    assert process.wait(60) != 0 and process.stdout.read() == ""
    assert not list(folder.iterdir())


def test_what_has_changed_is_planned_again(workshop):
    """Of finished rows these are planned again: one with other cells, one whose outputs are
    missing, and all if the part differs."""

    def batch(*heights):
        write_rows(workshop, heights)
        command = workshop.run(
            "batch", "rows.csv", "--job", "cup.yaml", "-o", "rows", "--resume", "-j", "2"
        )
        assert command.status == 0, command.err
        kept_count = int(re.search(r"note\[RESUMED\] batch: (\d) of \d rows", command.err)[1])
        layer_counts = [int(row["layers"]) for row in csv.DictReader(io.StringIO(command.out))]
        return kept_count, layer_counts

    workshop.write_job(
        workshop.text.split("cell:")[0]
    )  # rows without a robot take half of the time
    kept_count, layers = batch(20, 25)
    assert kept_count == 0 and layers[0] > layers[1]
    assert batch(20, 25) == (2, layers)
    assert batch(20, 30)[0] == 1
    (workshop.folder / "rows" / "row-001" / "report.json").write_text("{}")
    assert batch(20, 30)[0] == 1
    journal = workshop.folder / "rows" / ".rows.jsonl"
    journal.write_text(
        journal.read_text()[:-20] + "\nnonsense\n[]\n{}\n"
    )  # as after a kill and an editor
    assert batch(20, 30)[0] == 1
    Part.makeSphere(45.0).exportStep(str(workshop.folder / "cup.step"))
    assert batch(20, 30)[0] == 0


def test_a_dry_run_refuses_and_plans_nothing(workshop):
    (workshop.folder / "rows.csv").write_text(
        "strategy.layer_height,program.post,name\n20 mm,,fine\n1 kg,,heavy\n20 mm,siemens,other\n"
    )
    command = workshop.run(
        "batch", "rows.csv", "--job", "cup.yaml", "--dry-run", "-o", "dry", "-j", "2"
    )
    assert command.status == 2
    assert [row["status"] for row in csv.DictReader(io.StringIO(command.out))] == [
        "checked",
        "failed",
        "failed",
    ]
    assert [path.name for path in (workshop.folder / "dry").rglob("*")] == [".rows.jsonl"]


@pytest.mark.parametrize(
    ("done", "now", "seconds", "says"),
    [
        (3, 3, 30.0, "3 of 10 rows done, about 70 s left"),
        (5, 2, 600.0, "5 of 10 rows done, about 25 min left"),
        (1, 1, 3600.0, "1 of 10 rows done, about 9.0 h left"),
        (10, 4, 8.0, "10 of 10 rows done"),
    ],
)
def test_time_left(done, now, seconds, says):
    """Kept rows count as done, but not for the estimate of the pace."""
    assert rows._progress(done, 10, now, seconds) == says


def test_files_of_jobs_are_opened_by_where_they_are():
    """The core never opens or checks a file by its name in the job, because a worker would not find
    it."""
    looks = re.compile(
        r"\.is_file\(|\.exists\(|(?<![\w.])open\(|\.read_text\(|\.read_bytes\(|isfile\(|\.stat\("
    )
    core = Path(versions.ROOT) / "freecad_am" / "core"
    calls = {
        f"{path.relative_to(core)}: {line.strip()}"
        for path in core.rglob("*.py")
        for line in path.read_text(encoding="utf-8").splitlines()
        if looks.search(line) and "locate(" not in line
    }
    assert calls == {
        'geometry/job_files.py: with open(descriptor, "rb") as stream:',  # these open located files
    }
