"""The examples of README.md run as they stand, one after the other."""

import pathlib
import re

README = pathlib.Path(__file__).resolve().parent.parent / "README.md"
MESH = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"


def test_examples(tmp_path, monkeypatch):
    examples = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert len(examples) >= 3 and len(examples[0].splitlines()) <= 5
    (tmp_path / "mesh.obj").write_text(MESH)
    monkeypatch.chdir(tmp_path)
    known = {}
    exec(compile("\n".join(examples), str(README), "exec"), known)
    assert len(known["uv"]) > 10000 and len(known["drawn"]) == len(known["exact"]) > 500 and len(known["table"]) == 5
