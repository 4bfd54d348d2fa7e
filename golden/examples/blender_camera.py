"""Blender: its camera for `quadrille render --camera`, in the space of an exported mesh.

  blender scene.blend --background --python blender_camera.py -- camera.json
"""
import json
import math
import sys

import bpy

Y_UP = True  # as OBJ and glTF are exported; False for PLY, and where Z was chosen as up
scene, render = bpy.context.scene, bpy.context.scene.render
size = {"x": render.resolution_x, "y": render.resolution_y}
lens = scene.camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), **size)
_, up, back, eye = ([row[i] for row in scene.camera.matrix_world][:3] for i in range(4))
places = {"eye": eye, "target": [e - b for e, b in zip(eye, back)], "up": up}
camera = {name: [v[0], v[2], -v[1]] if Y_UP else v for name, v in places.items()}
camera |= {"fovy": math.degrees(2 * math.atan(1 / lens[1][1]))}
camera |= {"near": scene.camera.data.clip_start, "far": scene.camera.data.clip_end}
json.dump(camera, open(sys.argv[-1], "w", encoding="utf-8"))
