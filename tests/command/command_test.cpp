// The command as a person would call it.
#include "tests/command/run_command.h"
#include "tests/command/small_scene.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::laterna;
using testing::listing;
using testing::ScratchFolder;
using testing::small;
using testing::write_text;

TEST(Command, FiveMinutesForANewUser) {
  const ScratchFolder scratch;
  const auto fresh = laterna("new", scratch.path());
  ASSERT_EQ(fresh.exit_code, 0) << fresh.err;
  write_text(scratch / "scene.toml", fresh.out);
  const auto check = laterna("check scene.toml", scratch.path());
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("1 projector(s), 1 camera(s)"));
  const auto preview = laterna("preview scene.toml", scratch.path());
  EXPECT_EQ(preview.exit_code, 0) << preview.err;
  EXPECT_THAT(preview.out, HasSubstr("open preview.png"));
  const auto roundtrip = laterna("roundtrip scene.toml", scratch.path());
  EXPECT_EQ(roundtrip.exit_code, 0) << roundtrip.err << roundtrip.out;
  EXPECT_THAT(roundtrip.out, HasSubstr("verdict: ok"));
  EXPECT_THAT(roundtrip.out, HasSubstr("open scene-roundtrip/summary_camera_projector.png"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "scene-roundtrip/summary_camera_projector.png"));
}

TEST(Command, InfoKeepsItsContract) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml", small);
  const auto info = laterna("info s.toml --json", scratch.path());
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const json parsed = json::parse(info.out);
  for (const char* kind : {"projectors", "cameras"}) {
    const json& device = parsed.at(kind).at(0);
    EXPECT_TRUE(device.at("name").is_string());
    EXPECT_EQ(device.at("size").size(), 2u);
    for (const char* matrix :
         {"texture_from_clip", "clip_from_projector", "projector_from_world", "texture_from_world"}) {
      ASSERT_EQ(device.at(matrix).size(), 4u);
      for (const json& row : device.at(matrix)) EXPECT_EQ(row.size(), 4u);
    }
  }
  EXPECT_EQ(parsed["projectors"][0]["texture_from_clip"][0][3], 0.5);  // row-major
  EXPECT_EQ(parsed["projectors"][0]["clip_from_projector"][3][2], -1.0);
}

TEST(Command, LiveWritesOnePageOrItsData) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml", small);
  const auto data = laterna("live s.toml --json", scratch.path());
  EXPECT_EQ(data.exit_code, 0) << data.err;
  EXPECT_EQ(nlohmann::json::parse(data.out)["name"], "s");
  EXPECT_EQ(listing(scratch.path()), "s.toml ");
  const auto page = laterna("live s.toml -o page.html", scratch.path());
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_THAT(page.out, HasSubstr("open page.html"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "page.html"));
  EXPECT_EQ(laterna("live missing.toml", scratch.path()).exit_code, 2);
}

TEST(Command, ProjectPrintsPixelAndDepth) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml",
             "[[mesh]]\nshape = \"plane\"\n[[projector]]\nname = \"p\"\nsize = [4, 2]\nfx = 2.0\nfy = "
             "4.0\ncx = 1.5\ncy = 0.5\n"
             "device_from_world = [[1,0,0,0],[0,1,0,0],[0,0,1,0]]\n");
  const auto projected =
      laterna("project s.toml --device p", scratch.path(), "0 0 2\n1 0.5 2\n\n5 0 1\n0 0 -1\n");
  EXPECT_EQ(projected.exit_code, 0) << projected.err;
  EXPECT_EQ(projected.out, "1.5 0.5 2\n2.5 1.5 2\n11.5 0.5 1\nnan nan -1\n");
  const auto bad = laterna("project s.toml --device p", scratch.path(), "0 0 2\n1 2\n");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("standard input:2"));
  EXPECT_EQ(laterna("project s.toml --device q", scratch.path()).exit_code, 2);
}

TEST(Command, RoundtripKeepsItsContract) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml", small);
  const auto run = laterna("roundtrip s.toml --json --seed 3", scratch.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(listing(scratch.path()), "s.toml ");  // --json without -o writes nothing
  const json p = json::parse(run.out).at("projectors").at(0);
  EXPECT_EQ(p.at("name"), "left");
  EXPECT_EQ(p.at("status"), "ok");
  EXPECT_TRUE(p.at("reason").is_string());
  EXPECT_GT(p.at("correspondences").get<int>(), 30000);
  for (const char* set : {"surface_error_px", "volume_error_px", "extrapolation_error_px"}) {
    for (const char* key : {"rms", "max", "points", "predicted_rms"})
      EXPECT_TRUE(p.at(set).at(key).is_number()) << set << key;
  }
  for (const char* key : {"fx", "fy", "cx", "cy"}) {
    EXPECT_TRUE(p.at("estimate").at(key).is_number());
    EXPECT_GT(p.at("estimate").at("sigma").at(key).get<double>(), 0);
  }
  EXPECT_EQ(p.at("estimate").at("projector_from_world").size(), 4u);
  EXPECT_TRUE(p.at("seconds").at("solve").is_number());
  EXPECT_NEAR(p.at("estimate").at("fx").get<double>(), 384,
              20 * p.at("estimate").at("sigma").at("fx").get<double>());
}

TEST(Command, CaptureDecodeCalibrateVerify) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml", small);
  const auto capture = laterna("capture s.toml -o cap", scratch.path());
  ASSERT_EQ(capture.exit_code, 0) << capture.err;
  EXPECT_EQ(listing(scratch / "cap"), "cam manifest.json matrices.json scene.toml truth ");
  std::filesystem::rename(scratch / "cap", scratch / "moved");  // self-contained: it can be moved
  std::filesystem::remove(scratch / "s.toml");
  const auto decode = laterna("decode moved -o decoded --json", scratch.path());
  ASSERT_EQ(decode.exit_code, 0) << decode.err;
  EXPECT_GT(json::parse(decode.out)["sequences"][0]["valid_percent"].get<double>(), 30);
  EXPECT_EQ(listing(scratch / "decoded"), "cam_left.exr ");
  const auto calibrate = laterna("calibrate moved -o e.json", scratch.path());
  ASSERT_EQ(calibrate.exit_code, 0) << calibrate.err << calibrate.out;
  const auto verify = laterna("verify moved/scene.toml e.json --json", scratch.path());
  ASSERT_EQ(verify.exit_code, 0) << verify.err;
  const json volume = json::parse(verify.out)["projectors"][0]["volume_error_px"];
  EXPECT_LE(volume["rms"].get<double>(), 3 * volume["predicted_rms"].get<double>());
}

TEST(Command, TheSameSeedGivesTheSamePictures) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml", small + "sensor = { noise_sigma_dn = 1.0 }\n");
  ASSERT_EQ(laterna("capture s.toml -o a --seed 5 --threads 1 --format tif", scratch.path()).exit_code, 0);
  ASSERT_EQ(laterna("capture s.toml -o b --seed 5 --threads 3 --format tif", scratch.path()).exit_code, 0);
  ASSERT_EQ(laterna("capture s.toml -o c --seed 6 --format tif", scratch.path()).exit_code, 0);
  const auto picture = [&](const char* folder) {
    return testing::read_text(scratch / folder / "cam/left/07.tif");
  };
  EXPECT_TRUE(picture("a") == picture("b"));
  EXPECT_FALSE(picture("a") == picture("c"));
}

TEST(Command, EveryPictureFormatKeepsWhatIsDecoded) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml", small + "sensor = { bit_depth = 12 }\n");
  std::string expected;
  for (const std::string format : {"png", "tif", "exr", "tif-pages"}) {
    const auto capture =
        laterna(fmt::format("capture s.toml --no-truth -o {0} --format {0}", format), scratch.path());
    ASSERT_EQ(capture.exit_code, 0) << capture.err;
    ASSERT_EQ(laterna(fmt::format("decode {0} -o {0}_map", format), scratch.path()).exit_code, 0);
    const std::string map = testing::read_text(scratch / (format + "_map/cam_left.exr"));
    if (expected.empty()) expected = map;
    EXPECT_TRUE(map == expected) << format;
  }
  EXPECT_EQ(listing(scratch / "tif-pages/cam/left"), "pages.tif ");
  const auto pgm = laterna("capture s.toml -o pgm --format pgm", scratch.path());
  EXPECT_EQ(pgm.exit_code, 2);
  EXPECT_THAT(pgm.err, HasSubstr("pgm holds 8 bits, but camera \"cam\" has 12"));
}

TEST(Command, PatternsForARealProjector) {
  const ScratchFolder scratch;
  ASSERT_EQ(laterna("patterns --size 64x48 -o p", scratch.path()).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(scratch / "p/graycode_25.png"));  // 2·6 + 2·6 + 2 pictures
  EXPECT_FALSE(std::filesystem::exists(scratch / "p/graycode_26.png"));
  const auto again = laterna("patterns --size 64x48 -o p", scratch.path());
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("exists"));
  EXPECT_EQ(laterna("patterns --size 64by48 -o q", scratch.path()).exit_code, 2);
  EXPECT_EQ(laterna("patterns --size 0x48 -o q", scratch.path()).exit_code, 2);
  EXPECT_EQ(listing(scratch.path()), "p ");
}

TEST(Command, EveryFamilyIsShownAndReadBack) {
  const ScratchFolder scratch;
  for (const char* words : {"--kind gray", "--kind xor_gray --xor-stripe-px 4", "--kind gray_phase --steps 5",
                            "--kind phase --pitch-px 40", "--kind multi_frequency --pitches-px 17,21.5,26",
                            "--kind micro_phase --pitch-px 20"}) {
    const std::string folder = "p" + std::to_string(std::string(words).size());
    ASSERT_EQ(laterna("patterns --size 160x100 -o " + folder + " " + words, scratch.path()).exit_code, 0)
        << words;
    const auto run =
        laterna("decode " + folder + " --projector-size 160x100 --json " + words, scratch.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json sequence = json::parse(run.out).at("sequences").at(0);
    // A crest at full scale leaves three of four steps; micro phase shifting has one picture to lose.
    EXPECT_GT(sequence.at("valid_percent"), 98) << words;
    EXPECT_EQ(sequence.at("orientation"), "upright") << words;
  }
  EXPECT_EQ(laterna("patterns --size 64x48 -o q --kind phase --steps 2", scratch.path()).exit_code, 2);
  EXPECT_EQ(laterna("patterns --size 64x48 -o q --kind phases", scratch.path()).exit_code, 2);
  EXPECT_EQ(laterna("decode p11 --projector-size 160x100 --kind phase", scratch.path()).exit_code, 2);
}

TEST(Command, RefusalsHaveTheirOwnExitCode) {
  const ScratchFolder scratch;
  std::string plane = small;
  plane.replace(plane.find("relief"), 6, "plane");
  write_text(scratch / "plane.toml", plane);
  const auto run = laterna("roundtrip plane.toml --json", scratch.path());
  EXPECT_EQ(run.exit_code, 3);
  const json p = json::parse(run.out).at("projectors").at(0);
  EXPECT_EQ(p.at("status"), "refused");
  EXPECT_THAT(p.at("reason").get<std::string>(), HasSubstr("plane"));
  EXPECT_TRUE(p.at("estimate").is_null());
  std::string thin = small;
  thin.replace(thin.find("0.7]"), 4, "0.0003]");
  write_text(scratch / "thin.toml", thin);
  const auto weak = laterna("roundtrip thin.toml --json", scratch.path());
  EXPECT_EQ(weak.exit_code, 4);
  EXPECT_EQ(json::parse(weak.out).at("projectors").at(0).at("status"), "weak");
}

TEST(Command, TheCommittedReferenceIsTheGeneratedOne) {
  const ScratchFolder scratch;
  const auto page = laterna("--command-reference", scratch.path());
  EXPECT_EQ(page.exit_code, 0);
  EXPECT_TRUE(testing::read_text(laterna::testing::data_folder() / "command-reference.md") == page.out)
      << "regenerate it: laterna --command-reference > data/command-reference.md";
}

TEST(Command, HelpBeginsWithAWorkingExample) {
  const ScratchFolder scratch;
  for (const char* name : {"new", "check", "info", "project", "preview", "live", "patterns", "capture",
                           "decode", "calibrate", "verify", "roundtrip", "report"}) {
    const auto help = laterna(std::string(name) + " --help", scratch.path());
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.out.find("Example: "), 0u) << help.out;
    EXPECT_THAT(help.out, HasSubstr(std::string("laterna ") + name));
  }
  EXPECT_EQ(laterna("--version", scratch.path()).exit_code, 0);
  EXPECT_EQ(laterna("frobnicate", scratch.path()).exit_code, 2);
  EXPECT_EQ(laterna("roundtrip", scratch.path()).exit_code, 2);
}

TEST(Command, AFullDiskLeavesNothing) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml", small);
  // No file may grow beyond 16 KiB, and the signal that says so is ignored: writes fail as on a full disk.
  const std::string full = "trap '' XFSZ; ulimit -f 32; ";
  for (const char* words :
       {"capture s.toml -o cap --format tif", "roundtrip s.toml -o out", "preview s.toml", "live s.toml"}) {
    const auto run = laterna(words, scratch.path(), "", full);
    EXPECT_EQ(run.exit_code, 2) << words;
    EXPECT_THAT(run.err, HasSubstr("File too large")) << words;
    EXPECT_EQ(listing(scratch.path()), "s.toml ") << words;
  }
}

struct Bad {
  const char* name;
  const char* from;  // text of `small` that is replaced...
  const char* to;    // ...by this
  const char* sentence;
};

class BadScene : public ::testing::TestWithParam<Bad> {};

TEST_P(BadScene, IsOneSentenceAndExitCode2) {
  const ScratchFolder scratch;
  const Bad& bad = GetParam();
  std::string text = small;
  ASSERT_NE(text.find(bad.from), std::string::npos);
  text.replace(text.find(bad.from), std::string(bad.from).size(), bad.to);
  write_text(scratch / "s.toml", text);
  write_text(scratch / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n");
  write_text(scratch / "empty.obj", "# nothing\n");
  write_text(
      scratch / "nan.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n");
  write_text(
      scratch / "flat.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  const std::string before = listing(scratch.path());
  const auto run = laterna("roundtrip s.toml -o out", scratch.path());
  EXPECT_EQ(run.exit_code, 2) << run.out << run.err;
  EXPECT_THAT(run.err, HasSubstr(bad.sentence));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(listing(scratch.path()), before);  // nothing half-written
}

const char* const relief_shape = "shape = \"relief\"\nshape_size = [1.6, 1.0, 0.7]\nseed = 7";

INSTANTIATE_TEST_SUITE_P(
    Command, BadScene,
    ::testing::Values(
        Bad{"MissingMesh", relief_shape, "file = \"none.ply\"", "none.ply"},
        Bad{"BrokenMesh", relief_shape, "file = \"broken.ply\"", "broken.ply"},
        Bad{"EmptyMesh", relief_shape, "file = \"empty.obj\"", "empty.obj"},
        Bad{"NanVertex", relief_shape, "file = \"nan.ply\"", "nan.ply"},
        Bad{"DegenerateTriangles", relief_shape, "file = \"flat.ply\"", "flat.ply"},
        Bad{"UnknownKey", "throw_ratio", "throw_ration", "did you mean \"throw_ratio\""},
        Bad{"WrongType", "throw_ratio = 1.2", "throw_ratio = \"far\"", "throw_ratio"},
        Bad{"ZeroSize", "[320, 200]", "[0, 200]", "size"},
        Bad{"AbsurdSize", "[320, 200]", "[3200000, 200]", "size"},
        Bad{"NonRotation", "position = [0.35, -0.1, 2.1]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]",
            "device_from_world = [[2,0,0,0],[0,1,0,0],[0,0,1,2]]", "rotation"},
        Bad{"NearBeyondFar", "throw_ratio = 1.2", "throw_ratio = 1.2\nnear = 3.0\nfar = 2.0", "near"},
        Bad{"SingularIntrinsics", "throw_ratio = 1.2\nlens_shift = [0.0, 0.1]", "fx = 0.0", "fx"},
        Bad{"NoToml", "[[mesh]]", "[[mesh", "s.toml"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Command, DamagedCapturesAreBadInput) {
  const ScratchFolder scratch;
  write_text(scratch / "s.toml", small);
  ASSERT_EQ(laterna("capture s.toml -o cap", scratch.path()).exit_code, 0);
  const auto calibrate_says = [&](const char* sentence) {
    const auto run = laterna("calibrate cap -o e.json", scratch.path());
    EXPECT_EQ(run.exit_code, 2) << sentence;
    EXPECT_THAT(run.err, HasSubstr(sentence));
    EXPECT_FALSE(std::filesystem::exists(scratch / "e.json"));
  };
  const auto picture = scratch / "cap/cam/left/05.png";
  std::filesystem::rename(picture, scratch / "kept.png");
  calibrate_says("05.png");
  write_text(picture, "not a picture");
  calibrate_says("05.png");
  ASSERT_EQ(laterna("patterns --size 64x48 -o p", scratch.path()).exit_code, 0);
  std::filesystem::copy_file(scratch / "p/graycode_00.png", picture,
                             std::filesystem::copy_options::overwrite_existing);
  calibrate_says("64");
  std::filesystem::rename(scratch / "kept.png", picture);
  EXPECT_EQ(laterna("calibrate cap -o e.json", scratch.path()).exit_code, 0);
  const auto exists = laterna("capture s.toml -o cap", scratch.path());
  EXPECT_EQ(exists.exit_code, 2);
  EXPECT_THAT(exists.err, HasSubstr("exists"));
}

TEST(Command, ChartKeepsItsContractAndItsCommandsReproduce) {
  const ScratchFolder scratch;
  write_text(scratch / "sweep.toml",
             "[[grid]]\nname = \"g\"\nkind = \"points\"\nseeds = 3\nmethods = [\"laterna\", \"dlt\"]\n"
             "points = [20, 50]\n");
  const auto run = laterna("chart sweep.toml -o out --json", scratch.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(listing(scratch / "out"), "chart.csv chart.json chart.svg journal.jsonl reference.json ");
  const json parsed = json::parse(run.out);
  ASSERT_EQ(parsed.at("points").size(), 4u);
  EXPECT_GE(parsed.at("pareto").size(), 1u);
  const json& point = parsed["points"][3];
  EXPECT_EQ(point.at("label"), "g: points=50 method=dlt");
  for (const char* key : {"error_px", "bound_px", "seconds", "spread_px"}) EXPECT_GT(point.at(key), 0) << key;
  const auto command = point.at("command").get<std::string>();
  ASSERT_TRUE(command.starts_with("laterna "));
  const auto again = laterna(command.substr(8) + " --json", scratch.path());
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(json::parse(again.out)["points"][0]["error_px"], point["error_px"]);
  EXPECT_EQ(laterna("chart sweep.toml -o out --json", scratch.path()).exit_code, 2);  // holds a run already
  EXPECT_EQ(laterna("chart sweep.toml -o out --resume --json", scratch.path()).out, run.out);
}

}  // namespace
}  // namespace laterna
