# SPDX-License-Identifier: LGPL-2.1-or-later
"""The torch as a solid: rejected files, and the contents of its cylinders."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.geometry.obstacles import Body, box
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics import torch
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links.contact import TORCH, ArmContact
from freecad_am.core.kinematics.links.self_collision import NONE
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters

NOZZLE = NozzleParameters(half_angle=np.radians(30.0), diameter=4.0, length=50.0)


def put(*bodies):
    """Combine several bodies."""
    starts = np.cumsum([0, *(len(body.vertices) for body in bodies)])
    return Body(
        "torch",
        np.concatenate([body.vertices for body in bodies]),
        np.concatenate(
            [body.triangles + start for body, start in zip(bodies, starts, strict=False)]
        ),
    )


def box_at(size, x, y, z):
    """A box centred at a point in file coordinates, Z out of the nozzle."""
    return box(size, frames.pose(np.eye(3), np.array([x, y, z], float)), "torch")


NECK = box_at((12.0, 12.0, 200.0), 0.0, 0.0, -115.0)  # from 15 to 215 mm above the tip
CAMERA = box_at((150.0, 30.0, 40.0), 80.0, 0.0, -120.0)


def samples(body, count=4000, seed=7):
    """Points on the triangles of a body, weighted by area."""
    rng = np.random.default_rng(seed)
    corners = body.corners()
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    chosen_corners = corners[rng.choice(len(corners), count, p=area / area.sum())]
    share = rng.dirichlet([1.0, 1.0, 1.0], count)
    return np.einsum("nk,nkj->nj", share, chosen_corners)


def test_rods_hold_what_is_beyond_the_nozzle():
    """Capsules contain everything above the nozzle."""
    torch_shape = torch.torch(put(NECK, CAMERA), NOZZLE)
    points = samples(torch_shape.body)
    beyond = points[points[:, 2] > NOZZLE.length]
    assert (
        len(beyond) > 3000 and beyond[:, 2].max() > 214.0 and beyond[:, 0].max() > 154.0
    )  # Z into the torch, X unchanged
    is_inside = np.zeros(len(beyond), dtype=bool)
    for rod in torch_shape.cylinders:
        is_inside |= rod.holds(beyond)
    assert is_inside.all()
    assert sum(np.pi * rod.length * rod.radius**2 for rod in torch_shape.cylinders) < 3.2 * (
        165.0 * 12.0**2 + 149.0 * 30.0 * 40.0
    )


@pytest.mark.parametrize("seed", range(4))
def test_what_is_cut_is_all_there(seed):
    """Both halves of a cut together have the area and first moments of the whole, each on its own
    side."""
    rng = np.random.default_rng(seed)
    points, triangles = rng.normal(scale=20.0, size=(60, 3)), rng.integers(0, 60, (90, 3))
    triangles = triangles[(np.diff(np.sort(triangles, axis=1), axis=1) > 0).all(axis=1)]

    def moments(points, triangles):
        corners = points[triangles]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = 0.5 * np.linalg.norm(normal, axis=1)
        return np.array([area.sum(), *(0.5 * normal.sum(axis=0)), *(area @ corners.mean(axis=1))])

    halves = [torch.cut(points, triangles, 3.0, above) for above in (True, False)]
    assert np.allclose(
        sum(moments(*half) for half in halves), moments(points, triangles), rtol=1e-12, atol=1e-8
    )
    for (cut, faces), sign in zip(halves, (1.0, -1.0), strict=True):
        assert (sign * (cut[np.unique(faces)][:, 2] - 3.0)).min() >= -1e-9


@pytest.mark.parametrize(
    ("body", "says"),
    [
        (Body("torch", NECK.vertices, NECK.triangles[1:]), "the shape is open"),
        (box_at((12.0, 12.0, 100.0), 0.0, 0.0, -111.0), r"the torch is 61 mm away from its origin"),
        (box_at((12.0, 12.0, 100.0), 90.0, 0.0, -20.0), r"the torch is 84 mm away from its origin"),
        (
            box_at((12.0, 12.0, 100.0), 0.0, 0.0, 55.0),
            r"the torch extends 105 mm beyond its origin along Z",
        ),
        (box_at((3.0, 3.0, 100.0), 0.0, 0.0, -48.0), r"the torch extends 2 mm beyond its origin"),
        (
            box_at((30.0, 30.0, 100.0), 0.0, 0.0, -65.0),
            r"15 mm above its tip the torch extends 21.2\d mm from its axis, .* cone only 10.66 mm, .*half_angle of at least 52.1 deg",
        ),
        (box_at((30.0, 30.0, 100.0), 0.0, 0.0, -50.0), r"set a larger cell.nozzle.diameter"),
    ],
)
def test_what_is_refused(body, says):
    with pytest.raises(InputError, match=says) as error:
        torch.torch(body, NOZZLE)
    assert (error.value.code, error.value.where) == ("TORCH", "cell.nozzle.shape")


def test_the_angle_that_is_named_serves():
    body = box_at((30.0, 30.0, 100.0), 0.0, 0.0, -65.0)
    torch.torch(body, dataclasses.replace(NOZZLE, half_angle=np.radians(52.1)))
    with pytest.raises(InputError):
        torch.torch(body, dataclasses.replace(NOZZLE, half_angle=np.radians(51.9)))


@pytest.mark.parametrize("setup", ["tool-on-robot", "part-on-robot"])
def test_a_contact_is_where_torch_and_box_are(setup):
    """At random poses, with the torch or the part on the robot: a body within the clearance of the
    torch is reported, and one farther away by more than the enlargement of the cylinders is not."""
    settings = CellParameters(
        machine="fanuc-arcmate120ic",
        setup=setup,
        deposition_point=(900.0, 0.0, 200.0, 0.0, 0.0, 0.0),
        platform_diameter=0.0,
        nozzle=dataclasses.replace(NOZZLE, tool=(0.0, 0.0, 300.0, 0.0, 0.0, 0.0)),
    )
    cell = dataclasses.replace(
        cells.resolve(settings, np.eye(4)),
        shapes=cells.CellShapes(torch=torch.torch(put(NECK, CAMERA), NOZZLE)),
    )
    rng = np.random.default_rng(3)
    points, size = samples(cell.shapes.torch.body, 6000), np.array([200.0, 160.0, 120.0])
    beyond = points[points[:, 2] > NOZZLE.length + 1.0]
    rods = external_links.robot_cylinders(cell.robot.chain)
    joints = np.array([0.3, 0.4, -0.2, 0.5, 0.8, -0.4]) + rng.uniform(-0.12, 0.12, (2000, 6))
    _, frames_of_links = ArmContact(cell, [[] for _ in rods]).link_frames(joints)
    in_part = np.linalg.inv(frames_of_links["part"]) @ frames_of_links["nozzle"]
    block_pose = frames.pose(
        np.eye(3), in_part[0] @ [250.0, 0.0, 120.0, 1.0] @ np.eye(4, 3)
    )  # next to the camera, at first
    body = box(tuple(size), block_pose, "block")
    contact = ArmContact(cell, [[] for _ in rods], (body,), None, 10.0)
    distances = np.array(
        [
            np.linalg.norm(
                np.maximum(
                    np.abs(beyond @ pose[:3, :3].T + pose[:3, 3] - block_pose[:3, 3]) - 0.5 * size,
                    0.0,
                ),
                axis=1,
            ).min()
            for pose in in_part
        ]
    )
    met = contact.touches(joints)
    reported = met.link != NONE
    nozzle = np.array([contact.links[k] == "nozzle" if k != NONE else False for k in met.link])
    assert {contact.links[k] for k in met.link[reported]} <= {TORCH, "nozzle"}
    assert (reported | (distances > 10.0)).all() and 60 < (distances < 10.0).sum() < 1900
    assert (~reported | nozzle | (distances < 35.0)).all()
    assert (
        not ArmContact(
            dataclasses.replace(cell, shapes=cells.CellShapes()),
            [[] for _ in rods],
            (body,),
            None,
            10.0,
        )
        .touches(joints[reported & ~nozzle])
        .any.any()
    )
