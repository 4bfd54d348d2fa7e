"""Quads of the demo, four for each pose of a turn: crossed, concave, convex quad and floor, with u and v."""
import math

POSES, QUADS, SIZE = 64, 4, (320, 240)
FOCAL, NEAR, FAR, PITCH = 230.0, 0.5, 12.0, -0.32  # pixels; units along the view; the camera looks down by PITCH radians
UV = ((-0.02, -0.02), (1.02, -0.02), (1.02, 1.02), (-0.02, 1.02))  # a little beyond 0 and 1, which colours are clamped to
FLOOR = ((-4.2, -4.2), (4.2, -4.2), (4.2, 4.2), (-4.2, 4.2))  # a corner comes behind the eye
CONVEX = ((-0.9, -0.6), (0.7, -0.9), (1.0, 0.8), (-0.5, 1.0))
CONCAVE = ((0.0, -0.25), (1.1, -0.9), (0.0, 1.2), (-1.1, -0.9))
CROSSED = ((-0.8, -0.8), (0.8, 0.8), (0.8, -0.8), (-0.8, 0.8))


def turned(x, y, angle):
    return x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)


def window(x, y, z):
    """Homogeneous window coordinates of a point: x right, y up, z along the view, from the eye."""
    y, z = turned(y, z, PITCH)
    return FOCAL * x + SIZE[0] / 2 * z, SIZE[1] / 2 * z - FOCAL * y, FAR / (FAR - NEAR) * (z - NEAR), z


def flat(corners, angle, at):
    """Turning about the vertical axis, lying."""
    for corner in corners:
        x, z = turned(*corner, angle)
        yield x + at[0], at[1], z + at[2]


def upright(corners, angle, spin, at):
    """Turning about the vertical axis by angle, and in its own plane by spin."""
    for corner in corners:
        x, y = turned(*corner, spin)
        x, z = turned(x, 0.0, angle)
        yield x + at[0], y + at[1], z + at[2]


def pose(number):
    turn = 2 * math.pi * (number + 9) / POSES  # the first poses have quads through each other
    yield upright(CROSSED, 0.4 * math.sin(turn), -turn, (1.2, -1.2, 4.0))
    yield upright(CONCAVE, 0.5 - turn, turn, (0.1, -0.9, 4.2))
    yield upright(CONVEX, turn, 0.0, (-1.15, -1.1, 4.4))
    yield flat(FLOOR, turn, (0.0, -2.3, 4.4))


def text(numbers):
    """The quads of some poses in the format .quads."""
    lines = ["# x y z w of four corners, then u and v of each", "# attributes: u v"]
    for number in numbers:
        for quad in pose(number):
            lines.append(" ".join([*(f"{value:.6f}" for point in quad for value in window(*point)), *(str(value) for uv in UV for value in uv)]))
    return "\n".join(lines) + "\n"
