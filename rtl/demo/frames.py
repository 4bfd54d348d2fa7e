"""Frames of the simulated demo against the model's fragments. The depth test and the colours are written here once more."""
import csv
import functools
import os
import struct
import zlib

from poses import POSES, QUADS, SIZE
from report.files import Failed

WIDTH, HEIGHT = SIZE
BACKGROUND = (1, 1, 1)  # steps of 7, 7, 3
FAR = 0xFFFF


def colour(u, v):
    """Steps of red, green, blue: 7, 7, 3."""
    u, v = (min(max(int(value * 8 // 1), 0), 7) for value in (u, v))
    return (u, v, 3) if (u + v) % 2 else (u // 2, v // 2, 1)


def expected(fragments):
    """Pixels of each pose, by number: place -> (red, green, blue)."""
    poses, depths = {}, {}
    for row in csv.DictReader(fragments):
        number, at = int(row["quad"]) // QUADS, (int(row["x"]), int(row["y"]))
        depth = float(row["z"]) * 2**16
        if depth < depths.get((number, at), FAR):
            depths[number, at] = depth
            poses.setdefault(number, {})[at] = colour(float(row["a0"]), float(row["a1"]))
    return poses


@functools.cache
def shown(steps):
    """The bytes of a colour on the screen: the bits of a step again and again, so that the top one is 255."""
    return bytes(int((f"{step:0{width}b}" * 8)[:8], 2) for step, width in zip(steps, (3, 3, 2)))


def png(width, height, pixels):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + pixels[3 * width * y:3 * width * (y + 1)] for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def compare(work, count):
    """frames.rgb, what the screen showed, with fragments.csv in the folder `work`; writes frame_0.png and so on there."""
    with open(os.path.join(work, "fragments.csv"), encoding="utf-8") as file:
        poses = expected(file)
    with open(os.path.join(work, "frames.rgb"), "rb") as file:
        frames = file.read()
    row_size = 2 * WIDTH * 3
    size = row_size * 2 * HEIGHT
    if len(frames) != count * size or sorted(poses) != list(range(min(count, POSES))):
        raise Failed(f"{len(frames) / size} frames and {len(poses)} poses with fragments instead of {count}")
    differ = 0
    for number in range(count):
        frame = frames[size * number:size * (number + 1)]
        with open(os.path.join(work, f"frame_{number}.png"), "wb") as file:
            file.write(png(2 * WIDTH, 2 * HEIGHT, frame))
        pose = poses[number % POSES]
        for y in range(2 * HEIGHT):
            want = b"".join(2 * shown(pose.get((x, y // 2), BACKGROUND)) for x in range(WIDTH))
            row = frame[row_size * y:row_size * (y + 1)]
            wrong = [x for x in range(2 * WIDTH) if row[3 * x:3 * x + 3] != want[3 * x:3 * x + 3]] if row != want else []
            for x in wrong[:max(0, 3 - differ)]:
                print(f"frame {number}, pixel {x}, {y}: shown {(*row[3 * x:3 * x + 3],)}, by the model {(*want[3 * x:3 * x + 3],)}")
            differ += len(wrong)
    drawn = sum(len(poses[number % POSES]) for number in range(count))
    print(f"demo: {count} frames, {4 * drawn} of {count * size // 3} pixels drawn, {differ} differ from the model")
    if differ:
        raise Failed("the frames are not the model's")
