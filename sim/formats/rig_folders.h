// The formats that are a folder, or one file for each device: what rig_formats.cpp lists of them.
#pragma once

#include "sim/formats/rig_file.h"

namespace laterna {

/// A file's text, of at most most_tree_bytes.
std::string text_of(const std::filesystem::path& path);

// mrcal's .cameramodel, or a folder of them.
bool is_mrcal(const std::filesystem::path& path, const Tree& tree);
Rig read_mrcal(const std::filesystem::path& path, const RigReadOptions& options);
std::vector<RigText> mrcal_texts(const Rig& rig, Notes& notes);

// COLMAP's folder, by its own name or that of one of its files.
bool is_colmap(const std::filesystem::path& path, const Tree& tree);
Rig read_colmap(const std::filesystem::path& path, const RigReadOptions& options);
std::vector<RigText> colmap_texts(const Rig& rig, Notes& notes);

// ROS's camera_info, or a folder of them.
bool is_ros(const std::filesystem::path& path, const Tree& tree);
Rig read_ros(const std::filesystem::path& path, const RigReadOptions& options);
std::vector<RigText> ros_texts(const Rig& rig, Notes& notes);

// An EXR picture, or a folder of nothing else: others hold maps beside what they are about.
bool is_exr(const std::filesystem::path& path, const Tree& tree);
Rig read_exr(const std::filesystem::path& path, const RigReadOptions& options);
std::vector<RigText> exr_texts(const Rig& rig, Notes& notes);

// A scene, or the scene of a capture folder.
bool is_scene(const std::filesystem::path& path, const Tree& tree);
Rig read_scene(const std::filesystem::path& path, const RigReadOptions& options);
std::vector<RigText> scene_texts(const Rig& rig, Notes& notes);

}  // namespace laterna
