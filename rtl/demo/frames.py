"""Frames of the simulated demo against the model's fragments. The depth test and the colours are written here once more."""
import csv
import functools
import struct
import zlib

from poses import SIZE
from report.files import Failed

WIDTH, HEIGHT = SIZE
BACKGROUND = (1, 1, 1)  # steps of 7, 7, 3
FAR = 0xFFFF


def colour(u, v):
    """Steps of red, green, blue: 7, 7, 3."""
    u, v = (min(max(int(value * 8 // 1), 0), 7) for value in (u, v))
    return (u, v, 3) if (u + v) % 2 else (u // 2, v // 2, 1)


def expected(fragments):
    """Pixels that a pose draws: place -> (red, green, blue)."""
    pixels, depths = {}, {}
    for row in csv.DictReader(fragments):
        at, depth = (int(row["x"]), int(row["y"])), float(row["z"]) * 2**16
        if depth < depths.get(at, FAR):
            depths[at] = depth
            pixels[at] = colour(float(row["u"]), float(row["v"]))
    return pixels


@functools.cache
def shown(steps):
    """The bytes of a colour on the screen: the bits of a step again and again, so that the top one is 255."""
    return bytes(int((f"{step:0{width}b}" * 8)[:8], 2) for step, width in zip(steps, (3, 3, 2)))


def png(frame):
    width, height = 2 * WIDTH, 2 * HEIGHT

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + frame[3 * width * y:3 * width * (y + 1)] for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def compare(frame, fragments):
    """A frame, as the screen showed it, with the fragments of its pose. Raises Failed with the first pixels that differ; returns how many
    pixels of the screen the quads have."""
    with open(fragments, encoding="utf-8") as file:
        pixels = expected(file)
    row_size = 2 * WIDTH * 3
    if not pixels or len(frame) != row_size * 2 * HEIGHT:
        raise Failed(f"{len(frame)} bytes of a frame, {len(pixels)} pixels in {fragments}")
    wrong = []
    for y in range(2 * HEIGHT):
        want = b"".join(2 * shown(pixels.get((x, y // 2), BACKGROUND)) for x in range(WIDTH))
        row = frame[row_size * y:row_size * (y + 1)]
        if row != want:
            wrong += [(x, y, (*row[x:x + 3],), (*want[x:x + 3],)) for x in range(0, row_size, 3) if row[x:x + 3] != want[x:x + 3]]
    if wrong:
        raise Failed(f"{len(wrong)} pixels differ:" + "".join(f"\n  pixel {x // 3}, {y}: shown {is_}, by the model {want}" for x, y, is_, want in wrong[:3]))
    return 4 * len(pixels)


def split(path, count):
    """The frames of a file, one after the other."""
    with open(path, "rb") as file:
        for _ in range(count):
            yield file.read(4 * WIDTH * HEIGHT * 3)
