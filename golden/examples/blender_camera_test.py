#!/usr/bin/env python3
"""blender_camera.py under a stand-in for Blender's module, and what the program draws with the file.

  golden/examples/blender_camera_test.py build/release/quadrille
"""
import csv
import io
import json
import runpy
import subprocess
import sys
import tempfile
import types
import unittest
from pathlib import Path
from unittest import mock

QUADRILLE = None
SCRIPT = Path(__file__).resolve().parent / "blender_camera.py"


def blender(matrix_world, projection):
    """As much of bpy as the script asks for."""
    lens = types.SimpleNamespace(clip_start=0.5, clip_end=50)

    def calc_matrix_camera(depsgraph, x, y):
        assert (depsgraph, x, y) == ("depsgraph", 640, 480)
        return projection

    camera = types.SimpleNamespace(matrix_world=matrix_world, data=lens, calc_matrix_camera=calc_matrix_camera)
    scene = types.SimpleNamespace(camera=camera, render=types.SimpleNamespace(resolution_x=640, resolution_y=480))
    context = types.SimpleNamespace(scene=scene, evaluated_depsgraph_get=lambda: "depsgraph")
    return types.SimpleNamespace(context=context)


class Camera(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def test_a_camera_from_the_front(self):
        # At (1, -4, 3), looking along +y with z up: rows of (right, up, back, place).
        world = [[1, 0, 0, 1], [0, 0, -1, -4], [0, 1, 0, 3], [0, 0, 0, 1]]
        projection = [[1.5, 0, 0, 0], [0, 2, 0, 0], [0, 0, -1, -1], [0, 0, -1, 0]]
        path = self.folder / "camera.json"
        with mock.patch.dict(sys.modules, bpy=blender(world, projection)), mock.patch.object(sys, "argv", ["blender", "--", str(path)]):
            runpy.run_path(str(SCRIPT))
        camera = json.loads(path.read_text())
        # In the space of an export, where Blender's (x, y, z) is (x, z, -y).
        self.assertEqual(camera["eye"], [1, 3, 4])
        self.assertEqual(camera["target"], [1, 3, 3])
        self.assertEqual(camera["up"], [0, 1, 0])
        self.assertEqual((camera["near"], camera["far"]), (0.5, 50))
        self.assertAlmostEqual(camera["fovy"], 53.13010235)
        # A square of side 2 in front of it, at distance 4: half of it is 1 / 4 · 2 · 50 = 25 pixels.
        mesh = self.folder / "square.obj"
        mesh.write_text("v 0 2 0\nv 2 2 0\nv 2 4 0\nv 0 4 0\nf 1 2 3 4\n")
        done = subprocess.run([QUADRILLE, "fragments", "--mesh", mesh, "--camera", path, "--size", "100x100", "--quiet", "--out", "-"],
                              capture_output=True, text=True, check=True)
        rows = list(csv.DictReader(io.StringIO(done.stdout)))
        for axis in "xy":
            self.assertEqual({int(row[axis]) for row in rows}, set(range(25, 75)))
        self.assertEqual({row["front"] for row in rows}, {"1"})


if __name__ == "__main__":
    QUADRILLE = str(Path(sys.argv.pop()).resolve())
    unittest.main()
