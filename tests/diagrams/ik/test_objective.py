"""The objective's derivatives against finite differences, and its logarithm against scipy."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ik_arm import TCP, lio_plant
from scipy.spatial.transform import Rotation

from diagrams.ik.kinematics import ArmKinematics
from diagrams.ik.objective import PoseObjective
from diagrams.ik.rotation import inverse_left_jacobian, rotation_log

ANGLES = [0.0, 1e-12, 1e-6, 1e-3, 0.031, 0.032, 0.5, 2.0, 2.6, 2.64, 3.0, math.pi - 1e-3, math.pi - 1e-9]
UNIT = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda a: math.hypot(*a) > 0.1)


def axis(a: tuple[float, ...]) -> np.ndarray:
    return np.array(a) / math.hypot(*a)


@given(UNIT, st.sampled_from(ANGLES))
def test_logarithm_is_the_inverse_of_the_exponential(a: tuple[float, ...], angle: float) -> None:
    phi = angle * axis(a)
    matrix = Rotation.from_rotvec(phi).as_matrix()
    np.testing.assert_allclose(rotation_log(matrix.tolist()), phi, atol=3e-9 if angle > 3.1415 else 1e-14)


@given(UNIT)
def test_logarithm_of_a_half_turn_is_one_of_its_two_axes(a: tuple[float, ...]) -> None:
    phi = math.pi * axis(a)
    found = np.array(rotation_log(Rotation.from_rotvec(phi).as_matrix().tolist()))
    assert min(np.abs(found - phi).max(), np.abs(found + phi).max()) < 1e-7


def test_series_and_closed_form_of_the_inverse_jacobian_meet() -> None:
    below, above = (inverse_left_jacobian((math.sqrt(t), 0.0, 0.0)) for t in (1e-3 * (1 - 1e-12), 1e-3))
    np.testing.assert_allclose(below, above, atol=1e-13)


@given(UNIT, st.sampled_from([a for a in ANGLES if a < 3.1]))
def test_inverse_jacobian_is_the_slope_of_the_logarithm(a: tuple[float, ...], angle: float) -> None:
    turn = Rotation.from_rotvec(angle * axis(a))

    def log_of(omega: np.ndarray) -> np.ndarray:
        return np.array(rotation_log((Rotation.from_rotvec(omega) * turn).as_matrix().tolist()))

    slope = np.array([log_of(d) - log_of(-d) for d in 1e-5 * np.eye(3)]).T / 2e-5
    np.testing.assert_allclose(inverse_left_jacobian(tuple(angle * axis(a)), 3.0), 3.0 * slope, atol=1e-6)


@given(UNIT, st.sampled_from(ANGLES))
def test_inverse_jacobian_leaves_the_logarithm_itself_alone(a: tuple[float, ...], angle: float) -> None:
    phi = angle * axis(a)
    np.testing.assert_allclose(phi @ np.array(inverse_left_jacobian(tuple(phi))), phi, atol=1e-12)


@pytest.fixture(scope="module")
def objective() -> PoseObjective:
    plant = lio_plant()
    return PoseObjective(ArmKinematics(plant, plant.GetFrameByName(TCP)), 100.0)


@pytest.mark.parametrize("angle", [0.0, 1e-6, 0.02, 1.0, 2.6, 3.0, math.pi - 1e-3])
@pytest.mark.parametrize("weight", [0.0, 0.1, 15.0])
def test_gradient_and_gauss_newton_matrix_match_finite_differences(
    objective: PoseObjective, angle: float, weight: float
) -> None:
    rng = np.random.default_rng(3)
    arm = objective.kinematics
    steps = 1e-5 * np.eye(6)
    for _ in range(3):
        q = rng.uniform(0.9 * arm.q_min, 0.9 * arm.q_max)
        arm.set(q)
        R = Rotation.from_rotvec(angle * axis(tuple(rng.normal(size=3)))).as_matrix() @ arm.pose()[:, :3]
        p = arm.pose()[:, 3] + rng.normal(size=3)
        objective.set_target(p, R, weight, q + 0.1 * rng.normal(size=6))

        def value(q: np.ndarray) -> float:
            return objective.value(q)

        def residual(q: np.ndarray, p: np.ndarray = p, R: np.ndarray = R) -> np.ndarray:
            arm.set(q)
            pose = arm.pose()
            phi = Rotation.from_matrix(pose[:, :3] @ R.T).as_rotvec()
            return np.concatenate((math.sqrt(weight) * phi, 10.0 * (pose[:, 3] - p)))

        K = np.array([residual(q + d) - residual(q - d) for d in steps]).T / 2e-5
        slope = [(value(q + d) - value(q - d)) / 2e-5 for d in steps]
        objective.value(q)
        gradient, hessian = objective.model()
        np.testing.assert_allclose(gradient, slope, atol=1e-5)
        np.testing.assert_array_equal(objective.gradient(), gradient)
        wanted = 2.0 * (K.T @ K + np.diag(1.0 / (arm.q_max - arm.q_min) ** 2))
        np.testing.assert_allclose(hessian, wanted, atol=1e-5 * max(weight, 1.0))
        assert np.linalg.eigvalsh(hessian)[0] > 0.0


def test_value_is_the_objective_of_the_specification(objective: PoseObjective) -> None:
    rng = np.random.default_rng(4)
    arm = objective.kinematics
    q, q_prev = rng.uniform(arm.q_min, arm.q_max, size=(2, 6))
    p, R = rng.normal(size=3), Rotation.from_rotvec([0.3, -0.2, 0.5])
    objective.set_target(p, R.as_matrix(), 7.0, q_prev)
    arm.set(q)
    pose = arm.pose()
    theta = (Rotation.from_matrix(pose[:, :3]) * R.inv()).magnitude()
    expected = 100.0 * np.sum((pose[:, 3] - p) ** 2) + 7.0 * theta**2
    expected += np.sum(((q - q_prev) / (arm.q_max - arm.q_min)) ** 2)
    assert objective.value(q) == pytest.approx(expected, rel=1e-12)
    assert objective.orientation_error == pytest.approx(theta)
