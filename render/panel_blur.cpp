#include "render/panel_blur.h"

#include "render/disc_overlap.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr double farthest_px = 1e8;  // beyond it a pixel's place fits no integer

struct Disc {
  glm::dvec2 center_px;
  double radius_px, weight;
};

// Cells first to last along both axes; none where last < first.
struct Box {
  glm::ivec2 first, last;
  bool empty() const { return last.x < first.x || last.y < first.y; }
  int width() const { return last.x - first.x + 1; }
  std::size_t cells() const { return empty() ? 0 : std::size_t(width()) * (last.y - first.y + 1); }
};

// A cell's emitting part along one axis, in radii from a disc's centre.
struct Span {
  DiscEdge begin, end;
};

int floor_mod(int a, int m) { return (a % m + m) % m; }

// What is spread by less than a 32nd (rms) of a disc's diameter is folded into the disc: an even disc
// has a mean square distance of d²/8 from its centre.
constexpr double folded_diameter2 = 8.0 / (32 * 32);

// The entries' own discs; one of the same light, centre and second moment where they nearly coincide.
std::vector<Disc> spots_of(std::span<const LightEntry> entries) {
  std::vector<Disc> spots;
  double weight = 0, diameter2 = 0, least = farthest_px;
  glm::dvec2 center(0);
  for (const LightEntry& e : entries) {
    spots.push_back(
        {glm::clamp(glm::dvec2(e.u_px, e.v_px), -farthest_px, farthest_px), e.footprint_px / 2.0, e.weight});
    weight += e.weight;
    center += e.weight * spots.back().center_px;
    diameter2 += e.weight * e.footprint_px * e.footprint_px;
    least = std::min(least, double(e.footprint_px));
  }
  if (entries.size() < 2 || !(weight > 0)) return spots;
  center /= weight;
  double spread2 = 0;
  for (const Disc& s : spots)
    spread2 += s.weight / weight * glm::dot(s.center_px - center, s.center_px - center);
  if (!(8 * spread2 <= folded_diameter2 * least * least)) return spots;
  return {{center, std::sqrt(diameter2 / weight + 8 * spread2) / 2, weight}};
}

// A point spread, and one disc of its second moment.
struct PointSpread {
  double mean_diameter2 = 0;
  std::vector<DiscShare> folded;

  explicit PointSpread(const std::vector<DiscShare>& discs) {
    for (const DiscShare& disc : discs) mean_diameter2 += disc.share * disc.diameter_px * disc.diameter_px;
    folded = {{std::sqrt(mean_diameter2), 1}};
  }
};

// Spreads the entries of one source at one camera pixel over a grid of cells.
class Spreader {
 public:
  explicit Spreader(const PanelBlur& blur) : blur_(blur), point_spread_(blur.discs) {}

  void spread(std::span<const LightEntry> entries, std::vector<LightEntry>& out) {
    make_discs(entries);
    std::size_t cells = 0;
    box_ = {glm::ivec2(0), glm::ivec2(-1)};
    for (const Disc& disc : discs_) {
      const Box box = box_of(disc);
      cells += box.cells();
      if (box.empty()) continue;
      box_ = box_.empty() ? box : Box{glm::min(box_.first, box.first), glm::max(box_.last, box.last)};
    }
    // Entries far apart share no cells: one by one.
    if (entries.size() > 1 && box_.cells() > 4 * cells) {
      for (const LightEntry& entry : entries) spread({&entry, 1}, out);
      return;
    }
    sum_.assign(box_.cells(), 0);
    for (const Disc& disc : discs_) add(disc);
    write(entries[0].source, out);
  }

 private:
  void make_discs(std::span<const LightEntry> entries) {
    discs_.clear();
    double widest_px = 0;
    for (const Disc& spot : spots_of(entries)) {
      const bool small =
          point_spread_.mean_diameter2 <= folded_diameter2 * 4 * spot.radius_px * spot.radius_px;
      for (const DiscShare& disc : small ? point_spread_.folded : blur_.discs) {
        const double diameter = std::min(std::hypot(2 * spot.radius_px, disc.diameter_px), farthest_px);
        discs_.push_back({spot.center_px, diameter / 2, disc.share * spot.weight});
        widest_px = std::max(widest_px, diameter);
      }
    }
    cell_px_ = std::max(1, int(std::ceil(widest_px / most_cells_across)));
    side_ = cell_px_ == 1 ? blur_.pixel_side : 1;
  }

  Box box_of(const Disc& disc) const {
    const glm::ivec2 first(glm::floor((disc.center_px - disc.radius_px + 0.5) / double(cell_px_)));
    const glm::ivec2 last(glm::floor((disc.center_px + disc.radius_px + 0.5) / double(cell_px_)));
    if (blur_.clamp) return {first, last};
    return {glm::max(first, 0), glm::min(last, (blur_.panel_px - 1) / cell_px_)};
  }

  void add(const Disc& disc) {
    const Box box = box_of(disc);
    if (box.empty()) return;
    if (disc.radius_px == 0) return add_point(disc, box.first);
    cut(columns_, disc.center_px.x, disc.radius_px, box.first.x, box.last.x, blur_.panel_px.x);
    cut(rows_, disc.center_px.y, disc.radius_px, box.first.y, box.last.y, blur_.panel_px.y);
    const double weight = disc.weight / (side_ * side_);
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      double* sum = &at(box.first + glm::ivec2(0, int(j)));
      for (std::size_t i = 0; i < columns_.size(); ++i)
        sum[i] += weight * disc_share(columns_[i].begin, columns_[i].end, rows_[j].begin, rows_[j].end);
    }
  }

  void add_point(const Disc& point, const glm::ivec2& pixel) {
    const glm::dvec2 beside = glm::abs(point.center_px - glm::dvec2(pixel));
    if (std::max(beside.x, beside.y) <= side_ / 2) at(pixel) += point.weight / (side_ * side_);
  }

  void cut(std::vector<Span>& spans, double center, double radius, int first, int last, int panel_px) const {
    spans.clear();
    const double rim = (1 - side_) / 2;
    for (int cell = first; cell <= last; ++cell) {
      const int begin = cell * cell_px_;
      const int end = blur_.clamp ? begin + cell_px_ : std::min(begin + cell_px_, panel_px);
      spans.push_back(
          {disc_edge((begin - 0.5 + rim - center) / radius), disc_edge((end - 0.5 - rim - center) / radius)});
    }
  }

  double& at(const glm::ivec2& cell) {
    const glm::ivec2 inside = cell - box_.first;
    return sum_[std::size_t(inside.y) * box_.width() + inside.x];
  }

  void write(std::uint32_t source, std::vector<LightEntry>& out) {
    for (int j = box_.first.y; j <= box_.last.y; ++j) {
      for (int i = box_.first.x; i <= box_.last.x; ++i) {
        const double weight = at({i, j});
        if (!(weight > 0)) continue;
        const glm::ivec2 pixel =
            cell_px_ * glm::ivec2(i, j) + glm::ivec2(floor_mod(j, cell_px_), floor_mod(i, cell_px_));
        const glm::ivec2 inside = glm::clamp(pixel, glm::ivec2(0), blur_.panel_px - 1);
        out.push_back({double(inside.x), double(inside.y), weight, 0, source});
      }
    }
  }

  const PanelBlur& blur_;
  PointSpread point_spread_;
  int cell_px_ = 1;
  double side_ = 1;
  Box box_{};
  std::vector<Disc> discs_;
  std::vector<Span> columns_, rows_;
  std::vector<double> sum_;
};

// No fewer than the entries that a region's will be spread to: memory that grows step by step is handed back
// to the system with each region, and costs more to get anew than the spreading.
std::size_t most_entries(const LightRows& rows, const PanelBlur& blur) {
  double widest_px = 0, most = 0;
  for (const DiscShare& disc : blur.discs) widest_px = std::max(widest_px, disc.diameter_px);
  for (const LightEntry& e : rows.entries) {
    const double across = std::min(std::hypot(double(e.footprint_px), widest_px), double(most_cells_across));
    most += (across + 2) * (across + 2);
  }
  return std::size_t(most);
}

}  // namespace

void spread_over_panel(LightRows& rows, const PanelBlur& blur) {
  Spreader spreader(blur);
  std::vector<LightEntry> spread;
  spread.reserve(most_entries(rows, blur));
  std::vector<std::uint32_t> begin{0};
  begin.reserve(rows.begin.size());
  for (std::size_t p = 0; p + 1 < rows.begin.size(); ++p) {
    for (std::uint32_t first = rows.begin[p], last = first; first < rows.begin[p + 1]; first = last) {
      const std::uint32_t source = rows.entries[first].source;
      while (last < rows.begin[p + 1] && rows.entries[last].source == source) ++last;
      spreader.spread({&rows.entries[first], last - first}, spread);
    }
    begin.push_back(std::uint32_t(spread.size()));
  }
  rows.begin = std::move(begin);
  rows.entries = std::move(spread);
}

}  // namespace laterna
