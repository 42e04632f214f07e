"""The objective's derivatives against finite differences, and its logarithm against scipy."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ik_arm import TCP, lio_plant
from scipy.spatial.transform import Rotation

from diagrams.ik_kinematics import ArmKinematics
from diagrams.ik_objective import PoseObjective
from diagrams.ik_rotation import axis_weight_derivatives, equal_weight_derivatives, half_cotangent, rotation_log

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


def test_series_and_closed_form_of_the_coefficients_meet() -> None:
    for below, above in zip(half_cotangent(1e-3 * (1 - 1e-12)), half_cotangent(1e-3), strict=True):
        assert below == pytest.approx(above, rel=1e-9)


@given(UNIT, st.sampled_from([a for a in ANGLES if a < 3.1]), st.tuples(*[st.floats(0.0, 5.0)] * 3))
def test_rotation_derivatives_match_finite_differences(
    a: tuple[float, ...], angle: float, weights: tuple[float, float, float]
) -> None:
    turn = Rotation.from_rotvec(angle * axis(a))

    def cost(omega: np.ndarray) -> float:
        phi = np.array(rotation_log((turn * Rotation.from_rotvec(omega)).as_matrix().tolist()))
        return float(np.dot(weights, phi**2))

    u, S = axis_weight_derivatives(tuple(angle * axis(a)), weights)
    steps = 1e-4 * np.eye(3)
    gradient = [(cost(d) - cost(-d)) / 2e-4 for d in steps]
    hessian = [[(cost(d + e) - cost(d - e) - cost(e - d) + cost(-d - e)) / 4e-8 for d in steps] for e in steps]
    np.testing.assert_allclose(2.0 * np.array(u), gradient, atol=2e-5)
    np.testing.assert_allclose(2.0 * np.array(S), hessian, atol=2e-4)


@given(UNIT, st.sampled_from(ANGLES))
def test_equal_weights_are_a_case_of_axis_weights(a: tuple[float, ...], angle: float) -> None:
    phi = tuple(angle * axis(a))
    for one, other in zip(
        axis_weight_derivatives(phi, (3.0, 3.0, 3.0)), equal_weight_derivatives(phi, 3.0), strict=True
    ):
        np.testing.assert_allclose(one, other, atol=1e-9)


@pytest.fixture(scope="module")
def kinematics() -> ArmKinematics:
    return ArmKinematics(lio_plant(), lio_plant().GetFrameByName(TCP))


@pytest.fixture(scope="module")
def objective() -> PoseObjective:
    plant = lio_plant()
    return PoseObjective(ArmKinematics(plant, plant.GetFrameByName(TCP)), 100.0)


@pytest.mark.parametrize("angle", [0.0, 1e-6, 0.02, 1.0, 2.6, 3.0, math.pi - 1e-3])
@pytest.mark.parametrize("weights", [(15.0, 15.0, 15.0), (0.1, 0.1, 0.1), (4.0, 1.0, 0.0)])
def test_gradient_and_hessian_match_finite_differences(
    objective: PoseObjective, angle: float, weights: tuple[float, float, float]
) -> None:
    rng = np.random.default_rng(3)
    arm = objective.kinematics
    for _ in range(3):
        q = rng.uniform(0.9 * arm.q_min, 0.9 * arm.q_max)
        arm.set(q)
        off = Rotation.from_rotvec(angle * axis(tuple(rng.normal(size=3)))).as_matrix()
        objective.set_target(
            arm.pose()[:, 3] + rng.normal(size=3), off @ arm.pose()[:, :3], weights, q + 0.1 * rng.normal(size=6)
        )

        def value(q: np.ndarray) -> float:
            return objective.value(q)

        def slope(q: np.ndarray) -> np.ndarray:
            objective.value(q)
            return objective.gradient()

        objective.value(q)
        gradient, hessian, _ = objective.derivatives()
        np.testing.assert_allclose(slope(q), gradient, rtol=1e-12, atol=1e-9)
        steps = 1e-5 * np.eye(6)
        np.testing.assert_allclose(gradient, [(value(q + d) - value(q - d)) / 2e-5 for d in steps], atol=1e-5)
        np.testing.assert_allclose(hessian, [(slope(q + d) - slope(q - d)) / 2e-5 for d in steps], atol=2e-5)
        np.testing.assert_allclose(hessian, hessian.T, atol=1e-12 * np.abs(hessian).max())


def test_value_is_the_objective_of_the_specification(objective: PoseObjective) -> None:
    rng = np.random.default_rng(4)
    arm = objective.kinematics
    q, q_prev = rng.uniform(arm.q_min, arm.q_max, size=(2, 6))
    p, R = rng.normal(size=3), Rotation.from_rotvec([0.3, -0.2, 0.5])
    objective.set_target(p, R.as_matrix(), (7.0, 7.0, 7.0), q_prev)
    arm.set(q)
    pose = arm.pose()
    theta = (Rotation.from_matrix(pose[:, :3]) * R.inv()).magnitude()
    expected = 100.0 * np.sum((pose[:, 3] - p) ** 2) + 7.0 * theta**2
    expected += np.sum(((q - q_prev) / (arm.q_max - arm.q_min)) ** 2)
    assert objective.value(q) == pytest.approx(expected, rel=1e-12)
    assert objective.orientation_error == pytest.approx(theta)
