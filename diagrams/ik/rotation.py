"""Logarithm of a rotation and the inverse of its left Jacobian, in closed form.

With φ the logarithm of a rotation E, |φ| = θ ≤ π, turning E on by ω dt (in the frame that E maps into) changes φ by
J_l⁻¹ ω dt, J_l⁻¹ = k I - ½[φ] + c φφᵀ, k = h cot h, c = (1 - k)/θ², h = θ/2. Plain floats rather than arrays: these run
several times in each control tick, and an array of three costs more than its arithmetic.
"""

import math

Vector = tuple[float, float, float]
"""Three numbers."""
Matrix = tuple[Vector, Vector, Vector]
"""Three rows of three numbers."""

# Below this cosine (θ above 151°) sin θ loses the axis, and the symmetric part of the matrix gives it.
_NEAR_PI_COSINE = -0.875
# Below this θ² the closed form of c cancels, and its series is exact to double precision.
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


def inverse_left_jacobian(phi: Vector, scale: float = 1.0) -> Matrix:
    """`scale` times J_l⁻¹(φ), as nested tuples; finite up to |φ| = π.

    Args:
        phi: φ, a rotation vector, [rad].
        scale: any.
    """
    x, y, z = phi
    t = x * x + y * y + z * z
    if t < _SERIES_BELOW:
        c = 1.0 / 12.0 + t * (1.0 / 720.0 + t * (1.0 / 30240.0 + t / 1209600.0))
        k = 1.0 - t * c
    else:
        half = 0.5 * math.sqrt(t)
        k = half / math.tan(half)
        c = (1.0 - k) / t
    k, c = scale * k, scale * c
    hx, hy, hz = 0.5 * scale * x, 0.5 * scale * y, 0.5 * scale * z
    xy, xz, yz = c * x * y, c * x * z, c * y * z
    return (
        (k + c * x * x, xy + hz, xz - hy),
        (xy - hz, k + c * y * y, yz + hx),
        (xz + hy, yz - hx, k + c * z * z),
    )
