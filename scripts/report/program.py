"""The program and the data that belong to these scripts, in a source tree or installed (PREFIX/share/quadrille)."""
import os

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
INSTALLED = not os.path.exists(os.path.join(ROOT, "CMakeLists.txt"))
PROGRAM = os.path.normpath(os.path.join(ROOT, "../../bin/quadrille" if INSTALLED else "build/release/quadrille"))
