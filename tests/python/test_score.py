"""`laterna.score` on files, as other calibrators leave them."""

import math
import pathlib
import tempfile
import unittest

import numpy as np

import laterna
import small_scene


def cameramodel(device, shift_px):
    """mrcal's text of a device whose principal point is shift_px too large."""
    rows = device.device_from_world
    r = rows[:, :3]
    angle = math.acos((np.trace(r) - 1) / 2)
    axis = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / (2 * math.sin(angle))
    rt = [float(x) for x in [*(angle * axis), *rows[:, 3]]]
    k = [float(x) for x in (device.K[0, 0], device.K[1, 1], device.K[0, 2] + shift_px, device.K[1, 2] + shift_px)]
    return f"{{ 'lensmodel': 'LENSMODEL_PINHOLE', 'intrinsics': {k}, 'extrinsics': {rt}, 'imagersize': {list(device.size)} }}\n"


class Score(unittest.TestCase):
    def score(self, shift_px):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "scene.toml").write_text(small_scene.TEXT)
            projector = laterna.load(folder / "scene.toml").projectors[0]
            (folder / "left.cameramodel").write_text(cameramodel(projector, shift_px))
            return laterna.score(folder / "scene.toml", folder / "left.cameramodel")

    def test_the_truth_is_ok_and_nobody_is_to_blame(self):
        found = self.score(0)
        self.assertEqual((found["status"], found["suspects"]), ("ok", []))
        self.assertLess(found["volume_error_px"], 1e-6)  # the text has every digit; the rotation vector rounds

    def test_half_a_pixel_is_named(self):
        found = self.score(0.5)
        self.assertEqual((found["status"], found["suspects"][0]["name"]), ("weak", "half_pixel"))
        self.assertAlmostEqual(found["surface_error_px"], math.sqrt(0.5), places=6)  # half a pixel in u and in v

    def test_a_missing_file_is_one_sentence(self):
        with self.assertRaisesRegex(laterna.InputError, "nowhere.toml"):
            laterna.score("nowhere.toml", "nothing.cameramodel")


if __name__ == "__main__":
    unittest.main()
