# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run many jobs as commands and group the faults at their end by signature, with a log from which a
round can continue."""

import csv
import json
import os
import random
import re
import shutil
import unicodedata
from collections import Counter
from pathlib import Path

import numpy as np

from tests.batch.conftest import COMMANDS

# s of the processor and MB, for a job without a warning about its size
SECONDS, MEMORY = 60.0, 2000.0
PATIENCE_SECONDS, PATIENCE_BYTES, PATIENCE = (
    65,
    6 << 30,
    300,
)  # limits that stop any job; the last one is s of sleep
LARGE_JOB = re.compile(r"\[(LARGE|TOO_MANY|TOO_FINE)\]")
CHECKED_POINTS = 60  # deposit points of a job


def seed_of_round():
    """Return ROBUST_SEED, or else a new seed; print it."""
    seed = int(os.environ.get("ROBUST_SEED") or random.SystemRandom().randrange(1 << 30))
    print(f"seed {seed}: ROBUST_SEED={seed} makes the same round")
    return seed


def assert_sound(make, count, seed, folder):
    """Run the jobs that make(number, chance, folder) writes, and fail with the faults by signature.
    make returns the words of the command and a function of points (n, 3) and build directions (n,
    3), or None. The function returns the largest excess over the allowed deviation in mm. With
    ROBUST_LOG, the path of a file, a stopped round continues where it stopped."""
    log = os.environ.get("ROBUST_LOG")
    logged_results = _logged(Path(log), seed) if log else {}
    first_number, count = (
        int(os.environ.get("ROBUST_FIRST") or 0),
        int(os.environ.get("ROBUST_COUNT") or count),
    )
    for number in range(first_number, first_number + count):
        if number in logged_results:
            continue
        logged_results[number] = run(make, number, seed, folder)
        if log:
            with open(log, "a", encoding="utf-8") as stream:
                stream.write(
                    json.dumps({"seed": seed, "number": number, **logged_results[number]}) + "\n"
                )
    rows = [logged_results[number] for number in range(first_number, first_number + count)]
    print(summary(rows))
    wrong = {
        number: row["wrong"]
        for number, row in zip(range(first_number, first_number + count), rows, strict=True)
        if row["wrong"]
    }
    assert not wrong, f"seed {seed}: {wrong}"


def run(make, number, seed, folder):
    """Run one job in a folder of its own, which is removed, and return how it ended and the faults
    of that."""
    job_folder = folder / str(number)
    job_folder.mkdir()
    try:
        words, off = make(number, random.Random(f"{seed} {number}"), job_folder)
        try:
            command = COMMANDS.run(job_folder, words, PATIENCE_SECONDS, PATIENCE_BYTES, PATIENCE)
        except TimeoutError:
            return {"status": None, "seconds": None, "memory": None, "wrong": ["hangs"], "told": ""}
        message_codes = re.findall(r"^(?:error|warning|note)\[[A-Z_]+\]", command.err, re.MULTILINE)
        wrong = faults(command, job_folder)
        points = deposited(job_folder / "out" / "waypoints.csv")
        if off is not None and points is not None and command.status == 0:
            farthest = off(*points)
            if not farthest <= 0.0:
                wrong.append(f"off the part: {farthest:.4g} mm more than it may be")
        return {
            "status": command.status,
            "seconds": command.seconds,
            "memory": command.memory,
            "wrong": wrong,
            "told": " ".join(dict.fromkeys(message_codes)),
            **({"err": command.err[-2000:]} if wrong else {}),
        }
    finally:
        shutil.rmtree(job_folder)


def faults(command, folder):
    """Return the faults at the end of a command. The limits of the round may stop a job that warned
    about its size."""
    if LARGE_JOB.search(command.err) and "error[ENDED]" in command.err:
        return []
    wrong = []
    if command.status not in (0, 2, 3):
        wrong.append(f"status {command.status}")
    for word in ("INTERNAL", "CRASHED", "ENDED", "NO_MEMORY"):
        match = re.search(rf"\[{word}\].*", command.err)
        if match:
            wrong.append(match[0])
    if "Traceback" in command.err:
        wrong.append("Traceback")
    if command.status == 2 and not re.fullmatch(
        r"((note|warning)\[\w+\] .+\n)*error\[[A-Z_]+\] .+\n", command.err
    ):
        wrong.append("status 2 without one line that tells why")
    if any(
        unicodedata.category(sign) in ("Cc", "Cf", "Cs", "Zl", "Zp")
        for sign in command.err.replace("\n", "")
    ):
        wrong.append("control signs in what is told")
    if not LARGE_JOB.search(command.err):
        if command.seconds > SECONDS:
            wrong.append(f"{command.seconds:.0f} s")
        if command.memory > MEMORY:
            wrong.append(f"{command.memory:.0f} MB")
    if list(folder.rglob(".unfinished*")):
        wrong.append("litter")
    out = folder / "out"
    if command.status == 2 and out.exists():
        wrong.append("files of a job that was refused")
    if command.status == 0 and not ((out / "report.json").exists() or (out / "place.csv").exists()):
        wrong.append("no report")
    return wrong


def deposited(path):
    """Return some deposit points (n, 3) in mm of a waypoint file, including ends of many beads, and
    their build directions (n, 3); None without a file."""
    if not path.exists():
        return None
    with path.open(encoding="utf-8", newline="") as stream:
        rows = [
            (
                row["layer"],
                row["bead"],
                *(float(row[name]) for name in ("x_mm", "y_mm", "z_mm", "bx", "by", "bz")),
            )
            for row in csv.DictReader(stream)
            if row["kind"] == "deposit"
        ]
    ends = [
        k for k in range(len(rows)) if k in (0, len(rows) - 1) or rows[k][:2] != rows[k - 1][:2]
    ]
    row_numbers = (
        [ends[k] for k in np.linspace(0, len(ends) - 1, CHECKED_POINTS // 3).astype(int)]
        if rows
        else []
    )
    row_numbers += (
        np.linspace(0, len(rows) - 1, CHECKED_POINTS - len(row_numbers)).astype(int).tolist()
        if rows
        else []
    )
    selected_rows = np.array([rows[k][2:] for k in sorted(set(row_numbers))]).reshape(-1, 6)
    return selected_rows[:, :3], selected_rows[:, 3:]


def summary(rows):
    """Return the figures of a round."""
    timed = [row for row in rows if row["seconds"] is not None]
    seconds, memory = ([row[key] for row in timed] for key in ("seconds", "memory"))
    lines = [
        f"{len(rows)} jobs, status {dict(Counter(row['status'] for row in rows))}, {sum(seconds):.0f} s of the processor, "
        f"at most {max(seconds):.1f} s and {max(memory):.0f} MB",
    ]
    fault_counts = Counter(signature(fault) for row in rows for fault in row["wrong"])
    lines += [f"{count:6d}  {what}" for what, count in fault_counts.most_common()]
    return "\n".join(lines)


def signature(fault):
    """Return a fault without its numbers and names."""
    return re.sub(r"'[^']*'", "'...'", re.sub(r"-?\d[\d.e+-]*", "#", fault))[:160]


def _logged(path, seed):
    if not path.exists():
        return {}
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return {row["number"]: row for row in rows if row["seed"] == seed}
