// The fields of a scene file (sim/scene_fields.h): what projectors show, and when.
#pragma once

#include "sim/fields.h"
#include "sim/fields/names.h"
#include "sim/scene_spec.h"

namespace laterna {

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

}  // namespace laterna
