// Timing: which patterns a picture's exposure meets. Stage: replay.
//
// One frame of the projector is the unit of time. Pattern p is shown in frames n·p to n·(p + 1), n =
// frames_per_pattern. Image row y of H opens for picture k at
//
//   t = n·k + exposure_delay_frames + rolling_shutter_frames·y/(H - 1),
//
// for T = exposure_frames, and its light is the mean over [t, t + T). Where a frame is dropped at d, pattern
// p
// + 1 is shown in place of p for p ≥ d; where one is repeated at r, p - 1 in place of p ≥ r. Before the first
// pattern the first is shown, after the last the last.
//
// Within a frame light is steady, unless
//   colour_wheel: primary j is lit in [j/3, (j + 1)/3) of the frame, three times as bright;
//   bit_planes: bit b of a value, from 7 down, is shown for 2^b/255 of the frame (or of the primary's third).
//
// Without bit planes only shares of frames change: no memory, and a sum per source, picture and pixel. Bit
// planes of greys cost 8 frames a pattern: 8 times the memory and the time. Black and white pictures have the
// same bit in all planes and need none.
#pragma once

#include "render/show.h"
#include "sim/scene.h"

#include <span>

namespace laterna {

/// How many bits a panel's value has.
inline constexpr int bit_plane_count = 8;

/// Shares of pictures in the frames of `patterns` patterns, or, with `planes`, of their bit planes: frame 8p
/// + i is bit 7 - i of pattern p. With a colour wheel source i shows primary i mod 3. Empty
/// where picture k is pattern k. Throws InputError where
/// dropped_frame, repeated_frame or moved.from_picture is no picture of the sequence.
Timeline make_timeline(const Timing& timing, int patterns, int image_height, bool planes);

/// Whether any value gives light between none and all of it, so that its bit planes differ.
bool has_greys(std::span<const PatternStack> stacks);

/// The 8 bit planes of each picture, most significant first, 0 or 255: those of the nearest integer to 255
/// times the light of a value. The stack has no added light.
PatternStack bit_planes(const PatternStack& patterns);

}  // namespace laterna
