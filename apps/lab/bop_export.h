// A simulated capture as a scene of BOP's, and a scene of BOP's as truth layers.
#pragma once

#include "sim/formats/bop_models.h"
#include "sim/formats/bop_scene.h"

#include <filesystem>

namespace laterna {

/// What a capture folder's scene becomes (a dataset's sample is one too).
struct BopScene {
  std::vector<BopPicture> pictures;  ///< one for each camera
  std::vector<BopModel> models;      ///< one for each mesh
};

/// Traced anew: axial depth at pixel centres, a silhouette of each mesh as if it stood there alone (its
/// extent counts up to a picture beyond each edge), and what is seen of it; obj_id is the mesh's place in the
/// scene, from 1. gray is each pixel's brightest value over the camera's first sequence, in 8 bits. A model
/// is the mesh as the rays meet it (displaced), in its own frame where that stands by a rigid motion; else in
/// the world's, which a note says. Throws InputError where the folder has no scene, or a camera has a lens.
BopScene bop_scene(const std::filesystem::path& capture, Notes& notes);

/// A new folder, whole or not at all, with CAMERA.exr for each picture: layers depth.m (NaN: none) and
/// object.id (obj_id - 1 where the object is seen, -1: none) as a capture's truth has them, and the camera in
/// its header.
void write_bop_layers(const std::filesystem::path& to, const std::vector<BopPicture>& pictures);

}  // namespace laterna
