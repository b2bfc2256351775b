// What several foreign calibration formats share: K, OpenCV's distortion, rotations by rows, names.
#pragma once

#include "sim/formats/rig.h"
#include "sim/formats/tree.h"

#include <span>
#include <string>
#include <vector>

namespace laterna {

/// K row by row: fx 0 cx; 0 fy cy; 0 0 1. Throws InputError, beginning with `place`, for another last row or
/// a skew of more than 1e-9 of fx, which no device here has.
Intrinsics intrinsics_from_k(std::span<const double> k, glm::ivec2 size, const std::string& place);
std::vector<double> k_of(const Intrinsics& intrinsics);

/// b_from_a from nine numbers row by row and a translation. A rotation within 1e-3 of orthonormal (files with
/// few digits, single precision) becomes the nearest one where it differs by more than 1e-12; another is an
/// InputError, beginning with `place`.
Rigid rigid_from_rotation_rows(std::span<const double> rotation, const glm::dvec3& translation,
                               const std::string& place);
/// R row by row.
std::vector<double> rotation_rows(const Rigid& b_from_a);

/// k1, k2, p1, p2[, k3[, k4, k5, k6[, s1, s2, s3, s4[, tx, ty]]]], OpenCV's order and mrcal's: 0, 4, 5, 8, 12
/// coefficients, or 14 with tx = ty = 0; all of them 0: a pinhole. Throws InputError, beginning with `place`.
Lens lens_from_opencv(std::vector<double> coefficients, const std::string& place);
/// The inverse: none for a pinhole. Throws InputError, naming the device and the `format`, for a lens that is
/// none of OpenCV's, or has more than `most` coefficients.
std::vector<double> opencv_coefficients(const Device& device, const char* format, std::size_t most = 12);

/// The frame of OpenGL, glTF and OpenUSD (x right, y up, looking along -z) from a device's (x right, y down,
/// z forward), and back: diag(1, -1, -1) is its own inverse.
Rigid view_from_device();

/// Whether a name begins with "proj", in any case: what tells projectors in formats that know cameras only.
bool names_projector(const std::string& name);
/// Puts a device among the projectors or the cameras by its name.
void add_by_name(Rig& rig, Device device);
/// Cameras, then projectors.
std::vector<Device> devices_of(const Rig& rig);
/// Notes that `format` knows cameras only, and under which names projectors will be read as such.
void note_projectors(const Rig& rig, const char* format, Notes& notes);

/// The rig in the frame of one of its devices: device_from_reference = device_from_world ·
/// world_from_reference. Where the world was another frame than the reference's, a note says that it is lost.
Rig relative_to(const Rig& rig, const Device& reference, const char* format, Notes& notes);

/// The rig with every length multiplied.
Rig scaled(Rig rig, double factor);

/// "a, b, c" of numbers, to their last bit.
std::string joined(std::span<const double> numbers, const char* separator = ", ");

}  // namespace laterna
