"""Logarithm of a rotation and the derivatives of its weighted square, in closed form.

With the error rotation's logarithm φ (|φ| = θ ≤ π) the orientation cost is c = φᵀ W φ, W = diag(w) in the tool frame
(SPEC of the objective: w θ² when all three weights are equal). For an angular velocity ω,

    ċ = 2 u · ω,   u = J⁻ᵀ W φ,

and its second derivative along ω is 2 ωᵀ S ω plus the part that belongs to the arm's kinematics
(`diagrams.ik_objective`). For W = w I, u = w φ exactly, since φᵀ J_l(φ)⁻¹ = φᵀ. Plain floats rather than arrays: these
run several times in each control tick, and an array of three costs more than its arithmetic.
"""

import math

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

# Below this cosine (θ above 151°) sin θ loses the axis, and the symmetric part of the matrix gives it.
_NEAR_PI_COSINE = -0.875
# Below this θ² the closed forms cancel, and their series are exact to double precision.
_SERIES_BELOW = 1e-3


def rotation_log(rotation: list[list[float]]) -> Vector:
    """Logarithm φ [rad] of a 3x3 rotation matrix given as nested lists; |φ| in [0, π], finite at both ends."""
    (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
    cosine = 0.5 * (r00 + r11 + r22 - 1.0)
    x, y, z = 0.5 * (r21 - r12), 0.5 * (r02 - r20), 0.5 * (r10 - r01)  # sin θ times the axis
    sine = math.sqrt(x * x + y * y + z * z)
    angle = math.atan2(sine, cosine)
    if cosine > _NEAR_PI_COSINE:
        factor = angle / sine if sine > 1e-9 else 1.0
        return factor * x, factor * y, factor * z
    # R + Rᵀ = 2 cos θ I + 2 (1 - cos θ) a aᵀ: the largest diagonal entry's column is the axis up to its sign.
    xy, xz, yz = 0.5 * (r01 + r10), 0.5 * (r02 + r20), 0.5 * (r12 + r21)
    if r00 >= r11 and r00 >= r22:
        ax, ay, az, sign = r00 - cosine, xy, xz, x
    elif r11 >= r22:
        ax, ay, az, sign = xy, r11 - cosine, yz, y
    else:
        ax, ay, az, sign = xz, yz, r22 - cosine, z
    factor = math.copysign(angle, sign) / math.sqrt(ax * ax + ay * ay + az * az)
    return factor * ax, factor * ay, factor * az


def half_cotangent(angle_squared: float) -> tuple[float, float, float]:
    """k = h cot h with h = θ/2, c = (1 - k)/θ² and c'(θ)/θ: the coefficients of J⁻¹ = I ∓ ½[φ] + c[φ]²."""
    t = angle_squared
    if t < _SERIES_BELOW:
        c = 1.0 / 12.0 + t * (1.0 / 720.0 + t * (1.0 / 30240.0 + t / 1209600.0))
        return 1.0 - t * c, c, 1.0 / 360.0 + t * (1.0 / 7560.0 + t / 201600.0)
    half = 0.5 * math.sqrt(t)
    sine = math.sin(half)
    k = half * math.cos(half) / sine
    c = (1.0 - k) / t
    # dk/dθ = (cot h - h / sin² h) / 2, and c' = -(dk/dθ + 2 θ c) / θ².
    slope = 0.5 * (math.cos(half) / sine - half / (sine * sine))
    return k, c, -(slope + 4.0 * half * c) / (t * 2.0 * half)


def equal_weight_derivatives(phi: Vector, weight: float) -> tuple[Vector, Matrix]:
    """u and S of w θ² (any frame; φ, u and S are in the same one). S = w (k I + (1 - k) a aᵀ), a = φ/θ."""
    x, y, z = phi
    k, c, _ = half_cotangent(x * x + y * y + z * z)
    k *= weight
    c *= weight
    xy, xz, yz = c * x * y, c * x * z, c * y * z
    return (
        (weight * x, weight * y, weight * z),
        ((k + c * x * x, xy, xz), (xy, k + c * y * y, yz), (xz, yz, k + c * z * z)),
    )


def axis_weight_derivatives(phi: Vector, weights: Vector) -> tuple[Vector, Matrix]:
    """u and S of Σ w_i φ_i² in the tool frame, where φ = log(R*ᵀ R) and ω is the tool's, in the tool frame.

    u = W φ - ½ φ×y + c φ×(φ×y) with y = W φ, and S = sym(∂u/∂φ J_r(φ)⁻¹). Its antisymmetric part is [u]/2 and
    cancels against the arm's kinematics, so only S is returned.
    """
    x, y, z = phi
    wx, wy, wz = weights
    a, b, d = wx * x, wy * y, wz * z
    t = x * x + y * y + z * z
    _, c, slope = half_cotangent(t)
    dot = a * x + b * y + d * z
    # φ×(φ×y) = φ (φ·y) - θ² y
    ex, ey, ez = x * dot - t * a, y * dot - t * b, z * dot - t * d
    u = (
        a - 0.5 * (y * d - z * b) + c * ex,
        b - 0.5 * (z * a - x * d) + c * ey,
        d - 0.5 * (x * b - y * a) + c * ez,
    )
    # ∂u/∂φ = W - ½([φ]W - [y]) + (c'/θ) (φ×(φ×y)) φᵀ + c ((φ·y) I + 2 φ yᵀ - 2 y φᵀ - θ² W)
    keep = 1.0 - c * t
    phi_, y_, e_, w_ = (x, y, z), (a, b, d), (ex, ey, ez), weights
    skew_phi = ((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0))
    skew_y = ((0.0, -d, b), (d, 0.0, -a), (-b, a, 0.0))
    du = [
        [
            (keep * w_[i] + c * dot if i == j else 0.0)
            - 0.5 * (skew_phi[i][j] * w_[j] - skew_y[i][j])
            + slope * e_[i] * phi_[j]
            + 2.0 * c * (phi_[i] * y_[j] - y_[i] * phi_[j])
            for j in range(3)
        ]
        for i in range(3)
    ]
    # J_r⁻¹ = I + ½[φ] + c[φ]² = (1 - c θ²) I + ½[φ] + c φ φᵀ
    inverse = [
        [(keep if i == j else 0.0) + 0.5 * skew_phi[i][j] + c * phi_[i] * phi_[j] for j in range(3)] for i in range(3)
    ]
    m = [[sum(du[i][n] * inverse[n][j] for n in range(3)) for j in range(3)] for i in range(3)]
    s01, s02, s12 = 0.5 * (m[0][1] + m[1][0]), 0.5 * (m[0][2] + m[2][0]), 0.5 * (m[1][2] + m[2][1])
    return u, ((m[0][0], s01, s02), (s01, m[1][1], s12), (s02, s12, m[2][2]))
