"""Recovers a projector through the installed module. Argument: where it was installed to."""

import pathlib
import sys
import tempfile

import laterna

prefix = pathlib.Path(sys.argv[1]).resolve()
assert pathlib.Path(laterna.__file__).resolve().is_relative_to(prefix), laterna.__file__
scene = laterna.parse(laterna.new_scene(), overrides={"projector.size": [320, 200], "camera.size": [400, 250]})
outcome = laterna.roundtrip(scene)[0]
print(outcome.status, outcome.verification.volume.rms)
assert outcome.status in ("ok", "weak"), outcome.reason

# The programs and modules for meshes and pictures are found from the installed package too.
with tempfile.TemporaryDirectory() as folder:
    pathlib.Path(folder, "tetrahedron.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nf 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1\n")
    pathlib.Path(folder, "grey.pgm").write_bytes(b"P5 2 2 255 " + bytes([10, 20, 30, 40]))
    read = laterna.parse('[[mesh]]\nfile = "tetrahedron.obj"\nalbedo_map = "grey.pgm"\n', folder)
    assert read.meshes[0].triangles.shape == (4, 3)
