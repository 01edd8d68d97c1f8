# SPDX-License-Identifier: LGPL-2.1-or-later
"""`freecad-am machines NAME` writes a machine in formats of other programs."""

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.machines import denavit_hartenberg as dh
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.kinematics.urdf import read as urdf
from freecad_am.kdl import KdlArm

Q = np.random.default_rng(8).uniform(-3, 3, (20, 6))


def test_a_urdf_from_the_command_line_is_the_machine(workshop):
    command = workshop.launch("machines", "kuka-kr16-2", "--urdf")
    path = workshop.folder / "arm.urdf"
    path.write_text(command.out, encoding="utf-8")
    chain = urdf.Urdf(path).between("base_link", "tool0")
    np.testing.assert_allclose(
        chain.chain.forward(Q), KdlArm(machine.load("kuka-kr16-2")).forward(Q), atol=1e-9
    )


@pytest.mark.parametrize("form", ["dh", "modified-dh"])
def test_a_table_from_the_command_line_is_the_machine(workshop, form):
    text_before, heading, *rows, text_after = workshop.run(
        "machines", "staubli-tx60", f"--{form}"
    ).out.splitlines()
    assert heading == "axis theta d a alpha" and len(rows) == 6

    def pose(line):
        figures = [float(word) for word in line.split()[1:]]
        return frames.from_rpy(figures[:3], np.radians(figures[3:]))

    table = dh.Table(
        tuple(
            dh.Row(np.radians(theta), d, a, np.radians(alpha))
            for theta, d, a, alpha in ([float(word) for word in row.split()[1:]] for row in rows)
        ),
        pose(text_before),
        pose(text_after),
        form != "dh",
    )
    np.testing.assert_allclose(
        dh.chain_of(table).forward(Q), KdlArm(machine.load("staubli-tx60")).forward(Q), atol=1e-7
    )


@pytest.mark.parametrize(
    "words,listed",
    [
        (["--maker", "kuka", "--reach", "3.2 m"], {"kuka-kr240-r3330", "kuka-kr210-r3300-2-k"}),
        (["--payload", "700 kg"], {"kuka-kr800-r2800-2"}),
        (
            ["--post", "staubli", "--reach", "1.3 m", "--maker", "Stäubli"],
            {"staubli-tx2-90xl", "staubli-tx90xl", "staubli-rx160", "staubli-rx160l"},
        ),
        (["--maker", "yaskawa", "--reach", "3100"], {"motoman-gp20hl", "motoman-gp200r"}),
        (["--maker", "universal robots", "--reach", "1.4 m"], {"ur-ur20"}),
        (["--payload", "2000"], set()),
    ],
)
def test_the_list_is_of_those_asked_for(workshop, words, listed):
    lines = workshop.run("machines", *words).out.splitlines()
    assert {line.split()[0] for line in lines} == listed
    assert all(", reach " in line for line in lines)


@pytest.mark.parametrize(
    "words,told",
    [
        (["--maker", "kukka"], "no known machine is from 'kukka'; use one of ABB, FANUC"),
        (["--payload", "heavy"], "'heavy' is not a mass"),
        (["--reach", "3 s"], "--reach"),
        (["--post", "krl"], "use one of fanuc"),
        (["kuka-kr16-2", "--urdf", "--reach", "1 m"], "remove 'kuka-kr16-2'"),
        (["kuka-kr16-2"], "the output format for 'kuka-kr16-2' is missing"),
        (["--urdf"], "--urdf needs the name of a machine"),
        (["kuka-kr16", "--dh"], "did you mean kuka-kr16-2"),
        (["kuka-kr16-2", "--dh", "--urdf"], "not allowed with"),
    ],
)
def test_slips_on_the_command_line_are_told(workshop, words, told):
    command = workshop.run("machines", *words)
    assert command.status == 2 and told in command.err and not command.out
