#!/usr/bin/python3
"""How noise and exposure move the error, beside what the solver predicts without knowing the truth.

    noise_sweep.py

Each row is a round trip on some seeds: root mean square of the volume errors, and of the predictions.
"""

import numpy as np

import laterna

SEEDS = range(1, 5)
SMALL = {  # a small scene is enough to see the law, and quick
    "projector.size": [640, 400], "camera.size": [480, 300],
    "projector.lookup": "bilinear",  # panel pixels as boxes would leave rounding that no noise moves
    "patterns.kind": "gray_phase", "patterns.pitch_px": 16.0, "patterns.steps": 4}


def errors_px(scene):
    """(seeds, 2): volume error and its prediction."""
    rows = []
    for seed in SEEDS:
        outcome = laterna.roundtrip(scene, seed=seed)[0]
        assert outcome.status != "refused", outcome.reason
        rows.append((outcome.verification.volume.rms, outcome.verification.volume.predicted_rms))
    return np.array(rows)


def table(title, changes):
    print(f"{title:<28}{'error px':>12}{'predicted':>12}{'ratio':>8}")
    base = laterna.parse(laterna.new_scene()).changed(SMALL)
    ratios, predictions = [], []
    for label, change in changes:
        error, predicted = np.sqrt(np.mean(errors_px(base.changed(change)) ** 2, axis=0))
        print(f"{label:<28}{error:>12.5f}{predicted:>12.5f}{error / predicted:>8.2f}")
        ratios.append(error / predicted)
        predictions.append(predicted)
    return np.array(ratios), np.array(predictions)


def main():
    noise, predicted = table("noise, DN of 8 bits", [(f"{s:g}", {"camera.sensor.noise_sigma_dn": s}) for s in (0.5, 2.0, 4.0)])
    exposure, _ = table("exposure, EMVA 1288 camera", [
        (f"full scale at {s:g} cd/m²", {"camera.sensor.kind": "emva1288", "camera.sensor.noise_sigma_dn": 0.0,
                                        "camera.sensor.saturation_cd_per_m2": s})
        for s in (400.0, 1600.0, 6400.0)])
    # An error is a draw with a few degrees of freedom; four of them scatter by less than a factor of three above an honest
    # prediction. The prediction counts neighbouring pixels as one where they may err together: it may be some times too large.
    for ratio in (*noise, *exposure):
        assert 0.1 < ratio < 3
    # Eight times the noise, beside the rounding of 8 bits (0.29 DN), must show.
    assert predicted[-1] > 2 * predicted[0]


if __name__ == "__main__":
    main()
