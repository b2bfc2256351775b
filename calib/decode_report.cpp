#include "calib/decode_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

namespace {

constexpr double contrast_share = 40 / 255.0;  // where sums are looked at: noise matters less
constexpr double bent_misfit = 0.08, odd_misfit = 0.03, odd_factor = 3;
constexpr double many = 0.4;  // a dropped picture of a code takes half of the pixels

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

std::string group_name(const PatternSequence& sequence, const PatternGroup& group) {
  return fmt::format("\"{}\" to \"{}\"", picture_name(sequence, group.first),
                     picture_name(sequence, group.first + group.count - 1));
}

void flag_sums(const PatternSequence& sequence, DecodeReport& report) {
  std::vector<GroupMisfit> fringes;
  for (const GroupMisfit& m : report.misfits)
    if (m.group.kind == PatternGroup::Kind::fringe) fringes.push_back(m);
  if (!fringes.empty() && median_misfit(fringes) > bent_misfit) {
    report.flags.push_back(
        "the steps of the fringes do not sum to half of white and black: the response is not linear (a "
        "gamma), or "
        "pictures are in another order");
  }
  if (report.misfits.size() < 3) return;
  const double typical = median_misfit(report.misfits);
  for (const GroupMisfit& m : report.misfits) {
    const bool bent = m.group.kind == PatternGroup::Kind::fringe && !fringes.empty() &&
                      median_misfit(fringes) > bent_misfit;
    if (bent || m.misfit <= odd_misfit || m.misfit <= odd_factor * typical) continue;
    report.flags.push_back(
        fmt::format("{} do not sum to white and black as the others do: a dropped or exchanged picture",
                    group_name(sequence, m.group)));
  }
}

void flag_black_and_white(const CapturedStack& pictures, double contrast, DecodeReport& report) {
  const double outside = outside_black_and_white(pictures, contrast);
  if (outside > 0.01) {
    report.flags.push_back(
        fmt::format("{:.0f} % of the pixels are brighter than in white, or darker than in black: white or "
                    "black was dropped or exchanged",
                    100 * outside));
  }
  if (report.percent[int(Reject::dim)] == 100)
    report.flags.push_back("no pixel is lit: white is nowhere brighter than black");
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

DecodeReport report_on(const CapturedStack& pictures, const PatternSequence& sequence,
                       const DecodedMap& map) {
  DecodeReport report;
  for (const Reject why : map.why.values) report.percent[int(why)] += 100.0 / double(map.why.values.size());
  report.valid_percent = report.percent[0];
  report.orientation = orientation_of(map);
  if (is_coded(sequence.parameters.kind)) {
    const double contrast = contrast_share * full_scale_dn(pictures);
    report.misfits = sum_misfits(pictures, pattern_groups(sequence), contrast);
    flag_sums(sequence, report);
    flag_black_and_white(pictures, contrast, report);
    flag_orientation(report);
    flag_shares(report);
  }
  return report;
}

}  // namespace laterna
