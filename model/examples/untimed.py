#!/usr/bin/env python3
"""Draws the quads of a file with the untimed model: untimed.py LIBQUADRILLE.SO FILE. Input and output as of untimed.cpp."""
import ctypes
import sys

import numpy as np

VERTEX = np.dtype([("position", "f8", 4), ("attribute", "f8", 8)])
FRAGMENT = np.dtype([("quad", "u4"), ("x", "u2"), ("y", "u2"), ("front", "u1"), ("flags", "u1"), ("reserved", "u2"), ("depth", "u4"),
                     ("attribute", "i8", 8)])
STATE = np.dtype([("size", "u4"), ("viewport", "i4", 2), ("scissor", "i4", 4), ("cull", "i4"), ("perspective", "i4"), ("depth", "i4"),
                  ("attributes", "i4"), ("skip", "u4"), ("znear", "f8"), ("zfar", "f8")])

library = ctypes.CDLL(sys.argv[1])
library.quadrille_last_error.restype = ctypes.c_char_p
assert library.quadrille_abi() == 2


def call(name, *arguments):
    if getattr(library, name)(*arguments) != 0:
        sys.exit(library.quadrille_last_error().decode())


machine, count, state = ctypes.c_void_p(), ctypes.c_size_t(), np.zeros((), STATE)
call("quadrille_untimed_create", b"significand_bits = 18", ctypes.byref(machine))
call("quadrille_draw_state_init", ctypes.c_void_p(state.ctypes.data), ctypes.c_size_t(STATE.itemsize), 64, 64)
call("quadrille_untimed_set_state", machine, ctypes.c_void_p(state.ctypes.data))

numbers = np.loadtxt(sys.argv[2], ndmin=2)
vertices = np.zeros((len(numbers), 4), VERTEX)
vertices["position"] = numbers[:, :16].reshape(-1, 4, 4)
vertices["attribute"][..., :4] = numbers[:, 16:].reshape(-1, 4, 4)
call("quadrille_untimed_draw", machine, 0, ctypes.c_void_p(vertices.ctypes.data), ctypes.c_size_t(len(vertices)))

call("quadrille_untimed_pending", machine, ctypes.byref(count))
fragments = np.zeros(count.value, FRAGMENT)
call("quadrille_untimed_take", machine, ctypes.c_void_p(fragments.ctypes.data), count, ctypes.byref(count))
for f in fragments:
    print(*f[["quad", "x", "y", "front", "flags", "depth"]], *f["attribute"][:4])
library.quadrille_untimed_destroy(machine)
