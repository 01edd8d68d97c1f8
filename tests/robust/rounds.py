# SPDX-License-Identifier: LGPL-2.1-or-later
"""Many jobs, each run as a command, and what is wrong with how they end: by signature, with a log to go on from."""

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

SECONDS, MEMORY = 60.0, 2000.0  # s of the processor, MB, of a job that was not told to be large
PATIENCE_SECONDS, PATIENCE_BYTES, PATIENCE = (
    65,
    6 << 30,
    300,
)  # where they are stopped in any case; the last one s of sleep
LARGE = re.compile(r"\[(LARGE|TOO_MANY|TOO_FINE)\]")
LOOKED_AT = 60  # deposit points of a job


def seed_of_round():
    """ROBUST_SEED, else a fresh one; printed."""
    seed = int(os.environ.get("ROBUST_SEED") or random.SystemRandom().randrange(1 << 30))
    print(f"seed {seed}: ROBUST_SEED={seed} makes the same round")
    return seed


def assert_sound(make, count, seed, folder):
    """Run the jobs that make(number, chance, folder) writes and fail with what was wrong, by signature.

    make: gives the words of the command and a function of points (n, 3) and build directions (n, 3) that tells how far, mm,
    the farthest is off what it may be, or None. With ROBUST_LOG, the path of a file, a round that was stopped goes on
    where it was; ROBUST_FIRST and ROBUST_COUNT choose some of its jobs.
    """
    log = os.environ.get("ROBUST_LOG")
    known = _logged(Path(log), seed) if log else {}
    first, count = (
        int(os.environ.get("ROBUST_FIRST") or 0),
        int(os.environ.get("ROBUST_COUNT") or count),
    )
    for number in range(first, first + count):
        if number in known:
            continue
        known[number] = run(make, number, seed, folder)
        if log:
            with open(log, "a", encoding="utf-8") as stream:
                stream.write(json.dumps({"seed": seed, "number": number, **known[number]}) + "\n")
    rows = [known[number] for number in range(first, first + count)]
    print(summary(rows))
    wrong = {
        number: row["wrong"]
        for number, row in zip(range(first, first + count), rows, strict=True)
        if row["wrong"]
    }
    assert not wrong, f"seed {seed}: {wrong}"


def run(make, number, seed, folder):
    """Run one job in a folder of its own, which goes: how it ended, and what is wrong with that."""
    place = folder / str(number)
    place.mkdir()
    try:
        words, off = make(number, random.Random(f"{seed} {number}"), place)
        try:
            done = COMMANDS.run(place, words, PATIENCE_SECONDS, PATIENCE_BYTES, PATIENCE)
        except TimeoutError:
            return {"status": None, "seconds": None, "memory": None, "wrong": ["hangs"], "told": ""}
        told = re.findall(r"^(?:error|warning|note)\[[A-Z_]+\]", done.err, re.MULTILINE)
        wrong = faults(done, place)
        points = deposited(place / "out" / "waypoints.csv")
        if off is not None and points is not None and done.status == 0:
            farthest = off(*points)
            if not farthest <= 0.0:
                wrong.append(f"off the part: {farthest:.4g} mm more than it may be")
        return {
            "status": done.status,
            "seconds": done.seconds,
            "memory": done.memory,
            "wrong": wrong,
            "told": " ".join(dict.fromkeys(told)),
            **({"err": done.err[-2000:]} if wrong else {}),
        }
    finally:
        shutil.rmtree(place)


def faults(done, folder):
    """What is wrong with how a command ended. A job told to be large may be stopped by the round's own limits."""
    if LARGE.search(done.err) and "error[ENDED]" in done.err:
        return []
    wrong = []
    if done.status not in (0, 2, 3):
        wrong.append(f"status {done.status}")
    for word in ("INTERNAL", "CRASHED", "ENDED", "NO_MEMORY"):
        found = re.search(rf"\[{word}\].*", done.err)
        if found:
            wrong.append(found[0])
    if "Traceback" in done.err:
        wrong.append("Traceback")
    if done.status == 2 and not re.fullmatch(
        r"((note|warning)\[\w+\] .+\n)*error\[[A-Z_]+\] .+\n", done.err
    ):
        wrong.append("status 2 without one line that tells why")
    if any(
        unicodedata.category(sign) in ("Cc", "Cf", "Cs", "Zl", "Zp")
        for sign in done.err.replace("\n", "")
    ):
        wrong.append("control signs in what is told")
    if not LARGE.search(done.err):
        if done.seconds > SECONDS:
            wrong.append(f"{done.seconds:.0f} s")
        if done.memory > MEMORY:
            wrong.append(f"{done.memory:.0f} MB")
    if list(folder.rglob(".unfinished*")):
        wrong.append("litter")
    out = folder / "out"
    if done.status == 2 and out.exists():
        wrong.append("files of a job that was refused")
    if done.status == 0 and not ((out / "report.json").exists() or (out / "place.csv").exists()):
        wrong.append("no report")
    return wrong


def deposited(path):
    """Some deposit points (n, 3) mm of a file of waypoints, ends of many beads among them, and the build directions (n, 3)
    there; None where there is no file."""
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
    some = (
        [ends[k] for k in np.linspace(0, len(ends) - 1, LOOKED_AT // 3).astype(int)] if rows else []
    )
    some += (
        np.linspace(0, len(rows) - 1, LOOKED_AT - len(some)).astype(int).tolist() if rows else []
    )
    chosen = np.array([rows[k][2:] for k in sorted(set(some))]).reshape(-1, 6)
    return chosen[:, :3], chosen[:, 3:]


def summary(rows):
    """The figures of a round."""
    timed = [row for row in rows if row["seconds"] is not None]
    seconds, memory = ([row[key] for row in timed] for key in ("seconds", "memory"))
    lines = [
        f"{len(rows)} jobs, status {dict(Counter(row['status'] for row in rows))}, {sum(seconds):.0f} s of the processor, "
        f"at most {max(seconds):.1f} s and {max(memory):.0f} MB",
    ]
    found = Counter(signature(one) for row in rows for one in row["wrong"])
    lines += [f"{count:6d}  {what}" for what, count in found.most_common()]
    return "\n".join(lines)


def signature(fault):
    """A fault without its numbers and names."""
    return re.sub(r"'[^']*'", "'...'", re.sub(r"-?\d[\d.e+-]*", "#", fault))[:160]


def _logged(path, seed):
    if not path.exists():
        return {}
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return {row["number"]: row for row in rows if row["seed"] == seed}
