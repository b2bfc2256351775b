// What a camera's picture sequence plays: the sources' patterns, and when each is shown.
#pragma once

#include "sim/pattern.h"

#include <functional>
#include <vector>

namespace laterna {

/// Patterns of either kind; what it points to must outlive it.
struct AnyPatterns {
  const PatternStack* values = nullptr;
  const BinaryPatternStack* bits = nullptr;
  int width, height, count;

  AnyPatterns(const PatternStack& p) : values(&p), width(p.width), height(p.height), count(p.count) {}
  AnyPatterns(const BinaryPatternStack& p) : bits(&p), width(p.width), height(p.height), count(p.count) {}
};

/// A frame's share in a picture.
struct FrameShare {
  int frame;
  float share;
};
using PictureFrames = std::vector<FrameShare>;

/// Which frames of each source a picture integrates: picture k of an image row is its constant light and,
/// over the sources, Σ share·frame. A source that is lit all the time has shares that add to 1.
struct Timeline {
  int pictures = 0;
  std::function<std::vector<PictureFrames>(int image_row, int source)> frames_of_row;  ///< a list per picture
};

/// What is played: every source's stack, of one number of frames. Without a timeline picture k is frame k.
struct Show {
  std::vector<AnyPatterns> sources;
  Timeline timeline{};

  Show(const PatternStack& patterns) : sources{patterns} {}
  Show(const BinaryPatternStack& patterns) : sources{patterns} {}
  Show(const AnyPatterns& patterns) : sources{patterns} {}
  /// Throws InputError where there is no source, the counts differ, or bits stand beside values.
  explicit Show(std::vector<AnyPatterns> all_sources, Timeline when = {});

  int frames() const { return sources[0].count; }
  int pictures() const { return timeline.frames_of_row ? timeline.pictures : frames(); }
  bool binary() const { return sources[0].bits != nullptr; }
};

}  // namespace laterna
