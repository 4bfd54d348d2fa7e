"""Errors, bounds, costs and clocks of many configurations."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Config
from ._draw import DrawState, state_of, thread_count
from ._inputs import QuadsLike, as_quads, configuration

if TYPE_CHECKING:
    import pandas
    from typing_extensions import Unpack

TEXT = ("status", "reason", "bound_lambda_kind", "bound_attribute_kind", "bound_depth_kind", "ranges")


def _axis(key: str, values: str | int | Iterable[int | str]) -> str:
    if isinstance(values, str) or not isinstance(values, Iterable):
        return f"{key}={values}"
    return f"{key}=" + ",".join(str(value) for value in values)


def sweep(
    quads: QuadsLike,
    axes: Mapping[str, str | int | Iterable[int | str]] | None = None,
    *,
    config: Config | None = None,
    attributes: npt.ArrayLike | None = None,
    one_at_a_time: bool | None = None,
    cycles: bool = True,
    objective: str = "arithmetic_lambda_max",
    threads: int | None = None,
    **state: Unpack[DrawState],
) -> pandas.DataFrame | npt.NDArray[np.void]:
    """Evaluates every combination of the axes on the quads: errors against the truth, bounds, hardware cost, clocks.

    axes: values of keys, such as {"significand_bits": range(10, 20), "align_guard_bits": "0:2"}; None: the usual values
    of every key, one at a time around `config`. cycles: also count clocks. objective: the error whose front with cost
    the column `pareto` marks.

    Returns a table with a row per configuration and the columns of `sweep_columns()`: a pandas DataFrame where pandas
    is installed, else a structured array. Raises ConfigError for an axis that does not exist.
    """
    base = configuration(config)
    given = as_quads(quads, attributes)
    if axes is not None and not isinstance(axes, Mapping):
        raise TypeError(f"axes: {axes!r}; a mapping of keys to values is expected")
    if one_at_a_time is None:
        one_at_a_time = not axes
    text = _core.sweep(
        given,
        [_axis(key, values) for key, values in (axes or {}).items()],
        base,
        state_of(given, base, state),
        one_at_a_time,
        cycles,
        objective,
        thread_count(threads),
    )
    columns = _columns(text)
    try:
        import pandas
    except ImportError:
        return _structured(columns)
    return pandas.DataFrame(columns)


def _columns(text: str) -> dict[str, npt.NDArray[Any]]:
    """Of the text of points.csv: text, whole numbers, or doubles with NaN where a cell is empty."""
    head, *rows = csv.reader(io.StringIO(text))
    columns: dict[str, npt.NDArray[Any]] = {}
    for name, cells in zip(head, zip(*rows)):
        if name == "worst":  # a command line of the program
            continue
        if name in TEXT:
            columns[name] = np.array(cells)
        elif all(cell.lstrip("-").isdigit() for cell in cells):
            columns[name] = np.array(cells).astype(np.int64)
        else:
            columns[name] = np.array([float(cell) if cell else np.nan for cell in cells])
    return columns


def _structured(columns: dict[str, npt.NDArray[Any]]) -> npt.NDArray[np.void]:
    table = np.empty(len(columns["row"]), dtype=[(name, column.dtype) for name, column in columns.items()])
    for name, column in columns.items():
        table[name] = column
    return table


def sweep_columns() -> dict[str, tuple[str, str]]:
    """Unit and meaning of each column of `sweep()`."""
    return {name: (unit, meaning) for name, unit, meaning in _core.sweep_columns() if name != "worst"}


def error_map(
    quads: QuadsLike,
    config: Config | None = None,
    *,
    attributes: npt.ArrayLike | None = None,
    threads: int | None = None,
    **state: Unpack[DrawState],
) -> npt.NDArray[np.float32]:
    """(height, width) float32: the largest error of a weight at each pixel against exact arithmetic on the snapped
    quads; −1 where nothing is drawn."""
    config = configuration(config)
    given = as_quads(quads, attributes)
    return _core.error_map(given, config, state_of(given, config, state), thread_count(threads))
