// The fields of a scene file (sim/scene_fields.h): lens, intrinsics and placement; projectors and cameras.
#pragma once

#include "sim/fields/effects.h"
#include "sim/fields/sensor.h"

namespace laterna {

template <class Visitor>
void describe(Visitor& visit, Lens& lens) {
  visit(Field{.key = "model",
              .sentence = "A lens model of mrcal: LENSMODEL_PINHOLE, _STEREOGRAPHIC, _OPENCV4, _OPENCV5, "
                          "_OPENCV8, _OPENCV12, _CAHVOR or _SPLINED_STEREOGRAPHIC_..."},
        lens.model);
  visit(
      Field{.key = "parameters",
            .sentence = "Those that follow fx, fy, cx, cy, in mrcal's order (OPENCV5: k1, k2, p1, p2, k3)."},
      lens.parameters);
}

template <class Visitor>
void describe_intrinsics(Visitor& visit, DeviceSpec& device) {
  visit(Field{.key = "size",
              .unit = "px",
              .sentence = "Width and height of the picture. Required, but with cameramodel.",
              .low = 1,
              .high = 16384},
        device.size);
  const Field focal{.key = "", .unit = "px", .low = 0, .high = 1e8, .low_excluded = true};
  Field fx = focal, fy = focal;
  fx.key = "fx", fx.sentence = "Focal length over pixel width: u = fx·x/z + cx.";
  fy.key = "fy", fy.sentence = "Focal length over pixel height: v = fy·y/z + cy. Absent: fx.";
  visit(fx, device.fx);
  visit(fy, device.fy);
  const Field centre{.key = "", .unit = "px", .low = -1e8, .high = 1e8};
  Field cx = centre, cy = centre;
  cx.key = "cx";
  cx.sentence =
      "Principal point, u; the centre of the first pixel is 0; may lie outside the picture. Absent, with fx: "
      "the "
      "picture's centre, (W-1)/2.";
  cy.key = "cy", cy.sentence = "Principal point, v, downwards. Absent, with fx: (H-1)/2.";
  visit(cx, device.cx);
  visit(cy, device.cy);
  visit(Field{.key = "throw_ratio",
              .sentence = "Instead of fx: distance over picture width; fx = fy = throw_ratio·W.",
              .low = 0,
              .high = 1e4,
              .low_excluded = true},
        device.throw_ratio);
  visit(Field{.key = "lens_shift",
              .sentence = "With throw_ratio: the fractions of the picture's width and height by which it is "
                          "moved left and up; cx = (W-1)/2 + shift·W, cy likewise. Absent: none.",
              .low = -100,
              .high = 100},
        device.lens_shift);
  const Field angle{.key = "", .unit = "deg", .low = 0, .high = 179.9, .low_excluded = true};
  Field fov_y = angle, fov_x = angle;
  fov_y.key = "fov_y_deg", fov_y.sentence = "Instead of fx: the full vertical angle of view.";
  fov_x.key = "fov_x_deg", fov_x.sentence = "Instead of fx: the full horizontal angle of view.";
  visit(fov_y, device.fov_y_deg);
  visit(fov_x, device.fov_x_deg);
  visit(Field{.key = "aspect",
              .sentence = "With an angle of view: width over height of the picture. Absent: W/H.",
              .low = 0,
              .high = 1e4,
              .low_excluded = true},
        device.aspect);
  visit(Field{.key = "cameramodel",
              .sentence = "Instead of size, intrinsics, placement and lens: a .cameramodel file of mrcal, "
                          "relative to the scene file."},
        device.cameramodel);
}

template <class Visitor>
void describe_placement(Visitor& visit, DeviceSpec& device) {
  const Field metres{.key = "", .unit = "m", .low = -farthest_m, .high = farthest_m};
  const auto point = [&](const char* key, const char* sentence, auto& value) {
    Field field = metres;
    field.key = key, field.sentence = sentence;
    visit(field, value);
  };
  point("device_from_world",
        "3×4 rows [R, t] of a rotation and a translation: x_device = R·x_world + t, with x right, y down, z "
        "forward.",
        device.device_from_world);
  point("position", "Instead: where the device stands in the world,", device.position);
  point("look_at", "the world point that its axis goes through,", device.look_at);
  point("up", "and the world direction that its picture shows upwards. Absent: [0, 0, 1].", device.up);
  visit(Field{.key = "rotation_vector_rad",
              .unit = "rad",
              .sentence = "Instead: the rotation of device_from_world as axis times angle (OpenCV's rvec),",
              .low = -1000,
              .high = 1000},
        device.rotation_vector_rad);
  visit(Field{.key = "quaternion_wxyz",
              .sentence = "or as a quaternion of any length,",
              .low = -1e6,
              .high = 1e6},
        device.quaternion_wxyz);
  point("translation", "and the translation t of device_from_world, with either of the two.",
        device.translation);
}

template <class Visitor>
void describe(Visitor& visit, DeviceSpec& device) {
  visit(Field{.key = "name",
              .sentence = "Unique among all devices. Absent: projector or camera, numbered from 1 "
                          "where there are several."},
        device.name);
  describe_intrinsics(visit, device);
  describe_placement(visit, device);
  visit(Field{.key = "lens", .sentence = "Distortion: a warp after the divide."}, device.lens);
  visit(Field{.key = "near",
              .unit = "m",
              .sentence = "Axial depth where a projector's light begins. Absent: no such plane.",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        device.near_m);
  visit(Field{.key = "far",
              .unit = "m",
              .sentence = "Axial depth where a projector's light ends; near < far. Absent: no such plane.",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        device.far_m);
}

template <class Visitor>
void describe(Visitor& visit, ProjectorSpec& projector) {
  describe(visit, projector.device);
  visit(Field{.key = "flux_lm",
              .unit = "lm",
              .sentence = "Luminous flux of the all-white picture, shared evenly by its pixels.",
              .low = 0,
              .high = 1e9,
              .low_excluded = true},
        projector.flux_lm);
  visit(Field{.key = "lookup", .sentence = "nearest: a pixel is a box. bilinear: a tent."}, projector.lookup);
  visit(Field{.key = "border", .sentence = "Beyond the picture's edge: no light, or the edge pixel's."},
        projector.border);
  describe(visit, projector.effects);
}

template <class Visitor>
void describe(Visitor& visit, CameraBelief& belief) {
  visit(
      Field{.key = "rotate_deg",
            .unit = "deg",
            .sentence = "The believed camera's frame is the true one's turned about the camera's centre and "
                        "its own x axis, then y, then z,",
            .low = -36000,
            .high = 36000},
      belief.rotate_deg);
  visit(Field{.key = "translate",
              .unit = "m",
              .sentence = "then moved: x_believed = Rz·Ry·Rx·x_device + translate.",
              .low = -farthest_m,
              .high = farthest_m},
        belief.translate);
  visit(Field{.key = "focal_px", .unit = "px", .sentence = "Added to fx and fy.", .low = -1e8, .high = 1e8},
        belief.focal_px);
  visit(Field{.key = "center_px", .unit = "px", .sentence = "Added to cx and cy.", .low = -1e8, .high = 1e8},
        belief.center_px);
  visit(Field{.key = "sigma_rotate_deg",
              .unit = "deg",
              .sentence = "Standard deviations of these errors, as the solver is told them: of the rotation,",
              .low = 0,
              .high = 180},
        belief.sigma_rotate_deg);
  visit(Field{.key = "sigma_translate",
              .unit = "m",
              .sentence = "of the translation,",
              .low = 0,
              .high = farthest_m},
        belief.sigma_translate);
  visit(Field{.key = "sigma_focal_px", .unit = "px", .sentence = "of fx and fy,", .low = 0, .high = 1e8},
        belief.sigma_focal_px);
  visit(Field{.key = "sigma_center_px", .unit = "px", .sentence = "of cx and cy.", .low = 0, .high = 1e8},
        belief.sigma_center_px);
}

template <class Visitor>
void describe(Visitor& visit, CameraSpec& camera) {
  describe(visit, camera.device);
  visit(Field{.key = "sensor", .sentence = "How light becomes digital numbers."}, camera.sensor);
  visit(Field{.key = "vignetting", .sentence = "What share of the light the lens passes."},
        camera.vignetting);
  visit(Field{.key = "samples_per_pixel",
              .sentence = "A pixel is the mean of this many rays, spread over its area (with "
                          "`antialiasing`), the aperture (`camera_defocus`) and the Airy pattern "
                          "(`diffraction`).",
              .low = 1,
              .high = most_samples_per_pixel},
        camera.samples_per_pixel);
  describe(visit, camera.optics);
  visit(Field{.key = "colour_filter",
              .sentence = "With `colour`: before each pixel. A Bayer camera's pictures are the raw mosaic."},
        camera.colour_filter);
  visit(Field{.key = "veiling_glare",
              .sentence = "With `camera_glare`: share of the light that the lens scatters evenly over the "
                          "image.",
              .low = 0,
              .high = 1},
        camera.veiling_glare);
  visit(Field{.key = "believed",
              .sentence = "What the solver is told of this camera, where that is not the truth, and how "
                          "uncertain it is told it is; each sigma is independent of the others."},
        camera.believed);
}

}  // namespace laterna
