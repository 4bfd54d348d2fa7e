"""One pixel."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from . import _core
from ._core import Config, Explanation
from ._draw import DrawState, state_of
from ._inputs import QuadsLike, as_quads, configuration, wholes

if TYPE_CHECKING:
    from typing_extensions import Unpack


def explain(
    quads: QuadsLike,
    pixel: tuple[int, int],
    attributes: npt.ArrayLike | None = None,
    *,
    config: Config | None = None,
    names: Sequence[str] | None = None,
    **state: Unpack[DrawState],
) -> list[Explanation]:
    """Every quad at a pixel (x, y): print() shows each stage with its numbers, exact values, errors and bounds.

    `Explanation.json()` has all of it as a text, `explanation_stages()` the numbers of a stage.
    """
    config = configuration(config)
    given = as_quads(quads, attributes, names=names)
    return _core.explain(given, config, state_of(given, config, state), *wholes("pixel", pixel, "x, y"))


def explanation_stages(explanation: Explanation) -> dict[str, dict[str, dict[str, Any]]]:
    """Of each stage its numbers by name, such as stages["weight"]["M0"]["value"], with unit, exact, error_ulp."""
    stages = json.loads(explanation.json())["stages"]
    return {stage["name"]: {number["name"]: number for number in stage["numbers"]} for stage in stages}


def explanation_page(explanations: Sequence[Explanation], title: str = "One pixel") -> str:
    """A self-contained page of HTML."""
    return _core.explain_html(list(explanations), title)
