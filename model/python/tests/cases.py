"""Draws that the program and the package must do alike: each as arguments of `quadrille fragments` and as calls.

The same list serves kept.py, which asks the program, and test_same_bits.py, which asks the package.
"""

import hashlib

SIZE = (64, 48)
METHODS = "mvc split02 split13 triangle twofold projective bilinear refine adaptive hybrid affine".split()
FIGURES = """fig1_flat fig6_cuts fig1_turned fig7_floor fig10_convex fig10_concave fig10_crossed bowtie fig8_behind""".split()
CONFIGS = {
    "s12": {"significand_bits": 12},
    "wide": {"significand_bits": 24, "attribute_slots": 8, "tile_log2": 4, "pixels_per_clock": 2},
    "narrow": {
        "significand_bits": 9,
        "subpixel_bits": 4,
        "quadratic_frac_bits": 8,
        "align_guard_bits": 0,
        "attribute_slots": 1,
    },
    "fine": {"attribute_frac_bits": 30, "attribute_int_bits": 9, "depth_bits": 16},
}
STATES = {
    "scissor": {"scissor": (5, 7, 51, 40)},
    "flat": {"perspective": False, "depth": False},
    "back": {"cull": "back", "znear": 0.25, "zfar": 0.75},
}


def cases(scenes, families, corners):
    """[(name, what is drawn, keywords of the engine, configuration, draw state)] of all of these names."""
    inputs = [("scene", name) for name in scenes] + [("stress", name) for name in families]
    made = [
        (f"{kind} {name}", (kind, name), {"engine": "model"}, {}, {})
        for kind, name in inputs + [("corner", name) for name in corners]
    ]
    for engine in ("truth", "float", "fp32"):
        made += [(f"{engine} {kind} {name}", (kind, name), {"engine": engine}, {}, {}) for kind, name in inputs]
    made += [
        (f"{engine} as given {name}", ("stress", name), {"engine": engine, "snap": False}, {}, {})
        for engine in ("truth", "float")
        for name in families
    ]
    made += [
        (f"{label} {kind} {name}", (kind, name), {"engine": "model"}, config, {})
        for label, config in CONFIGS.items()
        for kind, name in inputs
        if kind == "stress" or name == "sphere"
    ]
    made += [
        (f"{label} {engine} {kind} {name}", (kind, name), {"engine": engine}, {}, state)
        for label, state in STATES.items()
        for engine in ("model", "truth")
        for kind, name in inputs
        if kind == "stress" or name == "sphere"
    ]
    made += [
        (f"{method} {name}", ("scene", name), {"method": method}, {}, {}) for method in METHODS for name in FIGURES
    ]
    return made


def arguments(case):
    """Of `quadrille fragments`."""
    _, (kind, name), engine, config, state = case
    words = [f"--{kind}", name, "--size", f"{SIZE[0]}x{SIZE[1]}"]
    words += ["--shade", "uv"] if kind == "scene" else []
    words += ["--count", "8", "--seed", "3"] if kind == "stress" else []
    words += ["--method", engine["method"]] if "method" in engine else ["--engine", engine["engine"]]
    words += ["--snap", "off"] if engine.get("snap") is False else []
    for key, value in config.items():
        words += ["--set", f"{key}={value}"]
    for key, value in state.items():
        if value is False:
            words.append(f"--no-{key}")
        else:
            words += [f"--{key}", ",".join(map(str, value)) if isinstance(value, tuple) else str(value)]
    return words


def fragments(case):
    """The package's."""
    import quadrille

    _, (kind, name), engine, keys, state = case
    config = quadrille.Config(**keys)
    if kind == "scene":
        quads = quadrille.scene(name, SIZE)
    elif kind == "stress":
        quads = quadrille.stress(name, 8, seed=3, size=SIZE)
    else:
        quads = quadrille.corner(name, config, size=SIZE)
    if "method" in engine:
        return quadrille.method(engine["method"], quads, **state)
    if engine["engine"] == "model":
        return quadrille.draw(quads, config=config, weights=True, **state)
    draw = {"truth": quadrille.truth, "float": quadrille.paper, "fp32": quadrille.paper}[engine["engine"]]
    single = {"single": True} if engine["engine"] == "fp32" else {}
    return draw(quads, config=config, snapped=engine.get("snap", True), **single, **state)


def digest(rows):
    return hashlib.sha256(rows.encode()).hexdigest()[:16]


def rows(table):
    """Lines of the program's table, without its head, of a structured array."""
    import numpy as np

    order = np.lexsort((table["x"], table["y"], table["quad"]))
    attributes = [
        name
        for name in table.dtype.names
        if name not in ("quad", "x", "y", "front", "flags", "depth", "l0", "l1", "l2", "l3")
        and not name.endswith("_code")
    ]
    columns = [table[name][order].tolist() for name in ("quad", "x", "y", "front", "flags")]
    reals = [
        table[name][order] if name in table.dtype.names else np.full(len(table), np.nan)
        for name in ("l0", "l1", "l2", "l3", "depth", *attributes)
    ]
    text = "%d,%d,%d,%d,%d" + ",%.17g" * len(reals)
    return "".join((text % values).replace("nan", "") + "\n" for values in zip(*columns, *(r.tolist() for r in reals)))
