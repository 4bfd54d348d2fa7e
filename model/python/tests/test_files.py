"""Own files: an OBJ to an array of u, v, cameras, .quads."""

import base64
import copy
import json
import pickle
import struct

import numpy as np
import pytest

import quadrille

MESH = """# a tilted square and a triangle beside it
v -1 -1 0
v 1 -1 0
v 1 1 -1
v -1 1 -1
v 3 0 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1 2/2 3/3 4/4
f 2/2 5/1 3/3
"""


def test_own_mesh_in_five_lines(tmp_path):
    path = tmp_path / "mesh.obj"
    path.write_text(MESH)
    quads = quadrille.load_mesh(path)
    fragments = quadrille.draw(quads)
    uv = np.stack([fragments["u"], fragments["v"]], axis=1)
    assert uv.shape == (len(fragments), 2) and len(uv) > 20000 and uv.min() >= 0 and uv.max() <= 1
    assert set(fragments["quad"]) == {0, 1} and quads.size == (512, 512) and quads.names == ["u", "v"]
    assert quads.corners[0].tolist() == [[-1, -1, 0], [1, -1, 0], [1, 1, -1], [-1, 1, -1]]
    true = quadrille.truth(quads)
    assert len(true) == len(fragments)
    in_order = np.lexsort((fragments["x"], fragments["y"], fragments["quad"]))
    assert np.abs(uv[in_order, 0] - true["u"]).max() <= quadrille.Config().bounds()["attribute"]


PLY = """ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
property float u
property float v
element face 2
property list uchar int vertex_indices
end_header
-1 -1 0 0 0
1 -1 0 1 0
1 1 -1 1 1
-1 1 -1 0 1
3 0 0 0 0
4 0 1 2 3
3 1 4 2
"""


def gltf():
    """The same as three triangles, where v counts from the top."""
    points = [-1, -1, 0, 1, -1, 0, 1, 1, -1, -1, 1, -1, 3, 0, 0]
    data = struct.pack("<15f10f9H", *points, *[0, 1, 1, 1, 1, 0, 0, 0, 0, 1], *[0, 1, 2, 0, 2, 3, 1, 4, 2])
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
        "buffers": [{"byteLength": len(data), "uri": uri}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in [(0, 60), (60, 40), (100, 18)]
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3", "min": [-1, -1, -1], "max": [3, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 5, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 9, "type": "SCALAR"},
        ],
    }


def test_other_formats(tmp_path):
    """A PLY or glTF in five lines: the fragments are those of the OBJ file, whose numbers are few bits long."""
    (tmp_path / "m.obj").write_text(MESH)
    (tmp_path / "m.ply").write_text(PLY)
    (tmp_path / "m.gltf").write_text(json.dumps(gltf()))
    expected = quadrille.draw(quadrille.load_mesh(tmp_path / "m.obj"))
    for name, pairs in [("m.ply", False), ("m.gltf", True)]:
        quads = quadrille.load_mesh(tmp_path / name, merge_pairs=pairs)
        fragments = quadrille.draw(quads)
        uv = np.stack([fragments["u"], fragments["v"]], axis=1)
        assert len(quads) == 2 and len(uv) == len(expected) > 20000
        assert np.array_equal(fragments, expected)
    assert quads.notes == ["--merge-pairs: 3 triangles became 1 quads, 1 stayed triangles"]
    triangles = quadrille.load_mesh(tmp_path / "m.gltf")
    assert len(triangles) == 3 and "merge_pairs=True" in triangles.notes[0]
    (tmp_path / "bad.ply").write_text(PLY.replace("4 0 1 2 3", "4 0 1 2 9"))
    with pytest.raises(quadrille.InputError, match="bad.ply: assimp says: "):
        quadrille.load_mesh(tmp_path / "bad.ply")


def test_cameras(tmp_path):
    mesh = quadrille.Mesh.parse(MESH, "mesh")
    assert len(mesh.faces) == 2 and mesh.faces[0] == (0, 1, 2, 3) and mesh.positions.shape == (5, 3)
    camera = {"eye": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0], "fovy": 40, "near": 1, "far": 9}
    path = tmp_path / "camera.json"
    path.write_text(json.dumps(camera))
    loaded, made = quadrille.Camera.load(path), quadrille.Camera(**camera)
    assert loaded.text() == made.text() and loaded.eye == [0, 0, 4]
    a = quadrille.project(mesh, (64, 48), camera=loaded)
    (tmp_path / "mesh.obj").write_text(MESH)
    b = quadrille.load_mesh(tmp_path / "mesh.obj", (64, 48), camera=path)
    assert np.array_equal(a.vertices, b.vertices)
    # By hand: perspective of 40 degrees, aspect 4/3, clip space to window.
    f = 1 / np.tan(np.radians(20))
    x, y, z, w = a.vertices[0, 0]
    assert (
        w == pytest.approx(4)
        and x / w == pytest.approx((1 - f * 0.75 / 4) * 32)
        and y / w == pytest.approx((1 + f / 4) * 24)
    )
    assert z / w == pytest.approx((1 + (10 / 8 - 2 * 9 / 8 / 4)) / 2)
    path.write_text('{"eye": [0, 0, 4],\n "fovy": 200}')
    with pytest.raises(quadrille.InputError, match="camera.json"):
        quadrille.Camera.load(path)
    front = quadrille.project(mesh, attributes="uv_normal", view_from=(0, 0, 1))
    assert front.names == ["u", "v", "nx", "ny", "nz"] and np.allclose(
        front.attributes[0, 0, 2:], [0, np.sqrt(0.2), np.sqrt(0.8)], atol=0.2
    )


def test_pickle_and_copies(tmp_path):
    path = tmp_path / "mesh.obj"
    path.write_text(MESH)
    camera = quadrille.Camera(eye=(0, 1, 4), fovy=30)
    mine = quadrille.as_quads(quadrille.load_mesh(path, (64, 48), camera=camera), ids=[7, 5])
    matrix = quadrille.Camera(matrix=list(range(16)))
    culled = next(q for q in map(quadrille.scene, (s["name"] for s in quadrille.scenes(True))) if q.cull != "none")
    for quads in (mine, culled, quadrille.stress("any_w", 3, attributes=0), quadrille.scene("bowtie").pick([])):
        for again in (pickle.loads(pickle.dumps(quads)), copy.deepcopy(quads)):
            for what in ("vertices", "attributes", "ids", "corners"):
                assert np.array_equal(getattr(again, what), getattr(quads, what)), what
            for what in ("name", "names", "notes", "size", "perspective", "cull"):
                assert getattr(again, what) == getattr(quads, what), what
            assert len(quads) == 0 or quadrille.draw(again).tobytes() == quadrille.draw(quads).tobytes()
    assert mine.name == "mesh.obj" and repr(mine) == "<2 quads of mesh.obj, 2 attributes of u, v>"
    assert repr(mine.pick([0])) == "<1 quad of mesh.obj, 2 attributes of u, v>"
    for one in (camera, matrix):
        assert pickle.loads(pickle.dumps(one)).text() == one.text()


def test_fragments_as_files_and_colours(tmp_path):
    fragments = quadrille.draw(quadrille.scene("bowtie", (64, 64)), names=["u", "v_code"], weights=True)
    np.save(tmp_path / "f.npy", fragments)
    again = np.load(tmp_path / "f.npy")
    assert again.dtype.names == fragments.dtype.names
    assert all(np.array_equal(again[name], fragments[name]) for name in again.dtype.names)
    assert quadrille.fragment_names(fragments) == ["u", "v_code"]
    coloured = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 0.5 0.25 1\nf 1 2 3 4\n"
    mesh = quadrille.Mesh.parse(coloured)
    assert quadrille.project(mesh, attributes="colour").attributes[0].tolist() == [
        [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.25, 1]
    ]  # fmt: skip
    (tmp_path / "partly.obj").write_text(coloured.replace(" 0.5 0.25 1", ""))
    assert "3 of 4 vertices have a colour" in quadrille.load_mesh(tmp_path / "partly.obj").notes[0]
    with pytest.raises(quadrille.InputError, match="partly.obj: the mesh has no colours"):
        quadrille.load_mesh(tmp_path / "partly.obj", attributes="colour")


def test_matrix_of_a_camera():
    square = quadrille.Mesh.parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    camera = quadrille.Camera(matrix=np.eye(4))
    assert camera.matrix == np.eye(4).ravel().tolist() and quadrille.Camera().matrix is None
    # The clip square (0, 0) to (1, 1) is the window's upper right quarter.
    assert quadrille.project(square, (8, 8), camera=camera).vertices[0, :, :2].tolist() == [[4, 4], [8, 4], [8, 0], [4, 0]]
    for matrix in (np.eye(3), "x" * 16, [1] * 15):
        with pytest.raises(ValueError, match="matrix: 16 numbers"):
            quadrille.Camera(matrix=matrix)
    with pytest.raises(ValueError, match="matrix: eye, target"):
        quadrille.Camera(matrix=np.eye(4), near=1)


def test_quads_files(tmp_path):
    quads = quadrille.stress("any_w", 20, attributes=3)
    quadrille.save_quads(tmp_path / "a.quads", quads)
    again = quadrille.load_quads(tmp_path / "a.quads")
    assert np.array_equal(again.vertices, quads.vertices) and np.array_equal(again.attributes, quads.attributes)
    assert again.names == ["a0", "a1", "a2"]
    named = quadrille.scene("bowtie")
    quadrille.save_quads(tmp_path / "named.quads", named)
    assert quadrille.load_quads(tmp_path / "named.quads").names == named.names == ["u", "v"]
    (tmp_path / "b.quads").write_text("1 2 3\n")
    with pytest.raises(quadrille.InputError, match="b.quads:1: "):
        quadrille.load_quads(tmp_path / "b.quads")
