// The truth of one view as a picture of many layers.
#pragma once

#include "apps/lab/simulation.h"

#include <filesystem>

namespace laterna {

/// One layer each, float: projector.u, projector.v (px, NaN where the point is behind the projector or
/// nothing is seen), projector.lit (1 or 0), depth.m (axial, NaN where nothing is seen), normal.x, .y, .z
/// (world), world.x, .y, .z (m), object.id (-1: none). Of the point at each pixel's centre; traced in strips,
/// so that nothing of the image's size is held but the picture itself. The header carries the camera
/// (sim/formats/exr_camera.h).
void write_truth(const std::filesystem::path& path, const Scene& scene, const SceneRays& rig, int camera,
                 int projector);

}  // namespace laterna
