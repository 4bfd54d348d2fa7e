"""A quad rasterizer with mean value coordinates: the machine's bit-accurate models and exact references, as NumPy arrays.

    import quadrille
    quads = quadrille.load_mesh("mesh.obj", attributes="uv")   # an automatic camera
    fragments = quadrille.draw(quads)                         # the bits of the RTL
    fragments["u"], fragments["v"], fragments["u_code"]

Quads are in window coordinates: x, y in pixels with y down and pixel centres at +0.5, window z in [0, 1], all three
multiplied by w. Sizes are (width, height) in pixels. Bad input raises a ValueError with the words of the program
`quadrille`: ConfigError, DrawStateError, SnapError, InputError or UsageError.
"""

from ._core import (
    Camera,
    Config,
    ConfigError,
    DrawStateError,
    Explanation,
    InputError,
    Mesh,
    Quads,
    SnapError,
    UsageError,
    version as __version__,
)
from ._draw import draw, fragment_names, method, paper, picture, port_value, snap, truth
from ._explain import explain, explanation_page, explanation_stages
from ._inputs import (
    as_quads,
    corner,
    corners,
    load_mesh,
    load_quads,
    methods,
    pick,
    project,
    save_quads,
    scene,
    scenes,
    stress,
    stress_families,
)
from ._machine import Machine
from ._ports import fragments_of_words, state_word, vertex_words
from ._sweep import error_map, sweep, sweep_columns

__all__ = [
    "Camera",
    "Config",
    "ConfigError",
    "DrawStateError",
    "Explanation",
    "InputError",
    "Machine",
    "Mesh",
    "Quads",
    "SnapError",
    "UsageError",
    "__version__",
    "as_quads",
    "corner",
    "corners",
    "draw",
    "error_map",
    "explain",
    "explanation_page",
    "explanation_stages",
    "fragment_names",
    "fragments_of_words",
    "load_mesh",
    "load_quads",
    "method",
    "methods",
    "paper",
    "pick",
    "picture",
    "port_value",
    "project",
    "save_quads",
    "scene",
    "scenes",
    "snap",
    "state_word",
    "stress",
    "stress_families",
    "sweep",
    "sweep_columns",
    "truth",
    "vertex_words",
]
