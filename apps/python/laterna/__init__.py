"""Laterna: a physical projector-mapping simulator for camera calibration.

    import laterna
    scene = laterna.parse(laterna.new_scene())
    for capture in laterna.capture(scene):
        decoded = laterna.decode(capture.pictures, capture.view.patterns)
        estimate = laterna.calibrate(scene, decoded)
        print(estimate.status, laterna.verify(scene.projectors[0], estimate,
                                              capture.view.points_world[capture.view.lit]).volume.rms)

Lengths are metres, angles radians. Pixels have integer coordinates at their centres: an image of W × H pixels spans
[-0.5, W - 0.5] × [-0.5, H - 0.5], y down. A device's frame is x right, y down, z forward; `b_from_a` takes coordinates in a to
coordinates in b. Errors are in projector pixels.

Pictures are (pictures, height, width), maps (height, width), points (N, 3). Arrays stand in the memory of the value that gives
them, which lives as long as they do; arrays given are read in place, and must be C-contiguous and of the dtype named.

Bad input raises InputError, a ValueError, with one sentence. Sound input that cannot answer is no exception: `status` is then
"refused" or "weak", and `reason` says why. Long calls let other threads run; Ctrl-C ends them between two stages.
"""

from ._laterna import (
    BoardCalibration, Capture, Decoded, Device, ErrorSummary, Estimate, InputError, Mesh, Outcome, Patterns, Scene, Verification,
    View, __version__, calibrate, calibrate_boards, calibrate_points, capture, decode, load, new_scene, parse, roundtrip,
    score, set_thread_count, trace, verify)

__all__ = [
    "BoardCalibration", "Capture", "Decoded", "Device", "ErrorSummary", "Estimate", "InputError", "Mesh", "Outcome", "Patterns",
    "Scene", "Verification", "View", "__version__", "calibrate", "calibrate_boards", "calibrate_points", "capture", "decode", "load",
    "new_scene", "parse", "roundtrip", "score", "set_thread_count", "trace", "verify"]

InputError.__module__ = "laterna"
