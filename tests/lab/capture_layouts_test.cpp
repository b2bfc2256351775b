#include "apps/lab/capture_layouts.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Layout {
  std::vector<int> order;
  Notes notes;
};

Layout layout(const std::string& name, const PatternSequence& patterns) {
  Layout l;
  for (const NamedPicture& picture : layout_pictures(name, patterns, l.notes))
    l.order.push_back(picture.index);
  return l;
}

// 4 × 2: columns' bits in pictures 0 to 3, rows' in 4 and 5, white 6, black 7.
const PatternSequence small_gray{{.kind = PatternKind::gray}, {4, 2}};

TEST(CaptureLayouts, OrdersOfGrayCodesByHand) {
  EXPECT_THAT(layout("procam", small_gray).order, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  const Layout scan3d = layout("scan3d", small_gray);  // as many bits of columns as of rows
  EXPECT_THAT(scan3d.order, ElementsAre(6, 7, 0, 1, 4, 5));
  ASSERT_EQ(scan3d.notes.size(), 2u);
  EXPECT_THAT(scan3d.notes[0], HasSubstr("columns count in pixels of 2, c is pixel 2·c + 0.5"));
  EXPECT_THAT(scan3d.notes[1], HasSubstr("projector_info.txt says 2 x 2 for 4 x 2"));
  const Layout slstudio = layout("slstudio", small_gray);
  EXPECT_THAT(slstudio.order, ElementsAre(6, 7, 0, 2, 4));
  EXPECT_THAT(slstudio.notes,
              ElementsAre(HasSubstr("expects 10 bits of columns"), HasSubstr("6 bits of rows")));
}

TEST(CaptureLayouts, SlstudiosFringesRunTheOtherWay) {
  PatternSequence fringes{{.kind = PatternKind::multi_frequency, .steps = 3, .pitches_px = {8, 128}},
                          {128, 128}};
  const Layout fits = layout("slstudio", fringes);
  EXPECT_THAT(fits.order, ElementsAre(0, 2, 1, 3, 5, 4, 6, 8, 7, 9, 11, 10));
  EXPECT_THAT(fits.notes, IsEmpty());
  fringes.projector_size.y = 96;
  EXPECT_THAT(layout("slstudio", fringes).notes, ElementsAre(HasSubstr("these fringes are others")));
}

}  // namespace
}  // namespace laterna
