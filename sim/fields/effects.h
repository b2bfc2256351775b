// The fields of a scene file (sim/scene_fields.h): what each effect needs, of projectors and of surfaces.
#pragma once

#include "sim/fields.h"
#include "sim/fields/names.h"
#include "sim/scene_spec.h"

namespace laterna {

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

}  // namespace laterna
