#include "sim/pattern_json.h"

#include "tests/testing.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST(PatternJson, ComesBack) {
  EXPECT_EQ(patterns_json({}), Json("gray"));
  for (const PatternParameters& p :
       {PatternParameters{},
        PatternParameters{.kind = PatternKind::gray_phase, .steps = 7, .pitch_px = 1 / 3.0 + 20},
        PatternParameters{.kind = PatternKind::micro_phase, .pitches_px = {16, 17.5, 18.25}},
        PatternParameters{.kind = PatternKind::xor_gray, .xor_stripe_px = 8},
        PatternParameters{.kind = PatternKind::charuco, .square_px = 50},
        PatternParameters{.kind = PatternKind::gray, .repeat_first = true}}) {
    EXPECT_EQ(patterns_of(Json::parse(patterns_json(p).dump())), p);
  }
  const Json phase = patterns_json({.kind = PatternKind::phase, .steps = 3});
  EXPECT_EQ(phase, Json({{"kind", "phase"}, {"steps", 3}}));
}

TEST(PatternJson, SaysWhatIsWrong) {
  const auto message = [](const Json& json) { return testing::input_error([&] { patterns_of(json); }); };
  EXPECT_THAT(message("grey"), HasSubstr("patterns: kind is \"grey\", expected one of \"gray\""));
  EXPECT_THAT(message(3), HasSubstr("kind is 3"));
  EXPECT_THAT(message({{"kind", "phase"}, {"step", 4}}), HasSubstr("did you mean \"steps\"?"));
  EXPECT_THAT(message({{"kind", "phase"}, {"steps", 2}}),
              HasSubstr("steps is 2, expected an integer (3 to 64)"));
  EXPECT_THAT(message({{"kind", "phase"}, {"steps", 3.5}}), HasSubstr("steps is 3.5"));
  EXPECT_THAT(message({{"kind", "gray"}, {"repeat_first", 1}}),
              HasSubstr("repeat_first is 1, expected true or false"));
  EXPECT_THAT(message({{"kind", "micro_phase"}, {"pitches_px", {16, "x"}}}), HasSubstr("pitches_px is"));
}

}  // namespace
}  // namespace laterna
