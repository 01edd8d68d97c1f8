# SPDX-License-Identifier: LGPL-2.1-or-later
"""A command in a copy of a loaded process prints, writes and exits like a command that is
started."""

import json

import pytest

from tests.batch.conftest import Commands

SERVER = """
import json, os, sys, time
for name in json.loads(sys.stdin.readline())[2:4]:
    open(name, "w").close()
os.write(int(sys.argv[1]), str(os.getpid()).encode() + b"\\n")
while time.process_time() < {computes}:
    pass
time.sleep({sleeps})
os.write(int(sys.argv[1]), b"0 0.0 0.0\\n")
"""


def outputs_without_times(workshop):
    """Return the written files by name, without times: those of the report, and when a document was
    saved."""
    files = workshop.files("out")
    for name in files:
        if name.endswith("report.json"):
            report = json.loads(files[name])
            del report["timing_s"], report["joints"]["planning_time_s"]
            files[name] = report
        elif name.endswith(".FCStd"):
            files[name] = b""
    return files


@pytest.mark.parametrize(("words", "status"), [
    (("plan", "cup.yaml", "--no-page"), 0), (("plan", "far.yaml", "--no-page"), 3), (("plan", "wrong.yaml"), 2),
    (("machines", "nobody", "--dh"), 2),
])  # fmt: skip
def test_a_copy_does_what_the_launcher_does(workshop, words, status):
    coarse = workshop.text.replace("layer_height: 4 mm", "layer_height: 9 mm")
    workshop.write_job(coarse)
    unreachable_job = coarse.replace(
        "limits: paper", "limits: paper\n  deposition_point: [0, 0, 9000, 0, 0, 0]"
    )
    (workshop.folder / "far.yaml").write_text(unreachable_job)
    (workshop.folder / "wrong.yaml").write_text(coarse.replace("9 mm", "9 kg"))
    launched, written = workshop.launch(*words), outputs_without_times(workshop)
    copied = workshop.run(*words)
    assert (launched.status, launched.out, launched.err) == (copied.status, copied.out, copied.err)
    assert launched.status == status and outputs_without_times(workshop) == written
    assert bool(written) == (words[0] == "plan" and status != 2)


@pytest.mark.parametrize(("computes", "sleeps", "most_seconds", "ends"), [
    (2.5, 0, 60, True), (0, 60, 60, False), (60, 0, 0, False),
])  # fmt: skip
def test_what_waits_for_a_busy_processor_does_not_hang(
    tmp_path, computes, sleeps, most_seconds, ends
):
    """The timeout counts seconds of sleep, or of computing without a limit; the clock alone does
    not count."""
    script = tmp_path / "server.py"
    script.write_text(SERVER.format(computes=computes, sleeps=sleeps))
    commands = Commands()
    commands._start(script)
    began = commands.process
    if ends:
        assert commands.run(tmp_path, [], most_seconds, patience=1).status == 0
    else:
        with pytest.raises(TimeoutError):
            commands.run(tmp_path, [], most_seconds, patience=1)
        assert began.poll() is not None
    commands.end()
