"""The clocked model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Config
from ._draw import DrawState, as_array, make_state
from ._inputs import QuadsLike, as_quads, configuration, flag, whole

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Machine:
    """The machine clock by clock: valid, ready and payload of the RTL. After a reset and idle when made.

        machine = Machine(names=["u", "v"], size=(64, 64))
        machine.push(quads)
        while not machine.idle:
            machine.clock(fragment_ready=machine.clocks % 3 != 0)   # a stall every third clock
        fragments = machine.take()

    names: of the attributes of its draws. While a thread is in `run()`, the others' calls raise RuntimeError.
    """

    def __init__(self, config: Config | None = None, *, names: Sequence[str] = (), **state: Unpack[DrawState]) -> None:
        self.config = configuration(config)
        self.names = list(names)
        options: dict[str, Any] = dict(state)
        self._machine = _core.Machine(
            self.config, make_state(self.config, options.pop("size", None), **options), self.names
        )

    def push(self, quads: QuadsLike, attributes: npt.ArrayLike | None = None) -> None:
        """Appends quads to the queue, from which `clock()` offers vertices; all of them or, after SnapError, none."""
        self._machine.push(as_quads(quads, attributes))

    def clock(
        self,
        *,
        vertex_valid: bool = True,
        fragment_ready: bool = True,
        reset: bool = False,
        clear_hidden: bool = False,
        flush: bool = False,
    ) -> int:
        """One clock edge; how many fragments left at it.

        vertex_valid: the next vertex of the queue, if there is one, is on offer. fragment_ready: fragments on offer are
        accepted. reset empties the queue. clear_hidden forgets hidden tiles (RuntimeError while busy). flush discards a
        quad of which some vertices were taken and not all.
        """
        try:
            return self._machine.clock(vertex_valid, fragment_ready, reset, clear_hidden, flush)
        except TypeError:  # NumPy's, or none at all: asked for here alone, for this runs in every clock
            inputs = {"vertex_valid": vertex_valid, "fragment_ready": fragment_ready, "reset": reset}
            inputs |= {"clear_hidden": clear_hidden, "flush": flush}
            return self._machine.clock(**{name: flag(name, value) for name, value in inputs.items()})

    def run(self, most_clocks: int = 2**62) -> int:
        """Clocks without gap or stall until idle, or so many; how many it were."""
        return self._machine.run(whole("most_clocks", most_clocks, 0, 2**64 - 1))

    def take(self) -> npt.NDArray[np.void]:
        """Fragments accepted since the last call, in the machine's order; fields as of `draw()`."""
        return as_array(self._machine.take())

    @property
    def on_offer(self) -> npt.NDArray[np.void]:
        """Fragments at the port in this clock, a lane each (`fragment_mask`); none unless `fragment_valid`."""
        return as_array(self._machine.on_offer())

    @property
    def words(self) -> list[str]:
        """The fragments on offer as the digits of `fragment_t`, lane by lane."""
        return self._machine.words()

    @property
    def counters(self) -> dict[str, int]:
        """Performance counters since reset, by their names in the specification."""
        return self._machine.counters()

    @property
    def clocks(self) -> int:
        """Clocks since it was made, or since reset."""
        return self._machine.clocks

    @property
    def waiting(self) -> int:
        """Fragments that `take()` would give."""
        return self._machine.waiting

    @property
    def queued(self) -> int:
        """Vertices of the queue that were not taken."""
        return self._machine.queued

    @property
    def idle(self) -> bool:
        """The queue is empty and nothing is on its way."""
        return self._machine.idle

    @property
    def vertex_ready(self) -> bool:
        """The machine takes a vertex at the next edge."""
        return self._machine.vertex_ready

    @property
    def fragment_valid(self) -> bool:
        """Fragments are on offer."""
        return self._machine.fragment_valid

    @property
    def fragment_mask(self) -> int:
        """Lanes that have a fragment, bit 0 the first."""
        return self._machine.fragment_mask

    @property
    def busy(self) -> bool:
        """The machine has something to do."""
        return self._machine.busy
