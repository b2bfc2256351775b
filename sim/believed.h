// The scene that a solver is told of, beside the one that is rendered.
#pragma once

#include "sim/scene.h"

#include <optional>

namespace laterna {

/// Whether a solver is told of another mesh, or of another placement or intrinsics, than the true ones. Not
/// where Scene::believe_truth.
bool believed_otherwise(const Scene& scene, const Object& object);
bool believed_otherwise(const Scene& scene, const Camera& camera);

/// The object as MeshBelief has it: the believed file's mesh or the object's own; decimated() to `keep`; each
/// vertex moved along its smooth normal by noise_sigma_m times a normal deviate drawn by `seed`; then
///   x_believed = o + translate + Rz·Ry·Rx·scale·(x_world - o),  o the mesh's own origin in the world.
/// Equal positions become one vertex; maps and texture coordinates are gone.
Object believed(const Object& object);

/// The camera's device as CameraBelief has it. Throws InputError where its intrinsics are unusable.
Device believed_device(const Camera& camera);

/// The scene as a solver is told of it: `scene` itself where nothing is believed otherwise; else a copy in
/// `storage`. Projectors are the true ones. A scene whose meshes displacement moves is to be displaced first.
const Scene& believed(const Scene& scene, std::optional<Scene>& storage);

/// What a solver is told of the uncertainty of a camera: the covariance of fx, fy, cx, cy, lens, rotation
/// (small left rotation vector w, rad: R = exp([w]×)·R̂) and translation t (m) of its device_from_world, as
/// a solver's covariance has them, row-major p×p. CameraBelief turns about the camera's centre, x' =
/// exp([w]×)·x + d, so that δt = d + w×t. The lens is taken for certain. Empty where all sigmas are 0, or
/// Scene::believe_truth.
std::vector<double> told_covariance(const Scene& scene, const Camera& camera);

}  // namespace laterna
