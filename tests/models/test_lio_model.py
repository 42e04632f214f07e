"""The Lio's model says what the published figures say (docs/method.md, 6), and its meshes are sound."""

import numpy as np
import pytest
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from models import LIO_URDF, MODELS

START = (-1.62113, -1.19688, 1.27447, 0.02532, 1.48154, -0.05674)


@pytest.fixture(scope="module")
def plant():
    plant = MultibodyPlant(0.005)
    Parser(plant).AddModels(str(LIO_URDF))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("lio_base"))
    plant.Finalize()
    return plant


def tcp(plant, q):
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, np.concatenate([q, np.zeros(2)]))
    return plant.GetFrameByName("tcp").CalcPoseInWorld(context)


def test_height_at_zero(plant):
    assert tcp(plant, np.zeros(6)).translation() == pytest.approx([0, 0, 1.6445], abs=1e-9)


def test_start_posture(plant):
    X_BT = tcp(plant, START)
    assert X_BT.translation() == pytest.approx([0.170, 0.002, 1.049], abs=1e-3)
    # x of the tool points out of the gripper, which is level there.
    assert X_BT.rotation().matrix()[:, 0] == pytest.approx([1, 0, 0], abs=0.06)


def test_reach_from_joint_2(plant):
    stretched = tcp(plant, [0, np.pi / 2, 0, 0, 0, 0]).translation()
    assert np.linalg.norm(stretched - [0, 0, 0.478 + 0.1505]) == pytest.approx(1.016, abs=1e-9)


@pytest.mark.parametrize(
    ("joint", "limit_deg", "effort"),
    [(1, 170, 150), (2, 110, 150), (3, 115, 150), (4, 170, 55), (5, 115, 55), (6, 170, 30)],
)
def test_limits(plant, joint, limit_deg, effort):
    handle = plant.GetJointByName(f"lio_joint_{joint}")
    assert np.rad2deg(handle.position_upper_limit()) == pytest.approx(limit_deg)
    assert np.rad2deg(handle.position_lower_limit()) == pytest.approx(-limit_deg)
    assert np.rad2deg(handle.velocity_upper_limit()) == pytest.approx(95)
    assert plant.GetJointActuatorByName(f"lio_joint_{joint}").effort_limit() == effort
    assert handle.default_damping() == (10 if joint == 2 else 5)


@pytest.mark.parametrize(
    ("link", "mass", "inertia"),
    [
        (1, 3.652, (0.0666, 0.0661, 0.0076)),
        (2, 3.520, (0.1841, 0.1814, 0.0084)),
        (3, 1.626, (0.0237, 0.0224, 0.0034)),
        (4, 1.516, (0.0249, 0.0241, 0.0027)),
        (5, 1.417, (0.0135, 0.0126, 0.0027)),
        (6, 0.435, (0.00079, 0.00086, 0.00084)),
    ],
)
def test_inertias_are_the_published_ones_and_physical(plant, link, mass, inertia):
    M = plant.GetBodyByName(f"lio_link_{link}").default_spatial_inertia()
    assert M.get_mass() == mass
    central = M.Shift(M.get_com()).CalcRotationalInertia().CopyToFullMatrix3()
    assert np.diag(central) == pytest.approx(inertia, rel=1e-6)
    assert M.IsPhysicallyValid()


def test_fingers_mirror_and_meet(plant):
    context = plant.CreateDefaultContext()
    q = np.zeros(8)
    for angle in (0.0, 0.3, 0.5236):
        q[6:] = angle
        plant.SetPositions(context, q)
        left = plant.GetFrameByName("lio_finger_left").CalcPose(context, plant.GetFrameByName("tcp"))
        right = plant.GetFrameByName("lio_finger_right").CalcPose(context, plant.GetFrameByName("tcp"))
        # Tips are 0.147 along each finger, 0.03 inward of its pivot.
        tips = left.multiply(np.array([0, -0.03, 0.147])), right.multiply(np.array([0, 0.03, 0.147]))
        assert tips[0][1] == pytest.approx(-tips[1][1], abs=1e-12)
        opening = np.linalg.norm(tips[0] - tips[1])
        assert opening == pytest.approx(2 * (0.03 - 0.03 * np.cos(angle) + 0.147 * np.sin(angle)), abs=1e-9)


@pytest.mark.parametrize("path", sorted(MODELS.glob("**/*.obj")), ids=lambda p: p.stem)
def test_meshes_are_finite_with_unit_normals(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = np.array([line[1:] for line in lines if line[0] == "v"], dtype=float)
    normals = np.array([line[1:] for line in lines if line[0] == "vn"], dtype=float)
    assert np.isfinite(vertices).all()
    assert np.ptp(vertices, axis=0).max() < 1.0
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1, abs=2e-3)
