"""A scene that is quick: what the tests of this folder share."""

import laterna

TEXT = """
[[mesh]]
shape = "relief"
shape_size = [1.6, 1.0, 0.7]
[[projector]]
name = "left"
size = [320, 200]
throw_ratio = 1.2
position = [0.35, -0.1, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [400, 250]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
"""


def scene(**changes):
    """The scene with overrides: `__` stands for a dot."""
    return laterna.parse(TEXT, overrides={key.replace("__", "."): value for key, value in changes.items()})
