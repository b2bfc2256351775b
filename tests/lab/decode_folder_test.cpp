#include "apps/lab/decode_folder.h"

#include "sim/capture_folder.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;

TEST(ManifestOrPictures, ASizeThatIsNotTheManifestsIsRefused) {
  const testing::ScratchFolder scratch;
  CaptureSequence sequence;
  sequence.camera = "cam", sequence.projector = "left", sequence.projector_size = {320, 200};
  CaptureManifest manifest;
  manifest.sequences.push_back(sequence);
  testing::write_text(scratch / "manifest.json", manifest_json(manifest));
  EXPECT_EQ(manifest_or_pictures(scratch.path(), PatternSequence{{}, {320, 200}}).sequences.size(), 1u);
  EXPECT_THAT(input_error([&] {
                manifest_or_pictures(scratch.path(), PatternSequence{{}, {800, 600}});
              }),
              HasSubstr("--projector-size: found 800x600"));
}

TEST(ManifestOrPictures, AFolderThatIsNotThereIsSaidToBe) {
  const testing::ScratchFolder scratch;
  EXPECT_THAT(input_error([&] { manifest_or_pictures(scratch / "nowhere", {}); }),
              HasSubstr("no such folder"));
}

}  // namespace
}  // namespace laterna
