#include "calib/boards/rig.h"

#include "tests/calib/boards/synthetic_boards.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(BoardRig, WordsNameTerms) {
  EXPECT_THAT(lens_terms("pinhole"), ElementsAre());
  EXPECT_THAT(lens_terms("opencv4"), ElementsAre("k1", "k2", "p1p2"));
  EXPECT_THAT(lens_terms("k1+p1p2"), ElementsAre("k1", "p1p2"));
  EXPECT_THAT(testing::input_error([] { lens_terms("fisheye"); }),
              HasSubstr("\"fisheye\", expected auto, pinhole"));
  EXPECT_THAT(testing::input_error([] { lens_terms("k1+"); }), HasSubstr("expected"));
}

TEST(BoardRig, TheSmallestModelHoldsTheTerms) {
  EXPECT_EQ(model_of_terms({}).lens_model, "LENSMODEL_PINHOLE");
  const DeviceModel k1 = model_of_terms({"k1"});
  EXPECT_EQ(k1.lens_model, "LENSMODEL_OPENCV4");
  EXPECT_EQ(k1.lens_free, (std::vector<bool>{true, false, false, false}));
  EXPECT_EQ(model_of_terms(lens_terms("opencv5")).lens_model, "LENSMODEL_OPENCV5");
  EXPECT_EQ(model_of_terms(lens_terms("opencv8")).lens_model, "LENSMODEL_OPENCV8");
  EXPECT_EQ(model_of_terms(lens_terms("opencv12")).lens_model, "LENSMODEL_OPENCV12");
}

TEST(BoardRig, ColumnsAndTheirNames) {
  RigModel model;
  model.devices = {model_of_terms({"k1"}), model_of_terms({})};
  model.devices[0].one_focal_length = true;
  model.devices[1].fixed_center = true;
  model.bend = true;
  const BoardCapture capture{{{"camera", {640, 480}}, {"projector", {320, 240}}}, {}, {}, {}};
  EXPECT_THAT(column_names(model, capture),
              ElementsAre("camera fx", "camera cx", "camera cy", "camera k1", "projector fx", "projector fy",
                          "projector rotation_x", "projector rotation_y", "projector rotation_z",
                          "projector translation_x", "projector translation_y", "projector translation_z",
                          "bend_x", "bend_y"));
  const RigColumns columns = columns_of(model);
  EXPECT_EQ(columns.devices[0].intrinsics[0], columns.devices[0].intrinsics[1]);
  EXPECT_EQ(columns.devices[0].pose, -1);
  EXPECT_EQ(columns.count, 14);
}

TEST(BoardRig, StepsAreUndone) {
  auto random = testing::generator();
  const testing::BoardTruth t = testing::board_truth({}, random);
  const RigColumns columns = columns_of(t.model);
  std::vector<double> step(columns.count), poses(6 * t.rig.camera_from_board.size(), 0.01);
  for (std::size_t i = 0; i < step.size(); ++i) step[i] = 0.001 * double(i + 1);
  const BoardRig there = moved(t.rig, columns, step, poses);
  const auto back = global_step(t.rig, there, columns);
  for (std::size_t i = 0; i < step.size(); ++i)
    EXPECT_NEAR(back[i], step[i], 1e-12);  // the rounding of focal lengths near 2000
  EXPECT_NE(there.camera_from_board[0].translation, t.rig.camera_from_board[0].translation);
}

TEST(BoardRig, FitsToRestrictedModels) {
  auto random = testing::generator();
  testing::BoardTruth t = testing::board_truth({}, random);
  RigModel model = t.model;
  model.devices[1] = model_of_terms({"k1"});
  model.devices[1].one_focal_length = model.devices[1].fixed_center = true;
  const BoardRig fitted = fitted_to(t.rig, model, t.capture);
  EXPECT_EQ(fitted.devices[1].parameters[0], fitted.devices[1].parameters[1]);
  EXPECT_EQ(fitted.devices[1].parameters[2], 511.5);
  EXPECT_EQ(fitted.devices[1].parameters[3], 383.5);
  EXPECT_EQ(fitted.devices[1].parameters.size(), 8u);
}

TEST(BoardRig, BendLiftsTheMiddle) {
  const BoardExtent extent{{1, 2}, {1, 2}};
  EXPECT_EQ(bent({1, 2, 0}, extent, {0.25, 0.5}).z, 0.75);
  EXPECT_EQ(bent({0, 0, 0}, extent, {0.25, 0.5}).z, 0);
  EXPECT_EQ(bent({0, 2, 0}, extent, {0.25, 0.5}).z, 0.5);
}

}  // namespace
}  // namespace laterna
