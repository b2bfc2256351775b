"""Arrays without copies, both ways, that live as long as they are needed; and what is said of arrays that will not do."""

import gc
import unittest

import numpy as np

import laterna
from laterna import _laterna
from small_scene import scene


def address(array):
    return array.__array_interface__["data"][0]


class Memory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = scene()
        cls.capture = laterna.capture(cls.scene)[0]

    def test_pictures_are_the_captures_own(self):
        self.assertEqual(address(self.capture.pictures), address(self.capture.pictures))
        self.assertEqual(self.capture.pictures.shape, (len(self.capture.view.patterns), 250, 400))
        self.assertEqual(self.capture.pictures.dtype, np.uint8)

    def test_written_in_python_read_in_cpp(self):
        capture = self.capture.view.capture(seed=2)
        self.assertGreater(capture.decode().valid_percent, 10)
        capture.pictures[:] = 7
        self.assertEqual(capture.decode().valid_percent, 0)

    def test_numpys_pictures_are_read_in_place(self):
        mine = self.capture.pictures.copy()
        self.assertEqual(_laterna._address(mine), address(mine))
        self.assertEqual(_laterna._address(mine[3:]), address(mine) + 3 * mine.strides[0])
        mine.flags.writeable = False  # a file mapped into memory, say
        np.testing.assert_array_equal(laterna.decode(mine, self.capture.view.patterns).u_px, self.capture.decode().u_px)

    def test_a_decoded_map_is_what_calibrate_reads(self):
        decoded = self.capture.decode()
        before = laterna.calibrate(self.scene, decoded).correspondences
        self.assertEqual(before, decoded.valid.sum())
        decoded.valid[:125] = 0
        self.assertEqual(laterna.calibrate(self.scene, decoded).correspondences, decoded.valid.sum())
        self.assertLess(decoded.valid.sum(), before)

    def test_arrays_keep_their_memory(self):
        capture = self.capture.view.capture(seed=3)
        pictures, u, points = capture.pictures, capture.decode().u_px, self.capture.view.points_world
        kept = pictures.copy(), u.copy()
        positions = scene().meshes[0].positions
        outcome = laterna.roundtrip(scene())[0].surface_error_px
        del capture
        gc.collect()
        churn = [np.full(pictures.shape, 99, np.uint8) for _ in range(20)]  # would fall into freed memory
        np.testing.assert_array_equal(pictures, kept[0])
        np.testing.assert_array_equal(u, kept[1])
        self.assertEqual(len(churn), 20)
        self.assertTrue(np.isfinite(positions).all() and np.isfinite(outcome).all() and points.shape == (250, 400, 3))

    def test_a_scenes_meshes_are_read_only(self):
        with self.assertRaisesRegex(ValueError, "read-only"):
            self.scene.meshes[0].positions[0] = 0

    def test_ten_bits_are_16_bit_numbers(self):
        deep = laterna.capture(scene(camera__sensor__bit_depth=10))[0].pictures
        self.assertEqual(deep.dtype, np.uint16)
        self.assertGreater(deep.max(), 255)
        self.assertLess(deep.max(), 1024)


class Refused(unittest.TestCase):
    """One sentence each, that names the argument, what was found and what was expected."""

    patterns = laterna.Patterns((320, 200))

    def decode(self, pictures, sentence):
        with self.assertRaises(laterna.InputError) as caught:
            laterna.decode(pictures, self.patterns)
        self.assertEqual(str(caught.exception), sentence)

    def test_dtype(self):
        self.decode(np.zeros((36, 4, 5)), "pictures: dtype float64, expected uint8 or uint16")

    def test_shape(self):
        self.decode(np.zeros((4, 5), np.uint8), "pictures: shape (4, 5), expected (pictures, height, width)")
        self.decode(np.zeros((36, 0, 5), np.uint8), "pictures: shape (36, 0, 5), expected 1 to 16384 each way")

    def test_order_of_memory(self):
        self.decode(np.zeros((5, 4, 36), np.uint8).T, "pictures: the array is not C-contiguous, expected one that is: "
                    "numpy.ascontiguousarray(pictures) makes a copy")

    def test_byte_order(self):
        self.decode(np.zeros((36, 4, 5), ">u2"), "pictures: dtype >u2, expected uint8 or uint16")

    def test_no_array(self):
        self.decode([1, 2], "pictures: found a list, expected a NumPy array of uint8 or uint16, (pictures, height, width)")

    def test_number_of_pictures(self):
        with self.assertRaisesRegex(laterna.InputError, "36"):
            laterna.decode(np.zeros((7, 4, 5), np.uint8), self.patterns)

    def test_points(self):
        device = laterna.Device((640, 480), 500, 500, 320, 240)
        with self.assertRaisesRegex(laterna.InputError, r"^points_world: shape \(3,\), expected \(N, 3\)$"):
            device.project(np.zeros(3))
        with self.assertRaisesRegex(laterna.InputError, r"^depths_m: shape \(2,\), expected \(N,\), a depth for each of the pixels$"):
            device.unproject(np.zeros((3, 2)), np.ones(2))


if __name__ == "__main__":
    unittest.main()
