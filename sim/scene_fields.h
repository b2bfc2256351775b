// The fields of a scene file, described once: the reader, the writer and the reference are visitors of this
// page and of those that it includes.
#pragma once

#include "sim/fields/device.h"
#include "sim/fields/mesh.h"
#include "sim/fields/patterns.h"

namespace laterna {

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
