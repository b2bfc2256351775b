#include "calib/decode_report.h"

#include "calib/bent_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr double contrast_share = 40 / 255.0;  // where sums are looked at: noise matters less
constexpr double bent_misfit = 0.08, odd_misfit = 0.03, odd_factor = 3;
constexpr double bent_shift_px = 0.1;  // below it, periods average out before it matters
constexpr double many = 0.4;           // a dropped picture of a code takes half of the pixels

constexpr const char* names[reject_reasons] = {"valid",    "dim",     "saturated", "pair",
                                               "disagree", "outside", "steep"};
constexpr const char* sentences[reject_reasons] = {
    "",
    "",
    "have fewer than three samples below full scale: shorten the exposure",
    "have a pattern too near to its inverse: a dropped picture, blur or noise",
    "tell no one place: a dropped picture, a response that is not linear, or too much noise for the pitches",
    "tell a place outside the projector: a wrong projector size, or pictures in another order",
    "tell another place than all their neighbours"};

double median_misfit(std::vector<GroupMisfit> misfits) {
  const auto middle = misfits.begin() + std::ptrdiff_t(misfits.size() / 2);
  std::nth_element(misfits.begin(), middle, misfits.end(),
                   [](const GroupMisfit& a, const GroupMisfit& b) { return a.misfit < b.misfit; });
  return middle->misfit;
}

// A response bends all fringes alike; a lost picture only its own.
double least_misfit(const std::vector<GroupMisfit>& misfits) {
  return std::min_element(misfits.begin(), misfits.end(),
                          [](const GroupMisfit& a, const GroupMisfit& b) { return a.misfit < b.misfit; })
      ->misfit;
}

std::string group_name(const PatternSequence& sequence, const PatternGroup& group) {
  return fmt::format("\"{}\" to \"{}\"", picture_name(sequence, group.first),
                     picture_name(sequence, group.first + group.count - 1));
}

void doubt(std::string flag, DecodeReport& report) {
  report.doubts.push_back(flag);
  report.flags.push_back(std::move(flag));
}

// The shift of places by the finest fringe, whose sums are off by the least misfit.
double shift_px(const std::vector<GroupMisfit>& fringes) {
  const auto finest = std::min_element(fringes.begin(), fringes.end(), [](const auto& a, const auto& b) {
    return a.group.pitch_px < b.group.pitch_px;
  });
  const double n = finest->group.count;
  const double mean_rest = least_misfit(fringes) * std::sqrt(n + n * n / 2) / n;
  return bent_response_shift_px(mean_rest, finest->group.count, finest->group.pitch_px);
}

void flag_response(const PatternSequence& sequence, const std::vector<GroupMisfit>& fringes,
                   DecodeReport& report) {
  const double shift = shift_px(fringes);
  const std::string words = fmt::format(
      "the steps of the fringes do not sum to half of white and black: the response is not linear (a gamma, "
      "which would shift places by {:.2g} px rms), or pictures are in another order",
      shift);
  if (shift > bent_shift_px || sequence.parameters.kind == PatternKind::micro_phase)
    doubt(words, report);
  else
    report.flags.push_back(words);
}

void flag_sums(const PatternSequence& sequence, DecodeReport& report) {
  std::vector<GroupMisfit> fringes;
  for (const GroupMisfit& m : report.misfits)
    if (m.group.kind == PatternGroup::Kind::fringe) fringes.push_back(m);
  const bool bent = !fringes.empty() && least_misfit(fringes) > bent_misfit;
  if (bent) flag_response(sequence, fringes, report);
  if (report.misfits.size() < 3) return;
  const double typical = median_misfit(report.misfits);
  for (const GroupMisfit& m : report.misfits) {
    const bool is_fringe = m.group.kind == PatternGroup::Kind::fringe;
    const double usual = bent && is_fringe ? least_misfit(fringes) : typical;
    if (m.misfit <= odd_misfit || m.misfit <= odd_factor * usual) continue;
    doubt(fmt::format("{} do not sum to white and black as the others do: a dropped or exchanged picture",
                      group_name(sequence, m.group)),
          report);
  }
}

void flag_repeat(const CapturedView& pictures, const PatternSequence& sequence, DecodeReport& report) {
  report.repeat = compare_repeat(pictures, sequence);
  if (!report.repeat || !has_moved(*report.repeat)) return;
  doubt(fmt::format("the rig or the scene moved between the first and the last picture: {:.2g} % of the lit "
                    "pixels changed, which should be equal",
                    100 * report.repeat->changed_share),
        report);
}

void flag_black_and_white(const CapturedView& pictures, double contrast, DecodeReport& report) {
  const double outside = outside_black_and_white(pictures, contrast);
  if (outside > 0.01) {
    doubt(fmt::format("{:.0f} % of the pixels are brighter than in white, or darker than in black: white or "
                      "black was dropped or exchanged, or the rig or the scene moved",
                      100 * outside),
          report);
  }
  if (report.percent[int(Reject::dim)] == 100)
    report.flags.push_back("no pixel is lit: white is nowhere brighter than black");
}

void flag_steps(const PatternSequence& sequence, const DecodedMap& map, DecodeReport& report) {
  if (sequence.parameters.kind != PatternKind::gray) return;
  report.steps = code_steps(map, sequence.projector_size);
  if (!report.steps) return;
  const CodeSteps& s = *report.steps;
  doubt(
      fmt::format(
          "the rig or the scene moved between the pictures of {} bit {} and those of bit {}: one side of the "
          "edges of the coarser code is read {:.0f} % too often, the other too rarely, {:.0f} standard "
          "deviations "
          "from chance",
          s.rows ? "row" : "column", s.bit, s.bit - 1, 100 * std::abs(s.asymmetry), std::abs(s.deviations)),
      report);
}

void flag_places(const CapturedView& pictures, const PatternSequence& sequence, const DecodedMap& map,
                 DecodeReport& report) {
  report.places = group_places(pictures, sequence, map);
  const auto apart = farthest_apart(report.places);
  if (!apart) return;
  doubt(fmt::format("{} show places {:.2g} px from where {} show them: the rig or the scene moved between "
                    "them, or surfaces light each other",
                    group_name(sequence, apart->first.group),
                    std::abs(apart->first.mean_px - apart->second.mean_px),
                    group_name(sequence, apart->second.group)),
        report);
}

void flag_shares(DecodeReport& report) {
  const double lit = 100 - report.percent[int(Reject::dim)];
  for (int reason = int(Reject::saturated); reason < reject_reasons; ++reason) {
    const double share = report.percent[reason] / std::max(lit, 1e-9);
    if (share > many)
      report.flags.push_back(fmt::format("{:.0f} % of the lit pixels {}", 100 * share, sentences[reason]));
  }
}

void flag_orientation(DecodeReport& report) {
  const Orientation& o = report.orientation;
  if (o.known && o.mirrored) {
    report.flags.push_back(fmt::format(
        "the picture is {}: rear projection, a mirror in the path, or pictures shown or stored flipped",
        orientation_words(o)));
  } else if (!o.known && o.agreement > 0) {
    report.flags.push_back("the picture's handedness cannot be told: " + orientation_words(o));
  }
}

}  // namespace

const char* reject_name(Reject reason) { return names[int(reason)]; }

namespace {

// All that is told by the pictures without a repeat.
void report_on_plain(const CapturedView& pictures, const PatternSequence& sequence, const DecodedMap& map,
                     DecodeReport& report) {
  const double contrast = contrast_share * full_scale_dn(pictures);
  report.misfits = sum_misfits(pictures, pattern_groups(sequence), contrast);
  flag_sums(sequence, report);
  flag_black_and_white(pictures, contrast, report);
  flag_steps(sequence, map, report);
  flag_places(pictures, sequence, map, report);
  flag_orientation(report);
  flag_shares(report);
}

}  // namespace

DecodeReport report_on(const CapturedView& pictures, const PatternSequence& sequence, const DecodedMap& map) {
  DecodeReport report;
  for (const Reject why : map.why.values) report.percent[int(why)] += 100.0 / double(map.why.values.size());
  report.valid_percent = report.percent[0];
  report.orientation = orientation_of(map);
  if (!is_coded(sequence.parameters.kind)) return report;
  if (!sequence.parameters.repeat_first) {
    report_on_plain(pictures, sequence, map, report);
  } else {
    report_on_plain(without_repeat(pictures, sequence), without_repeat(sequence), map, report);
    flag_repeat(pictures, sequence, report);
  }
  return report;
}

}  // namespace laterna
