"""Quads: from arrays, scenes, families, files."""

from __future__ import annotations

import operator
import os
from collections.abc import Iterable, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Camera, Config, Mesh, Quads

QuadsLike = Union[Quads, npt.ArrayLike]
StrPath = Union[str, "os.PathLike[str]"]
#: x, y, z in the mesh's space, of any length but 0.
Direction = Sequence[float]


def whole(what: str, value: Any, least: int = -(2**31), most: int = 2**31 - 1, hint: str = "") -> int:
    """An argument that is a whole number, also one of NumPy's."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{what}: {value!r}; a whole number{hint} is expected") from None
    if not least <= number <= most:
        raise ValueError(f"{what}: {number}; a whole number from {least} to {most}{hint} is expected")
    return number


def wholes(what: str, values: Any, names: str, least: int = -(2**31)) -> Any:  # a tuple of so many
    """An argument of several whole numbers, such as width, height."""
    several = () if isinstance(values, str) or not isinstance(values, Iterable) else tuple(values)
    if len(several) != len(names.split(", ")):
        raise TypeError(f"{what}: {values!r}; {names} are expected")
    return tuple(whole(what, value, least) for value in several)


def flag(what: str, value: Any) -> bool:
    """An argument that is True or False, also one of NumPy's."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{what}: {value!r}; True or False is expected")
    return bool(value)


def configuration(config: Config | None) -> Config:
    """None is the default configuration."""
    if config is not None and not isinstance(config, Config):
        raise TypeError(f"config: {config!r}; a quadrille.Config is expected")
    return config or Config()


def _direction(what: str, values: Direction) -> tuple[float, ...]:
    try:
        x, y, z = map(float, values)
    except (TypeError, ValueError):
        raise TypeError(f"{what}: {values!r}; three numbers x, y, z are expected") from None
    return x, y, z


def as_quads(
    quads: QuadsLike,
    attributes: npt.ArrayLike | None = None,
    *,
    names: Sequence[str] | None = None,
    ids: npt.ArrayLike | None = None,
) -> Quads:
    """Quads of arrays. A `Quads` alone is returned as it is; with other attributes, names or ids it keeps all else.

    quads: (n, 4, 4) x̃, ỹ, z̃, w of each corner; or (n, 4, 2) x, y and (n, 4, 3) x, y, z with w = 1.
    attributes: (n, 4, a), or (n, 4) for one; a ≤ 8. names: of the attributes, default a0, a1, …
    ids: (n,) whole numbers that fragments carry, default 0 to n − 1.
    """
    like = quads if isinstance(quads, Quads) else None
    if isinstance(quads, Quads):
        if attributes is None and names is None and ids is None:
            return quads
        if attributes is None:
            attributes = quads.attributes
            names = names if names is not None else quads.names
        ids = quads.ids if ids is None else ids
        quads = quads.vertices
    vertices = np.asarray(quads, dtype=np.float64)
    if vertices.ndim == 2:
        vertices = vertices[np.newaxis]
        attributes = None if attributes is None else np.asarray(attributes, dtype=np.float64)[np.newaxis]
    if vertices.ndim != 3 or vertices.shape[1] != 4 or vertices.shape[2] not in (2, 3, 4):
        raise ValueError(
            f"quads: shape {vertices.shape}; (n, 4, 4) of x̃, ỹ, z̃, w is expected, or (n, 4, 2) or (n, 4, 3) with w = 1"
        )
    count, given = len(vertices), vertices.shape[2]
    if given < 4:
        full = np.zeros((count, 4, 4))
        full[:, :, :given] = vertices
        full[:, :, 3] = 1
        vertices = full
    values = np.zeros((count, 4, 0)) if attributes is None else np.asarray(attributes, dtype=np.float64)
    if values.shape == (count, 4):
        values = values[:, :, np.newaxis]
    if values.ndim != 3 or values.shape[:2] != (count, 4):
        raise ValueError(f"attributes: shape {values.shape}; ({count}, 4, a) is expected, a value of each corner")
    names = [f"a{i}" for i in range(values.shape[2])] if names is None else list(names)
    if not all(isinstance(name, str) for name in names):
        raise TypeError(f"names: {names!r}; a text for each attribute is expected")
    if len(names) != values.shape[2]:
        raise ValueError(f"names: {len(names)} of {values.shape[2]} attributes")
    numbers = None
    if ids is not None:
        numbers = np.asarray(ids, dtype=None if np.size(ids) else np.uint32)
        if (
            numbers.shape != (count,)
            or numbers.dtype.kind not in "iu"
            or (count and (numbers.min() < 0 or numbers.max() >= 2**32))
        ):
            raise ValueError(f"ids: ({count},) whole numbers from 0 to 2^32 − 1 are expected")
        numbers = np.ascontiguousarray(numbers, dtype=np.uint32)
    return _core.from_arrays(np.ascontiguousarray(vertices), np.ascontiguousarray(values), names, numbers, like)


def pick(quads: Quads, positions: int | slice | Iterable[int]) -> Quads:
    """Some of the quads, by position: a number, a slice, or several numbers. Ids stay."""
    several = list(positions) if isinstance(positions, Iterable) else positions
    return quads.pick(np.atleast_1d(np.arange(len(quads))[several]).tolist())


def scene(name: str, size: tuple[int, int] = (512, 512), attributes: str = "uv") -> Quads:
    """A built-in scene (`scenes()`) for a viewport.

    attributes: uv (u, v), normal (nx, ny, nz), uv_normal, weights (w0 to w3), position (px, py, pz), colour (red,
    green, blue) or none.
    """
    width, height = wholes("size", size, "width, height")
    return _core.scene(name, width, height, attributes)


def scenes(workloads: bool = False) -> list[dict[str, Any]]:
    """The papers' figures, or loads for the machine: name, title, paper, quads."""
    return _core.list_workloads() if workloads else _core.list_scenes()


def stress(
    family: str, count: int = 1000, *, seed: int = 1, size: tuple[int, int] = (512, 512), attributes: int = 4
) -> Quads:
    """Random quads of a stress family (`stress_families()`), with up to 4 random attributes a0, a1, …"""
    width, height = wholes("size", size, "width, height")
    count, seed = whole("count", count, 0), whole("seed", seed, 0, 2**64 - 1)
    return _core.stress(family, count, seed, width, height, whole("attributes", attributes, 0))


def stress_families() -> dict[str, str]:
    """Name and what it holds of each family."""
    return _core.list_stress()


def corner(
    group: str, config: Config | None = None, *, seed: int = 1, size: tuple[int, int] = (512, 512), attributes: int = 4
) -> Quads:
    """Directed quads of a corner group (`corners()`), which a configuration meets exactly."""
    from ._draw import make_state

    config = configuration(config)
    return _core.corner(
        group, config, make_state(config, size), whole("seed", seed, 0, 2**64 - 1), whole("attributes", attributes, 0)
    )


def corners() -> dict[str, str]:
    """Name and what occurs in it of each corner group."""
    return _core.list_corners()


def methods() -> dict[str, str]:
    """Name and what it does of each method of the papers, for `method()`."""
    return _core.list_methods()


def project(
    mesh: Mesh,
    size: tuple[int, int] = (512, 512),
    *,
    camera: Camera | None = None,
    attributes: str = "uv",
    up: Direction = (0, 1, 0),
    view_from: Direction | None = None,
    strict: bool = False,
    name: str = "mesh",
) -> Quads:
    """Quads of a mesh seen by a camera; without one, by one that shows all of it, from the direction `view_from` (mesh
    to eye, in the mesh's space).

    Id: 0-based face. A triangle becomes (a, b, c, c); a face with more corners is cut, and refused with `strict`.
    attributes: as of `scene()`. name: of the result.
    """
    width, height = wholes("size", size, "width, height")
    if camera is None:
        direction = None if view_from is None else _direction("view_from", view_from)
        camera = _core.frame_mesh(mesh, width, height, _direction("up", up), direction)
    return _core.project(mesh, camera, width, height, attributes, strict, name)


def load_mesh(
    path: StrPath,
    size: tuple[int, int] = (512, 512),
    *,
    merge_pairs: bool = False,
    camera: Camera | StrPath | None = None,
    attributes: str = "uv",
    up: Direction = (0, 1, 0),
    view_from: Direction | None = None,
    strict: bool = False,
) -> Quads:
    """`project()` of an OBJ, PLY, OFF or glTF file. Raises InputError with the file.

    camera: a `Camera` or the path of a JSON file. merge_pairs: joins neighbouring triangles to quads, which glTF does
    not hold; `notes` of the result has the counts.
    """
    if camera is not None and not isinstance(camera, Camera):
        camera = Camera.load(camera)
    mesh, name = Mesh.load(path, merge_pairs), os.path.basename(path)
    return project(
        mesh, size, camera=camera, attributes=attributes, up=up, view_from=view_from, strict=strict, name=name
    )


def load_quads(path: StrPath) -> Quads:
    """Quads of a .quads file; attributes as it names them, or a0, a1, … Raises InputError with file and line."""
    return _core.load_quads(path)


def save_quads(path: StrPath, quads: Quads) -> None:
    """Writes a .quads file, from which `load_quads()` gives the same doubles and names; ids are counted anew, from 0."""
    _core.save_quads(path, quads)
