"""Draws and snapping."""

from __future__ import annotations

import difflib
import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Config, Quads
from ._inputs import QuadsLike, as_quads, configuration, flag, whole, wholes

if TYPE_CHECKING:
    from typing_extensions import Unpack


class DrawState(TypedDict, total=False):
    """What stays constant over a draw, as keyword arguments of every function that draws.

    size: viewport; default that of the quads, else 512 × 512, or what the configuration has.
    scissor: x0, y0, x1, y1, half-open, inside the viewport. cull: none, front, back. perspective: attributes are
    perspective-correct. depth: window z is computed and clipped to [znear, zfar]. skip: names of work to leave out
    (tiles, quads, hidden, walk, operands, plane), or one such name; default what keeps every fragment.
    """

    size: tuple[int, int]
    scissor: tuple[int, int, int, int]
    cull: str
    perspective: bool
    depth: bool
    znear: float
    zfar: float
    skip: Iterable[str]


def _real(what: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what}: {value!r}; a number is expected") from None


def make_state(
    config: Config,
    size: tuple[int, int] | None,
    /,
    *,
    scissor: tuple[int, int, int, int] | None = None,
    cull: str = "none",
    perspective: bool = True,
    depth: bool = True,
    znear: float = 0.0,
    zfar: float = 1.0,
    skip: Iterable[str] | None = None,
    **unknown: object,
) -> _core.DrawState:
    for name in unknown:
        near = difflib.get_close_matches(name, DrawState.__annotations__, 1)
        hint = f'; did you mean "{near[0]}"?' if near else ""
        raise TypeError(f'unknown keyword "{name}"{hint} (of a draw: {", ".join(DrawState.__annotations__)})')
    if size is None:
        size = (min(512, 2**config.viewport_bits),) * 2
    if not isinstance(cull, str):
        raise TypeError(f"cull: {cull!r}; none, front or back is expected")
    width, height = wholes("size", size, "width, height")
    return _core.make_state(
        config,
        width,
        height,
        None if scissor is None else wholes("scissor", scissor, "x0, y0, x1, y1"),
        cull,
        flag("perspective", perspective),
        flag("depth", depth),
        _real("znear", znear),
        _real("zfar", zfar),
        None if skip is None else [skip] if isinstance(skip, str) else list(map(str, skip)),
    )


def state_of(quads: Quads, config: Config, state: DrawState) -> _core.DrawState:
    """Where nothing else is asked for, what the quads were made for."""
    if quads.size is not None:
        state = {"size": quads.size, **state}
    options: dict[str, Any] = {"perspective": quads.perspective, "cull": quads.cull, **state}
    return make_state(config, options.pop("size", None), **options)


def thread_count(threads: int | None) -> int:
    if threads is None:
        return len(os.sched_getaffinity(0))
    return whole("threads", threads, 1, hint=", or None for all processors,")


def as_array(made: tuple[Any, list[tuple[str, str, int]], int]) -> npt.NDArray[np.void]:
    """The structured array of bytes from the module; no copy."""
    raw, fields, itemsize = made
    names, formats, offsets = (list(column) for column in zip(*fields))
    return raw.view(np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": itemsize}))


def _drawn(
    quads: QuadsLike,
    attributes: npt.ArrayLike | None,
    config: Config | None,
    engine: str,
    method_name: str | None,
    snapped: bool,
    weights: bool,
    names: Sequence[str] | None,
    threads: int | None,
    state: DrawState,
) -> npt.NDArray[np.void]:
    config = configuration(config)
    given = as_quads(quads, attributes, names=names)
    of_draw = state_of(given, config, state)
    snapped, weights = flag("snapped", snapped), flag("weights", weights)
    return as_array(_core.draw(given, config, of_draw, engine, method_name, snapped, weights, thread_count(threads)))


def draw(
    quads: QuadsLike,
    attributes: npt.ArrayLike | None = None,
    *,
    config: Config | None = None,
    weights: bool = False,
    names: Sequence[str] | None = None,
    threads: int | None = None,
    **state: Unpack[DrawState],
) -> npt.NDArray[np.void]:
    """Draws quads with the untimed model: the bits of the RTL. Without depth test: every fragment, in the machine's order.

    quads, attributes, names: as of `as_quads()`. weights: the mean value weights l0 to l3, too. threads: default all
    processors; the result is the same. The other keywords are those of `DrawState`.

    Returns a structured array of n fragments with the fields
      quad     uint32   id
      x, y     uint16   pixel
      front    bool     counter-clockwise as seen on the screen
      flags    uint16   sum of 1 on an edge, 2 on a vertex, 4 on two corners, 8 on two edges, 16 tie, 32 homogeneous,
                        64 notch, 128 saturated
      depth    float64  window z in [0, 1]; not with depth=False
      u, v, …  float64  the attributes by their names
      depth_code, u_code, …  the integers that these are, in units of 2^−depth_bits and 2^−attribute_frac_bits

    More attributes than `attribute_slots`, and ids beyond `quad_id_bits`, are drawn as by a machine that has them.
    The lock of the interpreter is released. Raises SnapError for a quad that cannot be drawn.
    """
    return _drawn(quads, attributes, config, "model", None, True, weights, names, threads, state)


def truth(
    quads: QuadsLike,
    attributes: npt.ArrayLike | None = None,
    *,
    config: Config | None = None,
    snapped: bool = True,
    weights: bool = True,
    names: Sequence[str] | None = None,
    threads: int | None = None,
    **state: Unpack[DrawState],
) -> npt.NDArray[np.void]:
    """The same by exact arithmetic (113 bits, rounded to double), on the quads as the machine snaps them, or as given.

    Fields as of `draw()`, without codes; a quad's fragments by y, then x. The machine's values differ by at most
    `Config.bounds()`, which do not hold for the depth of a quad with a w ≤ 0; visibility of a quad with the eye in its
    hull may differ.
    """
    return _drawn(quads, attributes, config, "truth", None, snapped, weights, names, threads, state)


def paper(
    quads: QuadsLike,
    attributes: npt.ArrayLike | None = None,
    *,
    config: Config | None = None,
    single: bool = False,
    snapped: bool = True,
    weights: bool = True,
    names: Sequence[str] | None = None,
    threads: int | None = None,
    **state: Unpack[DrawState],
) -> npt.NDArray[np.void]:
    """The same by the paper's formulas as printed, in double or single precision. Flag 256: divided by 0; the numbers
    are invalid."""
    return _drawn(
        quads, attributes, config, "fp32" if single else "float", None, snapped, weights, names, threads, state
    )


def method(
    name: str,
    quads: QuadsLike,
    attributes: npt.ArrayLike | None = None,
    *,
    names: Sequence[str] | None = None,
    weights: bool = True,
    threads: int | None = None,
    **state: Unpack[DrawState],
) -> npt.NDArray[np.void]:
    """The same by one of the papers' methods (`methods()`), such as split02 (two triangles) or refine:20, on the quads
    as given. Flag 256: the method has no number for the pixel. Ctrl-C ends it after the quad that is drawn."""
    if not isinstance(name, str):
        raise TypeError(f"name: {name!r}; the name of a method is expected")
    return _drawn(quads, attributes, None, "truth", name, False, weights, names, threads, state)


def fragment_names(fragments: npt.NDArray[np.void]) -> list[str]:
    """Names of the attributes of fragments."""
    known = {"quad", "x", "y", "front", "flags", "depth", "l0", "l1", "l2", "l3"}
    names = fragments.dtype.names or ()
    return [name for name in names if name not in known and name.removesuffix("_code") not in {*names} - {name}]


def picture(
    fragments: npt.NDArray[np.void],
    fields: str | Sequence[str],
    size: tuple[int, int] = (512, 512),
    *,
    background: float = np.nan,
) -> npt.NDArray[np.float64]:
    """Fields of the nearest fragment of each pixel: (height, width), or (height, width, n) of several fields.

    Depth test LESS: of equal depths, and without depth, the first fragment stays.
    """
    width, height = wholes("size", size, "width, height", least=1)
    if len(fragments) and (fragments["x"].max() >= width or fragments["y"].max() >= height):
        raise ValueError(
            f"size: {width}x{height}; there is a fragment in column {fragments['x'].max()} and one in row "
            f"{fragments['y'].max()}: give the size that was drawn"
        )
    position = np.arange(len(fragments))
    depth = fragments["depth"] if "depth" in (fragments.dtype.names or ()) else np.zeros(len(fragments))
    order = np.lexsort((position, depth))[::-1]  # farthest first: what is written last stays
    several = [fields] if isinstance(fields, str) else list(fields)
    image = np.full((height, width, len(several)), background)
    for i, field in enumerate(several):
        image[fragments["y"][order], fragments["x"][order], i] = fragments[field][order]
    return image[:, :, 0] if isinstance(fields, str) else image


def snap(
    quads: QuadsLike,
    attributes: npt.ArrayLike | None = None,
    *,
    config: Config | None = None,
    names: Sequence[str] | None = None,
    **state: Unpack[DrawState],
) -> npt.NDArray[np.void]:
    """The integers of the machine's port: a structured array of n quads, no copy.

    id; base_attribute (a,), base_depth: codes that differences are counted from; depth_low, depth_high: codes of the
    corners' depths; vertex (4,) with x, y, w in units of 2^−(subpixel_bits + homogeneous_frac_bits) relative to pixel
    centres, and the numbers k, z, attribute (a,) of neg, exp, sig: `port_value()`. Raises SnapError.
    """
    config = configuration(config)
    given = as_quads(quads, attributes, names=names)
    raw, dtype = _core.snap(given, config, state_of(given, config, state))
    return raw.view(np.dtype(dtype))


def port_value(number: npt.NDArray[np.void], config: Config | None = None) -> npt.NDArray[np.float64]:
    """The value of numbers at the port: (−1)^neg · sig · 2^(exp − (significand_bits − 1))."""
    bits = configuration(config).significand_bits
    return np.ldexp(np.where(number["neg"], -1.0, 1.0) * number["sig"], number["exp"] - (bits - 1))
