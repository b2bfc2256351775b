// A scene of BOP's: a folder of cameras, depth pictures and masks of objects.
//
//   scene_camera.json              a camera for each picture (bop.h), with its depth_scale
//   scene_gt.json                  {"0": [{"obj_id": 1, "cam_R_m2c": [9], "cam_t_m2c": [3]}, ...], ...}
//   scene_gt_info.json             how much of each object is seen (bop_info.h)
//   gray/000000.png                what the camera took (rgb/ in others' folders: not read)
//   depth/000000.png               16 bits: millimetres along the camera's axis / depth_scale; 0: none
//   mask/000000_000000.png         picture and place in scene_gt.json's list: 255 on the object's whole
//                                  silhouette, as if it stood there alone, else 0
//   mask_visib/000000_000000.png   255 where the object is seen, else 0
//
// There: x_camera = cam_R_m2c·x_model + cam_t_m2c, in millimetres; here metres. Axes and pixel centres are
// alike (bop.h): pixel (u, v) of a picture is the ray through whole numbers u, v of K. Models (models/) are
// not read or written. https://github.com/thodan/bop_toolkit/blob/master/docs/bop_datasets_format.md
#pragma once

#include "sim/formats/bop_info.h"
#include "sim/formats/parts.h"
#include "sim/image.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace laterna {

struct BopObject {
  int obj_id = 1;                           ///< from 1, as BOP's models are counted
  Rigid camera_from_model;                  ///< metres
  Image<std::uint8_t> silhouette, visible;  ///< 255 or 0; empty: none
  std::optional<BopExtent> whole{};  ///< the silhouette and what of it falls outside the picture; none:
                                     ///< the silhouette alone
};

struct BopPicture {
  Device camera;
  Image<float> depth_m{};      ///< axial, metres; NaN: none. Empty: no depth picture
  Image<std::uint8_t> gray{};  ///< empty: none
  std::vector<BopObject> objects{};
};

/// Whether a folder has a scene_camera.json.
bool is_bop_scene(const std::filesystem::path& folder);

/// The cameras alone, named by "name" or by their picture; a size that the file does not say is that of the
/// picture in depth/, gray/ or rgb/, or stays 0 where there is none.
Rig read_bop_cameras(const std::filesystem::path& folder);

/// All of it, by the pictures' numbers. Throws InputError, naming file and key, for pictures of another size
/// than their camera's, depth of other than 16 bits, masks of other than 8, and a depth_scale that is not
/// above 0.
std::vector<BopPicture> read_bop_scene(const std::filesystem::path& folder);

/// Fills a folder with pictures 0, 1, ... Depth is in the finest of 0.1, 1, 10, ... mm that reaches the
/// farthest pixel in 16 bits, so that it is kept within half of that. scene_gt_info.json is left out where an
/// object has no masks. Throws InputError for a lens.
void write_bop_scene(const std::filesystem::path& folder, const std::vector<BopPicture>& pictures,
                     Notes& notes);

}  // namespace laterna
