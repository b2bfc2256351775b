#include "render/effects/timing.h"

#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace laterna {

namespace {

// A part of a projector frame in which one thing is shown.
struct Slot {
  double begin, end;  // within the frame
  double brightness;  // over the frame's mean for white
};

std::vector<Slot> slots_of(const Timing& timing, int primary, bool planes) {
  const double thirds = timing.colour_wheel ? 3 : 1, first = timing.colour_wheel ? primary / 3.0 : 0;
  if (!planes) return {{first, first + 1 / thirds, thirds}};
  std::vector<Slot> slots;
  for (int shown = 0, bit = bit_plane_count - 1; bit >= 0; shown += 1 << bit--)
    slots.push_back({first + shown / (255 * thirds), first + (shown + (1 << bit)) / (255 * thirds), thirds});
  return slots;
}

struct Clock {
  Timing timing;
  int patterns, image_height;
  std::array<std::vector<Slot>, 3> slots;  // by primary

  int shown_pattern(int frame) const {
    const int due = std::clamp(int(std::floor(double(frame) / timing.frames_per_pattern)), 0, patterns - 1);
    const int ahead = timing.dropped_frame && due >= *timing.dropped_frame,
              behind = timing.repeated_frame && due >= *timing.repeated_frame;
    return std::clamp(due + ahead - behind, 0, patterns - 1);
  }

  // What is shown of a primary between two times, as a share of that time.
  PictureFrames exposed(double opens, double closes, const std::vector<Slot>& of_frame) const {
    std::map<int, double> shares;
    for (int frame = int(std::floor(opens)); frame < closes; ++frame) {
      for (std::size_t i = 0; i < of_frame.size(); ++i) {
        const Slot& slot = of_frame[i];
        const double shown = std::min(closes, frame + slot.end) - std::max(opens, frame + slot.begin);
        if (shown > 0)
          shares[shown_pattern(frame) * int(of_frame.size()) + int(i)] +=
              slot.brightness * shown / (closes - opens);
      }
    }
    PictureFrames frames;
    for (const auto& [frame, share] : shares) frames.push_back({frame, float(share)});
    return frames;
  }

  std::vector<PictureFrames> operator()(int image_row, int source) const {
    const double later = timing.rolling_shutter_frames * image_row / std::max(1, image_height - 1);
    std::vector<PictureFrames> pictures;
    for (int k = 0; k < patterns; ++k) {
      const double opens = double(timing.frames_per_pattern) * k + timing.exposure_delay_frames + later;
      pictures.push_back(exposed(opens, opens + timing.exposure_frames, slots[source % 3]));
    }
    return pictures;
  }
};

void expect_picture(const char* key, int picture, int count) {
  if (picture >= count)
    throw InputError(fmt::format("[timing]: {} is {}, expected a picture of the sequence, 0 to {}", key,
                                 picture, count - 1));
}

std::uint8_t code_of(float light) {
  return std::uint8_t(std::clamp(std::lround(255 * double(light)), 0L, 255L));
}

}  // namespace

Timeline make_timeline(const Timing& timing, int patterns, int image_height, bool planes) {
  expect_picture("dropped_frame", timing.dropped_frame.value_or(0), patterns);
  expect_picture("repeated_frame", timing.repeated_frame.value_or(0), patterns);
  expect_picture("from_picture of moved", timing.moved.from_picture, patterns);
  Timing of_frames = timing;
  of_frames.moved = {};
  if (of_frames == Timing{}) return {};
  Clock clock{timing, patterns, image_height, {}};
  for (int primary = 0; primary < 3; ++primary) clock.slots[primary] = slots_of(timing, primary, planes);
  return {patterns, clock};
}

bool has_greys(std::span<const PatternStack> stacks) {
  return std::any_of(stacks.begin(), stacks.end(), [](const PatternStack& stack) {
    std::array<bool, 256> grey;
    for (int v = 0; v < 256; ++v) {
      const int code = code_of(stack.light_of_value[v]);
      grey[v] = code != 0 && code != 255;
    }
    return std::any_of(stack.values.begin(), stack.values.end(), [&](std::uint8_t v) { return grey[v]; });
  });
}

PatternStack bit_planes(const PatternStack& patterns) {
  PatternStack planes{patterns.width, patterns.height, bit_plane_count * patterns.count, {}};
  planes.values.resize(patterns.values.size() * bit_plane_count);
  const std::size_t row = std::size_t(patterns.width) * patterns.count;
  parallel_for(std::size_t(patterns.height), [&](std::size_t y) {
    for (std::size_t i = y * row; i < (y + 1) * row; ++i) {
      const std::uint8_t code = code_of(patterns.light_of_value[patterns.values[i]]);
      for (int plane = 0; plane < bit_plane_count; ++plane)
        planes.values[i * bit_plane_count + plane] = (code >> (bit_plane_count - 1 - plane)) & 1 ? 255 : 0;
    }
  });
  return planes;
}

}  // namespace laterna
