// The fields of a scene file, described once: the reader, the writer and the reference are visitors of this
// page.
#pragma once

#include "sim/fields.h"
#include "sim/scene_spec.h"

namespace laterna {

inline std::span<const char* const> names_of(UpAxis) {
  static constexpr const char* names[] = {"y", "z"};
  return names;
}
inline std::span<const char* const> names_of(Encoding) {
  static constexpr const char* names[] = {"linear", "srgb"};
  return names;
}
inline std::span<const char* const> names_of(Lookup) {
  static constexpr const char* names[] = {"nearest", "bilinear"};
  return names;
}
inline std::span<const char* const> names_of(Border) {
  static constexpr const char* names[] = {"black", "clamp"};
  return names;
}
inline std::span<const char* const> names_of(SensorKind) {
  static constexpr const char* names[] = {"ideal", "emva1288"};
  return names;
}
inline std::span<const char* const> names_of(PatternKind) {
  static constexpr const char* names[] = {
      "gray",        "slide",    "gray_phase", "phase",   "multi_frequency",
      "micro_phase", "xor_gray", "chessboard", "charuco", "pictures"};
  return names;
}
inline std::span<const char* const> names_of(VignettingModel) {
  static constexpr const char* names[] = {"none", "cos4", "polynomial", "map"};
  return names;
}
inline std::span<const char* const> names_of(GlossModel) {
  static constexpr const char* names[] = {"none", "phong", "ggx"};
  return names;
}
inline std::span<const char* const> names_of(SolidKind) {
  static constexpr const char* names[] = {"none", "checker", "noise"};
  return names;
}
inline std::span<const char* const> names_of(ColourFilter) {
  static constexpr const char* names[] = {"mono", "bayer_rggb", "bayer_bggr", "bayer_grbg", "bayer_gbrg"};
  return names;
}

template <class Visitor>
void describe(Visitor& visit, Effects& effects) {
  for (const EffectSwitch& effect : all_effects)
    visit(Field{.key = effect.name, .sentence = effect.sentence}, effects.*effect.on);
}

template <class Visitor>
void describe(Visitor& visit, Vignetting& vignetting) {
  visit(Field{.key = "model",
              .sentence = "cos4: cos⁴θ, θ from the optical axis. polynomial: 1 + c1·tan²θ + c2·tan⁴θ + ... "
                          "map: a picture."},
        vignetting.model);
  visit(Field{.key = "coefficients",
              .sentence = "Of the polynomial: c1, c2, ...; a negative sum counts as 0.",
              .low = -1e6,
              .high = 1e6},
        vignetting.coefficients);
  visit(Field{.key = "map",
              .sentence = "A picture of any size, linear, 0 to 1, stretched over the device's; relative to "
                          "the scene file."},
        vignetting.map);
}

template <class Visitor>
void describe(Visitor& visit, Spotlight& spotlight) {
  visit(Field{.key = "cutoff_deg",
              .unit = "deg",
              .sentence = "Light ends at this angle from the optical axis. Absent: no cone.",
              .low = 0,
              .high = 90,
              .low_excluded = true},
        spotlight.cutoff_deg);
  visit(Field{.key = "exponent", .sentence = "The light is multiplied by cosⁿθ.", .low = 0, .high = 1e4},
        spotlight.exponent);
  visit(Field{.key = "intensity", .sentence = "And by this.", .low = 0, .high = 1e6}, spotlight.intensity);
}

template <class Visitor>
void describe(Visitor& visit, Scaler& scaler) {
  visit(Field{.key = "input_size",
              .unit = "px",
              .sentence = "Width and height of the pictures that come in. Absent: `size`.",
              .low = 1,
              .high = 16384},
        scaler.input_size);
  visit(Field{.key = "overscan",
              .sentence = "Share of the input's width and height that is cut off, half on each side; "
                          "negative: a black frame.",
              .low = -0.9,
              .high = 0.9},
        scaler.overscan);
  visit(Field{.key = "keystone",
              .sentence = "Where the input's corners lie on the panel, x and y of the upper left, upper "
                          "right, lower right and lower left one, (0, 0) to (1, 1) being the panel's own. "
                          "Absent: there.",
              .low = -10,
              .high = 10},
        scaler.keystone);
  visit(Field{.key = "lookup", .sentence = "How the input is read between its pixels."}, scaler.lookup);
}

template <class Visitor>
void describe(Visitor& visit, Optics& optics) {
  visit(Field{.key = "aperture_m",
              .unit = "m",
              .sentence = "Diameter of the lens's opening, for `camera_defocus`, `projector_defocus` and "
                          "`diffraction`.",
              .low = 0,
              .high = 10,
              .low_excluded = true},
        optics.aperture_m);
  visit(Field{.key = "focus_m",
              .unit = "m",
              .sentence = "Axial depth of the plane that is sharp.",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        optics.focus_m);
  visit(Field{.key = "wavelength_m",
              .unit = "m",
              .sentence = "Of the light, for `diffraction`.",
              .low = 1e-7,
              .high = 1e-5},
        optics.wavelength_m);
  visit(Field{.key = "fill_factor",
              .sentence = "Share of a pixel's area that is active: a square about its centre.",
              .low = 0,
              .high = 1,
              .low_excluded = true},
        optics.fill_factor);
}

template <class Visitor>
void describe(Visitor& visit, ProjectorEffects& effects) {
  visit(Field{.key = "vignetting", .sentence = "What share of the light the lens passes."},
        effects.vignetting);
  visit(Field{.key = "spotlight", .sentence = "A cone of light about the projector's optical axis."},
        effects.spotlight);
  visit(Field{.key = "attenuation",
              .sentence = "k0, k1, k2: the light is divided by k0 + k1·d + k2·d², d metres from the "
                          "projector (on top of `irradiance`).",
              .low = 0,
              .high = 1e6},
        effects.attenuation);
  visit(Field{.key = "scaler", .sentence = "What the projector does to a picture before its panel."},
        effects.scaler);
  visit(Field{.key = "response_exponent",
              .sentence = "Light = signal to this power; `response_table` instead, if measured.",
              .low = 0,
              .high = 100,
              .low_excluded = true},
        effects.response_exponent);
  visit(Field{.key = "response_table",
              .sentence = "Light at evenly spaced signals from 0 to 1, linear between them.",
              .low = 0,
              .high = 1},
        effects.response_table);
  visit(Field{.key = "black_level",
              .sentence = "Light of black over light of white: 1 over the contrast ratio.",
              .low = 0,
              .high = 1},
        effects.black_level);
  visit(Field{.key = "veiling_glare",
              .sentence = "Share of a picture's light that the lens scatters evenly over the picture.",
              .low = 0,
              .high = 1},
        effects.veiling_glare);
  describe(visit, effects.optics);
}

template <class Visitor>
void describe(Visitor& visit, Gloss& gloss) {
  visit(Field{.key = "model", .sentence = "The lobe on top of Lambert's."}, gloss.model);
  visit(Field{.key = "strength",
              .sentence = "What share of the light the lobe reflects (at most); with `albedo` at most 1.",
              .low = 0,
              .high = 1},
        gloss.strength);
  visit(Field{.key = "exponent", .sentence = "Of phong.", .low = 0, .high = 1e5}, gloss.exponent);
  visit(Field{.key = "roughness",
              .sentence = "Of ggx: α, the spread of its facets' slopes.",
              .low = 0.001,
              .high = 1},
        gloss.roughness);
}

template <class Visitor>
void describe(Visitor& visit, Solid& solid) {
  visit(Field{.key = "kind", .sentence = "A factor of the albedo, from the point's own coordinates."},
        solid.kind);
  visit(Field{.key = "cell",
              .sentence = "Side of a checker's cube, or of the noise's lattice, in the mesh file's unit.",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        solid.cell);
  visit(
      Field{.key = "low", .sentence = "The factor at the darkest; 1 at the brightest.", .low = 0, .high = 1},
      solid.low);
}

template <class Visitor>
void describe(Visitor& visit, MeshEffects& effects) {
  visit(Field{.key = "gloss", .sentence = "A shine on top of Lambert's law."}, effects.gloss);
  visit(Field{.key = "solid", .sentence = "A procedural albedo."}, effects.solid);
  visit(Field{.key = "normal_map",
              .sentence = "A colour picture of normals: red along s, green along t, blue outwards, each 0 to "
                          "1 for -1 to 1; relative to the scene file."},
        effects.normal_map);
  visit(Field{.key = "displacement_map",
              .sentence =
                  "A picture of heights, linear, 0 to 1, through the mesh's texture coordinates; 16 bits or "
                  "floats give no steps; relative to the scene file."},
        effects.displacement_map);
  visit(Field{.key = "displacement",
              .sentence =
                  "How far white moves the surface outwards along its smooth normal (negative: inwards), in "
                  "the mesh file's unit, before `scale`; black stays.",
              .low = -1e6,
              .high = 1e6},
        effects.displacement);
  visit(Field{.key = "displacement_edge_px",
              .unit = "px",
              .sentence =
                  "The mesh is refined until no edge is longer than this many pixels of displacement_map.",
              .low = 0.1,
              .high = 16384},
        effects.displacement_edge_px);
}

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
void describe_emva1288(Visitor& visit, Sensor& sensor) {
  visit(Field{.key = "exposure_time_s",
              .unit = "s",
              .sentence = "With emva1288: the exposure time. Absent: what saturation_cd_per_m2, or automatic "
                          "exposure, needs.",
              .low = 1e-12,
              .high = 1e6},
        sensor.exposure_time_s);
  visit(Field{.key = "f_number",
              .sentence = "With emva1288: focal length over aperture: E = π/4·L·lens_transmission/f_number².",
              .low = 0.1,
              .high = 1e4},
        sensor.f_number);
  visit(Field{.key = "lens_transmission",
              .sentence = "With emva1288: light behind over light in front of the lens.",
              .low = 1e-6,
              .high = 1},
        sensor.lens_transmission);
  visit(Field{.key = "pixel_pitch_m",
              .unit = "m",
              .sentence = "With emva1288: side of a square pixel.",
              .low = 1e-7,
              .high = 1e-2},
        sensor.pixel_pitch_m);
  visit(Field{.key = "quantum_efficiency",
              .sentence = "With emva1288: electrons per photon on the pixel.",
              .low = 1e-6,
              .high = 1},
        sensor.quantum_efficiency);
  visit(Field{.key = "wavelength_m",
              .unit = "m",
              .sentence = "With emva1288: of the light, for the energy of a photon.",
              .low = 1e-7,
              .high = 1e-5},
        sensor.wavelength_m);
  visit(Field{.key = "luminous_efficacy_lm_per_w",
              .unit = "lm/W",
              .sentence = "With emva1288: of the light; 683 at 555 nm, of white light some 250.",
              .low = 1e-3,
              .high = 684},
        sensor.luminous_efficacy_lm_per_w);
  visit(Field{.key = "full_well_e",
              .unit = "e-",
              .sentence = "With emva1288: the most electrons that a pixel holds.",
              .low = 1,
              .high = 1e9},
        sensor.full_well_e);
  visit(Field{.key = "system_gain_dn_per_e",
              .unit = "DN/e-",
              .sentence = "With emva1288: K. Absent: the full well fills the scale.",
              .low = 1e-6,
              .high = 1e6},
        sensor.system_gain_dn_per_e);
  visit(Field{.key = "dark_noise_e",
              .unit = "e-",
              .sentence = "With emva1288: standard deviation of the read-out noise, that of the dark current "
                          "not included.",
              .low = 0,
              .high = 1e6},
        sensor.dark_noise_e);
  visit(Field{.key = "dark_current_e_per_s",
              .unit = "e-/s",
              .sentence = "With emva1288: electrons without light.",
              .low = 0,
              .high = 1e9},
        sensor.dark_current_e_per_s);
  visit(Field{.key = "black_offset_dn",
              .unit = "DN",
              .sentence = "With emva1288: the signal without electrons; less than the full scale.",
              .low = 0,
              .high = 65535},
        sensor.black_offset_dn);
  visit(Field{.key = "dsnu_e",
              .unit = "e-",
              .sentence = "With emva1288: dark signal non-uniformity: standard deviation over the pixels, "
                          "the same in every picture.",
              .low = 0,
              .high = 1e6},
        sensor.dsnu_e);
  visit(Field{.key = "prnu",
              .sentence = "With emva1288: photo response non-uniformity: relative standard deviation over "
                          "the pixels, the same in every picture.",
              .low = 0,
              .high = 1},
        sensor.prnu);
  visit(Field{.key = "nonuniformity_seed",
              .sentence = "With emva1288: draws DSNU and PRNU, with the number of the camera.",
              .low = 0},
        sensor.nonuniformity_seed);
  visit(Field{.key = "response_exponent",
              .sentence = "With emva1288: DN = full_scale·(y/full_scale)^response_exponent of the linear "
                          "signal y; 1 is linear, 1/2.2 brightens.",
              .low = 0.1,
              .high = 10},
        sensor.response_exponent);
}

template <class Visitor>
void describe(Visitor& visit, Sensor& sensor) {
  visit(Field{.key = "kind",
              .sentence =
                  "ideal: linear, with Gaussian noise. emva1288: the linear camera model of EMVA 1288."},
        sensor.kind);
  visit(Field{.key = "bit_depth",
              .unit = "bit",
              .sentence = "Full scale is 2^bit_depth - 1 DN; 9 to 16 bits go to 16-bit files.",
              .low = 8,
              .high = 16},
        sensor.bit_depth);
  visit(Field{.key = "noise_sigma_dn",
              .unit = "DN",
              .sentence = "With ideal: standard deviation of Gaussian noise, added before rounding.",
              .low = 0,
              .high = 65535},
        sensor.noise_sigma_dn);
  visit(Field{.key = "saturation_cd_per_m2",
              .unit = "cd/m²",
              .sentence = "The luminance that fills the scale. Absent: automatic exposure.",
              .low = 0,
              .high = 1e12,
              .low_excluded = true},
        sensor.saturation_cd_per_m2);
  describe_emva1288(visit, sensor);
}

template <class Visitor>
void describe(Visitor& visit, MeshBelief& belief) {
  visit(
      Field{.key = "file",
            .sentence = "Another mesh file, in the mesh's `unit`, axes and placement, without displacement; "
                        "relative to the scene file. Absent: the true mesh."},
      belief.file);
  visit(Field{.key = "keep",
              .sentence = "Share of its triangles that is left, as far as its topology allows.",
              .low = 0,
              .high = 1,
              .low_excluded = true},
        belief.keep);
  visit(Field{.key = "noise_sigma_m",
              .unit = "m",
              .sentence = "Standard deviation by which each vertex is moved along its normal.",
              .low = 0,
              .high = farthest_m},
        belief.noise_sigma_m);
  visit(Field{.key = "seed", .sentence = "Draws that noise.", .low = 0}, belief.seed);
  visit(Field{.key = "scale",
              .sentence = "Enlarges it about its own origin, where the true mesh has it,",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        belief.scale);
  visit(Field{.key = "rotate_deg",
              .unit = "deg",
              .sentence = "turns it there about the world's x axis, then y, then z,",
              .low = -36000,
              .high = 36000},
        belief.rotate_deg);
  visit(Field{.key = "translate",
              .unit = "m",
              .sentence = "and moves it.",
              .low = -farthest_m,
              .high = farthest_m},
        belief.translate);
}

template <class Visitor>
void describe(Visitor& visit, MeshSpec& mesh) {
  visit(Field{.key = "name",
              .sentence = "What messages and pictures call it. Absent: the file's or the shape's name."},
        mesh.name);
  visit(
      Field{.key = "file",
            .sentence = "A mesh file (PLY, OBJ, STL, glTF, IFC, ..., also .gz), relative to the scene file."},
      mesh.file);
  visit(Field{.key = "shape",
              .sentence = "Instead of a file: plane, box, sphere, relief or v_groove, centred at the origin, "
                          "its picture side towards +z."},
        mesh.shape);
  visit(
      Field{
          .key = "board",
          .sentence =
              "Instead of a file: a printed calibration board, centred at the origin, its print towards +z: "
              "chessboard,9x7,75mm or charuco,8x6,40mm,30mm,DICT_4X4_50 or circles,7x5,30mm,15mm or "
              "acircles,4x11,20mm,15mm (sim/printed_board.h). Its ink reflects a twentieth of `albedo`."},
      mesh.board);
  visit(Field{.key = "shape_size",
              .unit = "m",
              .sentence = "Size of the shape along x, y and z; a sphere's diameter three times.",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        mesh.shape_size);
  visit(Field{.key = "detail",
              .sentence = "Columns and rows of a plane or relief, subdivisions of a sphere.",
              .low = 1,
              .high = 4096},
        mesh.detail);
  visit(Field{.key = "seed", .sentence = "Draws the relief's bumps and the solid noise.", .low = 0},
        mesh.seed);
  visit(Field{.key = "unit", .sentence = "The unit of the file's coordinates: m, mm, cm, km, inch or foot."},
        mesh.unit);
  visit(
      Field{.key = "up",
            .sentence = "The file's axis that points up. \"z\": coordinates as they stand. \"y\": the file's "
                        "(x, y, z) becomes (x, -z, y)."},
      mesh.up);
  visit(Field{.key = "world_from_object",
              .unit = "m",
              .sentence = "3×4 rows [A, t] of any affine map that is not singular, after `unit` and `up`. "
                          "Absent: scale, rotate_deg and translate.",
              .low = -farthest_m,
              .high = farthest_m},
        mesh.world_from_object);
  visit(Field{.key = "scale",
              .sentence = "Enlarges the mesh about its origin, after `unit` and `up`.",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        mesh.scale);
  visit(Field{.key = "rotate_deg",
              .unit = "deg",
              .sentence = "Then turns it about the world's x axis, then y, then z (counter-clockwise as seen "
                          "from the axis's tip).",
              .low = -36000,
              .high = 36000},
        mesh.rotate_deg);
  visit(Field{.key = "translate",
              .unit = "m",
              .sentence = "Then moves it.",
              .low = -farthest_m,
              .high = farthest_m},
        mesh.translate);
  visit(Field{.key = "albedo", .sentence = "Reflected over incident light.", .low = 0, .high = 1},
        mesh.albedo);
  visit(Field{.key = "albedo_map",
              .sentence = "A picture that multiplies `albedo`, through the mesh's texture coordinates; "
                          "relative to the scene file."},
        mesh.albedo_map);
  visit(Field{.key = "albedo_map_encoding",
              .sentence = "What the integers of an 8- or 16-bit picture mean; float pictures are linear."},
        mesh.albedo_map_encoding);
  describe(visit, mesh.effects);
  visit(
      Field{.key = "believed",
            .sentence = "What the solver is told of this mesh, where that is not the truth: `roundtrip` and "
                        "`calibrate` take their points from it."},
      mesh.believed);
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

template <class Visitor>
void describe(Visitor& visit, PatternParameters& patterns) {
  visit(Field{.key = "kind",
              .sentence = "gray: Gray code columns and rows with their inverses, white, black. xor_gray: its "
                          "bits without wide stripes. gray_phase: Gray code, then shifted sinusoids. phase: "
                          "two periods, the second as wide as the projector. multi_frequency, micro_phase: "
                          "several periods. chessboard, charuco: a board. slide: one picture. pictures: a "
                          "list of them."},
        patterns.kind);
  visit(Field{.key = "steps", .sentence = "Pictures of each sinusoid.", .low = 3, .high = 64},
        patterns.steps);
  visit(Field{.key = "pitch_px",
              .unit = "px",
              .sentence = "Period of the sinusoid, the finest where there are several.",
              .low = 2,
              .high = 1e5},
        patterns.pitch_px);
  visit(Field{.key = "pitches_px",
              .unit = "px",
              .sentence = "Periods of multi_frequency and micro_phase; absent: chosen from `pitch_px`.",
              .low = 2,
              .high = 1e5},
        patterns.pitches_px);
  visit(Field{.key = "xor_stripe_px",
              .unit = "px",
              .sentence = "Of xor_gray: the stripes that the other bits are combined with, a power of two.",
              .low = 2,
              .high = 1024},
        patterns.xor_stripe_px);
  visit(
      Field{
          .key = "square_px", .unit = "px", .sentence = "Side of a board's squares.", .low = 8, .high = 4096},
      patterns.square_px);
  visit(Field{.key = "repeat_first",
              .sentence = "Whether the first picture is shown once more at the end, so that decoding can see "
                          "whether anything moved meanwhile."},
        patterns.repeat_first);
}

template <class Visitor>
void describe(Visitor& visit, PatternsSpec& patterns) {
  describe(visit, patterns.parameters);
  visit(Field{.key = "file",
              .sentence = "The slide, a picture of the projector's size (or of the scaler's `input_size`); "
                          "colour becomes grey; relative to the scene file."},
        patterns.file);
  visit(Field{.key = "files",
              .sentence = "The pictures of kind \"pictures\", in their order, each as `file` is."},
        patterns.files);
  visit(Field{.key = "encoding",
              .sentence = "What the integers of an 8- or 16-bit slide mean: \"linear\" where `response` is "
                          "to turn them into light."},
        patterns.encoding);
  visit(Field{.key = "colour",
              .sentence = "With `colour` of [effects]: the share of its light with which each primary, red, "
                          "green and blue, plays.",
              .low = 0,
              .high = 1},
        patterns.colour);
}

template <class Visitor>
void describe(Visitor& visit, ColourSpec& colour) {
  visit(Field{.key = "projector", .sentence = "Its name."}, colour.projector);
  visit(Field{.key = "camera", .sentence = "Its name."}, colour.camera);
  visit(Field{.key = "mixing",
              .sentence = "9 numbers row by row: what the camera's red, green and blue channel see of the "
                          "projector's red, green and blue primary. A mono camera sees the mean of the rows.",
              .low = 0,
              .high = 1000},
        colour.mixing);
}

template <class Visitor>
void describe(Visitor& visit, RigMove& moved) {
  visit(Field{.key = "device", .sentence = "Name of a projector or camera. Absent: nothing moves."},
        moved.device);
  visit(Field{.key = "from_picture",
              .sentence = "The first picture of a sequence that sees it there.",
              .low = 0,
              .high = 1e9},
        moved.from_picture);
  visit(Field{.key = "rotation_vector_rad",
              .unit = "rad",
              .sentence = "Rotation R, axis times angle, and",
              .low = -1000,
              .high = 1000},
        moved.rotation_vector_rad);
  visit(Field{.key = "translation",
              .unit = "m",
              .sentence = "translation t: there x_device = R·x + t of what was x in the device's frame.",
              .low = -farthest_m,
              .high = farthest_m},
        moved.translation);
}

template <class Visitor>
void describe(Visitor& visit, Timing& timing) {
  visit(Field{.key = "dropped_frame",
              .sentence = "From this picture on, the projector shows the pattern after the due one.",
              .low = 0,
              .high = 1e9},
        timing.dropped_frame);
  visit(Field{.key = "repeated_frame",
              .sentence = "From this picture on, the projector shows the pattern before the due one.",
              .low = 0,
              .high = 1e9},
        timing.repeated_frame);
  visit(Field{.key = "frames_per_pattern",
              .unit = "frames",
              .sentence = "For how long a pattern is shown. One picture is taken of each.",
              .low = 1,
              .high = 1000},
        timing.frames_per_pattern);
  visit(Field{.key = "exposure_frames",
              .unit = "frames",
              .sentence = "For how long each picture is exposed. Pictures are as bright for any.",
              .low = 0,
              .high = 1000,
              .low_excluded = true},
        timing.exposure_frames);
  visit(Field{.key = "exposure_delay_frames",
              .unit = "frames",
              .sentence = "How late after its pattern a picture's exposure begins.",
              .low = -1000,
              .high = 1000},
        timing.exposure_delay_frames);
  visit(Field{.key = "rolling_shutter_frames",
              .unit = "frames",
              .sentence = "How much later the image's last row is exposed than its first.",
              .low = 0,
              .high = 1000},
        timing.rolling_shutter_frames);
  visit(Field{.key = "colour_wheel",
              .sentence = "With `colour`: red, green and blue are shown one after the other, a third of a "
                          "frame each."},
        timing.colour_wheel);
  visit(Field{.key = "bit_planes",
              .sentence = "The 8 bits of a value are shown one after the other within a frame, most "
                          "significant first, each for its share of the time."},
        timing.bit_planes);
  visit(Field{.key = "moved", .sentence = "A device that stands elsewhere from some picture on."},
        timing.moved);
}

template <class Visitor>
void describe(Visitor& visit, InterReflection& reflection) {
  visit(Field{.key = "bounces",
              .sentence = "How many surfaces light visits before the one that the camera sees.",
              .low = 0,
              .high = most_bounces},
        reflection.bounces);
  visit(Field{.key = "paths",
              .sentence = "How many ways back are followed from each camera sample; noise falls as "
                          "1/√paths.",
              .low = 1,
              .high = most_paths},
        reflection.paths);
}

template <class Visitor>
void describe(Visitor& visit, SceneSpec& scene) {
  visit(Field{.key = "name", .sentence = "What reports call the scene."}, scene.name);
  visit(Field{.key = "ambient_lx",
              .unit = "lx",
              .sentence = "Uniform illuminance on every surface, from everywhere.",
              .low = 0,
              .high = 1e9},
        scene.ambient_lx);
  visit(Field{.key = "believe_truth",
              .sentence = "The switch over every `believed`: true tells the solver the true meshes and "
                          "cameras, and that it knows them exactly."},
        scene.believe_truth);
  visit(Field{.key = "patterns", .sentence = "What the projectors show."}, scene.patterns);
  visit(
      Field{.key = "effects", .sentence = "One switch for each effect; what it needs stands with its noun."},
      scene.effects);
  visit(Field{.key = "inter_reflection", .sentence = "Light from surface to surface."},
        scene.inter_reflection);
  visit(Field{.key = "timing", .sentence = "When patterns are shown and when pictures are taken."},
        scene.timing);
  visit(
      Field{.key = "colour", .sentence = "How a camera sees a projector's primaries; absent: each its own."},
      scene.colours);
  visit(Field{.key = "mesh", .sentence = "A surface; at least one."}, scene.meshes);
  visit(Field{.key = "projector", .sentence = "A device that emits."}, scene.projectors);
  visit(Field{.key = "camera", .sentence = "A device that measures."}, scene.cameras);
}

}  // namespace laterna
