#!/usr/bin/python3
"""A round trip, stage by stage, with a map of the error.

    round_trip.py [SCENE.toml] [--map error.npy]

Plays patterns through a scene, decodes the pictures, recovers the projector from them alone, and compares it with the true one at
every point that the camera sees lit. With matplotlib installed, --map error.png draws the map.
"""

import argparse

import numpy as np

import laterna


def error_map_px(truth, estimate, view):
    """(height, width): distance of the recovered from the true projector pixel; NaN where nothing is lit."""
    points = np.ascontiguousarray(view.points_world[view.lit])
    error = np.full(view.lit.shape, np.nan)
    error[view.lit] = np.linalg.norm((estimate.project(points) - truth.project(points))[:, :2], axis=1)
    return error


def draw(path, error):
    if not path.endswith(".png"):
        np.save(path, error)
        return
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots()
    figure.colorbar(axes.imshow(error), label="error, projector px")
    figure.savefig(path)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("scene", nargs="?", help="without it: the scene of `laterna new`")
    arguments.add_argument("--map", help="file for the map, .npy or .png")
    given = arguments.parse_args()

    scene = laterna.load(given.scene) if given.scene else laterna.parse(laterna.new_scene())
    capture = laterna.capture(scene)[0]
    decoded = laterna.decode(capture.pictures, capture.view.patterns)
    estimate = laterna.calibrate(scene, decoded, capture.view.projector)
    print(f"pictures {capture.pictures.shape} {capture.pictures.dtype}, {decoded.valid_percent:.1f} % of the pixels decoded")
    print(f"status {estimate.status} {estimate.reason}")
    if estimate.device is None:
        raise SystemExit(3)

    truth = next(p for p in scene.projectors if p.name == capture.view.projector)
    for name, value in (("true", truth), ("recovered", estimate.device)):
        print(f"{name:<10} fx {value.K[0, 0]:.3f}  fy {value.K[1, 1]:.3f}  cx {value.K[0, 2]:.3f}  cy {value.K[1, 2]:.3f}")
    error = error_map_px(truth, estimate.device, capture.view)
    found = laterna.verify(truth, estimate, capture.view.points_world[capture.view.lit])
    print(f"surface error {found.surface.rms:.4f} px rms, {np.nanmax(error):.4f} px at most; predicted {found.surface.predicted_rms:.4f}")
    print(f"volume error {found.volume.rms:.4f} px rms; predicted {found.volume.predicted_rms:.4f}")
    if given.map:
        draw(given.map, error)

    # The map is the verification's own figure, point by point.
    assert np.isclose(np.sqrt(np.nanmean(error ** 2)), found.surface.rms, rtol=1e-6)
    # Five sigmas of what noise predicts: the volume error is one draw of a chi with a handful of degrees of freedom.
    assert found.volume.rms < 5 * found.volume.predicted_rms


if __name__ == "__main__":
    main()
