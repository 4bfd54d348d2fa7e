"""Words of the machine's ports, for a bench of one's own: hexadecimal digits of packed structs, as $readmemh takes them."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Config
from ._draw import DrawState, as_array, make_state, state_of
from ._inputs import QuadsLike, as_quads, configuration

if TYPE_CHECKING:
    from typing_extensions import Unpack


def vertex_words(
    quads: QuadsLike,
    attributes: npt.ArrayLike | None = None,
    *,
    config: Config | None = None,
    names: Sequence[str] | None = None,
    **state: Unpack[DrawState],
) -> list[str]:
    """`vertex_t` of each vertex in order, four a quad. int(word, 16) is what cocotb assigns to vertex_i."""
    config = configuration(config)
    given = as_quads(quads, attributes, names=names)
    return _core.vertex_words(given, config, state_of(given, config, state))


def state_word(config: Config | None = None, *, attributes: int = 4, **state: Unpack[DrawState]) -> str:
    """`state_t` of a draw with so many attributes."""
    config = configuration(config)
    options: dict[str, Any] = dict(state)
    return _core.state_word(config, make_state(config, options.pop("size", None), **options), attributes)


def fragments_of_words(
    words: Iterable[str | int], *, config: Config | None = None, names: Sequence[str] = (), depth: bool = True
) -> npt.NDArray[np.void]:
    """Fragments of your own machine as an array like that of `draw()`, for the two to be compared.

    words: `fragment_t` of each, as digits or numbers: lane g of fragment_o has the bits from g · FRAGMENT_BITS on.
    """
    config = configuration(config)
    digits = (_core.fragment_bits(config) + 3) // 4
    texts = [word if isinstance(word, str) else f"{operator.index(word):0{digits}x}" for word in words]
    return as_array(_core.fragments_of_words(texts, config, depth, list(names)))
