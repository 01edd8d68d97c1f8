# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run independent interpreters of five-axis programs: LinuxCNC's own `rs274`, and
nc-gcode-interpreter for SINUMERIK; rosbags reads messages of ROS. `./freecad-am test` puts them
into .test-env: the package linuxcnc-uspace, unpacked but not installed, and a Python environment.
Tests skip if they are missing."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ENVIRONMENT = Path(__file__).resolve().parents[2] / ".test-env"
UNPACKED = ENVIRONMENT / "linuxcnc"
NC_PYTHON = ENVIRONMENT / "nc" / "bin" / "python"
PACKAGES = ("linuxcnc-uspace", "libboost-python1.74.0", "libtirpc3", "libedit2")
WHEELS = ("nc-gcode-interpreter", "polars", "polars-runtime-32", "rosbags")
TIMEOUT_S = 120


def rs274() -> tuple[list[str], dict[str, str]] | None:
    """Return command and environment of LinuxCNC's interpreter, None without it."""
    unpacked = UNPACKED / "usr" / "bin" / "rs274"
    if unpacked.exists():
        libraries = [
            str(UNPACKED / "usr/lib"),
            *map(str, (UNPACKED / "usr/lib").glob("*-linux-gnu")),
        ]
        return [str(unpacked)], {**os.environ, "LD_LIBRARY_PATH": ":".join(libraries)}
    installed = shutil.which("rs274")
    return ([installed], dict(os.environ)) if installed else None


def nc_python() -> list[str] | None:
    """Return a Python with nc-gcode-interpreter, None without one."""
    return [str(NC_PYTHON)] if NC_PYTHON.exists() else None


def ros_packages() -> Path | None:
    """Return the folder from which a Python imports rosbags, None without it."""
    folders = NC_PYTHON.parents[1].glob("lib/*/site-packages")
    return next((folder for folder in folders if (folder / "rosbags").exists()), None)


def provide() -> None:
    """Fetch missing interpreters, and print a message if that fails."""
    if rs274() is None and not _unpack():
        print(
            "freecad-am: no rs274 of LinuxCNC: its programs are NOT interpreted by the tests",
            flush=True,
        )
    if (nc_python() is None or ros_packages() is None) and not _wheels():
        print(
            "freecad-am: no nc-gcode-interpreter or rosbags: SINUMERIK programs and trajectories of ROS "
            "are NOT read by the tests",
            flush=True,
        )


def _unpack() -> bool:
    if not (shutil.which("apt-get") and shutil.which("dpkg-deb")):
        return False
    print(
        f"freecad-am: unpacking {', '.join(PACKAGES)} into {ENVIRONMENT.name}",
        file=sys.stderr,
        flush=True,
    )
    with tempfile.TemporaryDirectory() as folder:
        if not _succeeds(["apt-get", "download", "-q", *PACKAGES], cwd=folder):
            return False
        shutil.rmtree(UNPACKED, ignore_errors=True)
        UNPACKED.parent.mkdir(parents=True, exist_ok=True)
        return all(
            _succeeds(["dpkg-deb", "-x", str(package), str(UNPACKED)])
            for package in Path(folder).glob("*.deb")
        )


def _wheels() -> bool:
    print(
        f"freecad-am: making {ENVIRONMENT.name} with {', '.join(WHEELS)}",
        file=sys.stderr,
        flush=True,
    )
    folder = NC_PYTHON.parents[1]
    if not _succeeds([sys.executable, "-m", "venv", str(folder)]):
        return False
    # the interpreter needs only these
    if _succeeds(
        [
            str(NC_PYTHON),
            "-m",
            "pip",
            "install",
            "-q",
            "--no-deps",
            "--only-binary",
            ":all:",
            *WHEELS,
        ]
    ):
        return _succeeds([str(NC_PYTHON), "-c", "import nc_gcode_interpreter"])
    shutil.rmtree(folder, ignore_errors=True)
    return False


def _succeeds(command: list[str], **options: object) -> bool:
    try:
        return subprocess.run(command, timeout=TIMEOUT_S, check=False, **options).returncode == 0  # type: ignore[call-overload]
    except (OSError, subprocess.TimeoutExpired):
        return False


KINEMATICS = (428, 429, 430)


def run_rs274(
    folder: Path, files: dict[str, bytes], main: str, tool_length: float = 0.0
) -> tuple[list[dict], list[str]]:
    """Return the moves of a program in order, and the complaints of LinuxCNC's interpreter. A move
    has: at (6,) in mm and deg, seconds, deposit, kinematics (428, 429 or None), offset (number of
    the work offset), corner (mm, the largest rounding, 0 for an exact stop), analogue (values of
    outputs). The seconds follow from the feed as LinuxCNC counts it: that of the linear axes if
    they move, else of the rotary ones."""
    command, environment = rs274()
    for name, content in files.items():
        (folder / name).write_bytes(content)
    remaps = "".join(f"REMAP=M{code} modalgroup=10 ngc=kinematics{code}\n" for code in KINEMATICS)
    for code in KINEMATICS:
        lines = [
            f"o<kinematics{code}> sub",
            f"(kinematics {code})",
            f"o<kinematics{code}> endsub",
            "M2",
            "",
        ]
        (folder / f"kinematics{code}.ngc").write_text("\n".join(lines))
    (folder / "clean.ngc").write_text("o<clean> sub\n(cleaned)\nG20 G91\no<clean> endsub\nM2\n")
    (folder / "machine.ini").write_text(
        f"[RS274NGC]\nSUBROUTINE_PATH={folder}\n{remaps}[TRAJ]\nLINEAR_UNITS=mm\n[EMCIO]\n"
    )
    # without a configuration, its unit for the tool table is inches
    (folder / "tool.tbl").write_text(
        "".join(f"T{n} P{n} Z{tool_length / 25.4:.6f} D0.1 ;\n" for n in range(1, 30))
    )
    arguments = ["-g", "-n", "2", "-t", "tool.tbl", "-v", "numbers.var", "-i", "machine.ini", main]
    result = subprocess.run(
        [*command, *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    moves, complaints, has_ended = [], [], False
    position, feed, deposit, kinematics, offset = np.full(6, np.nan), 0.0, False, None, 0
    analogue: dict[int, tuple[float, bool]] = {}
    corner: float | None = None
    for line in (result.stdout + result.stderr).splitlines():
        match = re.match(r" *\d+ N\S* +(\w+)\((.*)\)\s*$", line)
        if match is None:
            if line.strip() not in ("", "executing") and "updating variable file" not in line:
                complaints.append(line.strip())
            continue
        word, inside = match.groups()
        if word == "SET_FEED_RATE":
            feed = float(inside)
        elif word == "SET_G5X_OFFSET":
            offset = int(inside.split(",")[0])
        elif word == "SET_MOTION_CONTROL_MODE":
            mode, _, bound = inside.partition(",")
            corner = {"CANON_EXACT_STOP": 0.0, "CANON_CONTINUOUS": float(bound or "inf")}.get(mode)
        elif word in ("SET_AUX_OUTPUT_BIT", "CLEAR_AUX_OUTPUT_BIT"):
            deposit = word.startswith("SET")
        elif word in ("SET_AUX_OUTPUT_VALUE", "SET_MOTION_OUTPUT_VALUE"):
            number, value = inside.split(",")
            analogue[int(number)] = (float(value), word.startswith("SET_MOTION"))
        elif word == "COMMENT" and (kinematics_match := re.match(r'"kinematics (\d+)', inside)):
            kinematics = int(kinematics_match[1])
        elif word in ("STRAIGHT_FEED", "STRAIGHT_TRAVERSE"):
            target = np.array([float(value) for value in inside.split(",")][:6])
            step = target - position
            distance = np.linalg.norm(step[:3]) or np.linalg.norm(step[3:])
            moves.append(
                {
                    "at": target,
                    "way": distance,
                    "feed": feed,
                    "seconds": 60.0 * distance / feed if feed else np.nan,
                    "deposit": deposit,
                    "kinematics": kinematics,
                    "offset": offset,
                    "corner": corner,
                    "rapid": word != "STRAIGHT_FEED",
                    "analogue": dict(analogue),
                }
            )
            position = target
        has_ended |= word == "PROGRAM_END"
    if result.returncode or not has_ended:
        complaints.append(f"status {result.returncode}, {'' if has_ended else 'not '}at its end")
    return moves, complaints


# runs in the other Python, and prints the rows of the interpreter as JSON
_INTERPRET = """
import json, sys
import nc_gcode_interpreter as nc
for text, extra in json.load(sys.stdin):
    try:
        frame, _ = nc.nc_to_dataframe(text, extra_axes=extra or None, iteration_limit=10_000_000)
    except Exception as error:
        print(json.dumps({"error": str(error)}))
    else:
        print(json.dumps({"columns": frame.columns, "rows": frame.rows()}))
"""
# words of the language that the interpreter takes for subprogram calls
_KNOWN = {"TRAORI", "TRAFOOF", "FGROUP(X,Y,Z)", "STOPRE"}


def run_nc(texts: list[str]) -> list[tuple[list[dict], list[str], str]]:
    """Return, for each SINUMERIK program, the blocks of nc-gcode-interpreter as rows, the names
    that it takes for calls, and its complaint, or ''. Words without an address in it (A3=, H1=)
    become variables of other names; rows have their original names, and analogue outputs are O1 and
    so on. C=DC(..) is the value, and input 3 reads as on."""
    requests = []
    for text in texts:
        plain = re.sub(r"(?:\bDO )?\$A_OUTA\[(\d+)\]=", r"O\1=", text)
        plain = re.sub(r"\b([A-Z]\d+)=(?!=)", r"V_\1=", plain)
        plain = (
            re.sub(r"=DC\(([^()]*)\)", r"=\1", plain)
            .replace("$A_IN[3]==0", "0==1")
            .replace("$A_INA[4]>=", "0>=")
        )
        requests.append((plain, sorted(set(re.findall(r"\bV_[A-Z]\d+(?==)", plain)))))
    result = subprocess.run(
        [*(nc_python() or []), "-c", _INTERPRET], input=json.dumps(requests), capture_output=True, text=True, timeout=TIMEOUT_S,
        check=True,
    )  # fmt: skip
    return [_rows(json.loads(line)) for line in result.stdout.splitlines()]


def _rows(reply: dict) -> tuple[list[dict], list[str], str]:
    if "error" in reply:
        return [], [], reply["error"]
    rows = [
        {name.removeprefix("V_"): value for name, value in zip(reply["columns"], row, strict=True)}
        for row in reply["rows"]
    ]
    calls = []
    for row in rows:
        names = row.get("function_call") or row.get("non_returning_function_call") or []
        calls += [
            name for name in ([names] if isinstance(names, str) else names) if name not in _KNOWN
        ]
    return rows, calls, ""
