"""Rotations as lists of three rows, and vectors as lists. Angles in degrees; roll, pitch, yaw of the sequence ZYX."""
import math


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def transposed(a):
    return [[a[j][i] for j in range(3)] for i in range(3)]


def applied(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def from_rpy(rpy_deg):
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(math.radians(x)), math.cos(math.radians(x))) for x in rpy_deg)
    return [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr]]


def to_rpy(c):
    pitch = math.asin(max(-1.0, min(1.0, -c[2][0])))
    if abs(c[2][0]) > 1.0 - 1e-12:
        return [0.0, math.degrees(pitch), math.degrees(math.atan2(-c[0][1], c[1][1]))]
    return [math.degrees(math.atan2(c[2][1], c[2][2])), math.degrees(pitch), math.degrees(math.atan2(c[1][0], c[0][0]))]


def rotation_vector(c):
    """Degrees about each axis."""
    cosine = max(-1.0, min(1.0, (c[0][0] + c[1][1] + c[2][2] - 1.0) / 2.0))
    angle = math.acos(cosine)
    axis = [c[2][1] - c[1][2], c[0][2] - c[2][0], c[1][0] - c[0][1]]
    scale = 0.5 if angle < 1e-6 else angle / (2.0 * math.sin(angle)) if angle < math.pi - 1e-6 else 0.0
    return [math.degrees(scale * x) for x in axis]


def from_vector(rotation_deg):
    angle = math.radians(math.hypot(*rotation_deg))
    if angle < 1e-12:
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    x, y, z = (math.radians(each) / angle for each in rotation_deg)
    k = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
    kk = product(k, k)
    return [[(i == j) + math.sin(angle) * k[i][j] + (1.0 - math.cos(angle)) * kk[i][j] for j in range(3)] for i in range(3)]


def of_a_box():
    """The 24 ways in which a box can be screwed down."""
    out = []
    for x in range(3):
        for y in range(3):
            if x == y:
                continue
            for sx in (1, -1):
                for sy in (1, -1):
                    a = [sx if i == x else 0 for i in range(3)]
                    b = [sy if i == y else 0 for i in range(3)]
                    c = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
                    out.append(transposed([a, b, c]))
    return out
