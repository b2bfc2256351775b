#include "apps/laterna/command.h"

#include "apps/lab/bop_export.h"
#include "apps/lab/capture_cloud.h"
#include "apps/lab/capture_export.h"
#include "apps/lab/cloud_table.h"
#include "sim/error.h"
#include "sim/formats/rig_file.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

struct Words {
  std::string from, to, as, from_format, camera_size, projector_size, rig;
  double unit_m = 1, to_unit_m = 1;
  bool decoded = false;
  std::size_t most_points = 2000;
  CaptureExport capture;
};

std::string formats_text() {
  std::string text =
      "A calibration of one kind as another, a capture folder as the pictures that other calibrators read, "
      "or as a "
      "cloud of\npoints. FROM is recognised by its ending and content, TO by its ending or --as. "
      "Calibrations:\n";
  for (const RigFormat& format : rig_formats())
    text += fmt::format("  {:<14} {:<13} {}\n", format.name, format.ending, format.sentence);
  return text +
         "Of a capture folder (or a folder of several: a board's places), into a new folder:\n"
         "  procam                       capture_N/graycode_NN.png of procam-calibration\n"
         "  scan3d                       set_NN/cam_NN.png and projector_info.txt of scan3d-capture\n"
         "  slstudio                     frameSeq_NN/frameSeq_NN.bmp of SLStudio\n"
         "  vnl                          corners.vnl of mrcal's tools, with --board\n"
         "  bop                          a scene of BOP's: cameras, poses, depth, gray, masks and models\n"
         "  ply            .ply          the points that were lit: of the truth, or --decoded and "
         "intersected\n"
         "Of a cloud of points (PLY) with camera_u and camera_v, projector_u and projector_v, or both:\n"
         "  csv            .csv          up to --points of them, as `laterna calibrate` reads them: one "
         "pose\n"
         "Of a scene's folder of BOP's, into a new folder:\n"
         "  exr                          depth and objects as layers, the camera in the header";
}

glm::ivec2 size_of(const std::string& text, const char* option) {
  if (text.empty()) return {0, 0};
  const auto size = parse_size(text, option);
  return {size[0], size[1]};
}

RigReadOptions read_options(const Words& words) {
  if (!(words.unit_m > 0 && words.to_unit_m > 0)) throw InputError("--unit: expected metres above 0");
  return {words.from_format, words.unit_m, size_of(words.camera_size, "--camera-size"),
          size_of(words.projector_size, "--projector-size")};
}

// A calibration; what its reader had to say goes to the notes.
Rig rig_of(const std::string& path, const Words& words, Notes& notes) {
  Rig rig = read_rig(path, read_options(words));
  notes.insert(notes.end(), rig.notes.begin(), rig.notes.end());
  return rig;
}

void convert_cloud(const Words& words, Notes& notes) {
  const CloudOptions options{words.capture.camera, words.capture.projector};
  const auto points =
      words.decoded ? decoded_cloud(words.from,
                                    rig_of(words.rig.empty() ? words.from : words.rig, words, notes), options)
                    : true_cloud(words.from, options);
  write_file(words.to, std::string_view(point_cloud_ply(points)));
}

void convert_points(const Words& words, Notes& notes) {
  if (!(words.unit_m > 0 && words.to_unit_m > 0)) throw InputError("--unit: expected metres above 0");
  PointCloud cloud = read_point_cloud(std::filesystem::path(words.from));
  for (CloudPoint& p : cloud.points) p.x_world *= words.unit_m / words.to_unit_m;
  if (cloud.points.size() > words.most_points)
    notes.push_back(fmt::format("{} of {} points are kept, evenly spread (--points)", words.most_points,
                                cloud.points.size()));
  write_file(words.to, std::string_view(cloud_table(cloud, words.most_points, words.from)));
}

// A capture into a scene of BOP's, or such a scene into layers.
bool wants_bop(const Words& words) {
  namespace fs = std::filesystem;
  return words.as == "bop"
             ? fs::exists(fs::path(words.from) / "manifest.json") && !fs::path(words.to).has_extension()
             : words.as == "exr" && is_bop_scene(words.from);
}

void convert_bop(const Words& words, Notes& notes) {
  if (words.as == "exr") return write_bop_layers(words.to, read_bop_scene(words.from));
  PendingFolder folder(words.to);
  const BopScene scene = bop_scene(words.from, notes);
  write_bop_scene(folder.path(), scene.pictures, notes);
  write_bop_models(folder.path(), scene.models);
  folder.commit();
}

// A folder of pictures where TO has no ending and FROM is no calibration.
bool wants_pictures(const Words& words) {
  return words.as == "vnl" || (is_capture_layout(words.as) && std::filesystem::is_directory(words.from) &&
                               !std::filesystem::path(words.to).has_extension());
}

Notes convert(const Words& words, const Common& common) {
  Notes notes;
  if (std::filesystem::exists(words.to))
    throw InputError(words.to + ": is there already, expected a new name");
  if (words.as == "ply" || (words.as.empty() && words.to.ends_with(".ply"))) {
    convert_cloud(words, notes);
  } else if (is_ply_file(words.from) &&
             (words.as == "csv" || (words.as.empty() && words.to.ends_with(".csv")))) {
    convert_points(words, notes);
  } else if (wants_bop(words)) {
    convert_bop(words, notes);
  } else if (wants_pictures(words)) {
    CaptureExport what = words.capture;
    what.layout = words.as;
    export_capture(words.from, words.to, what, notes,
                   [&](const std::string& line) { progress(common, line); });
  } else {
    const Rig rig = rig_of(words.from, words, notes);
    write_rig(words.to, rig_texts(rig, words.to, words.as, words.to_unit_m, notes));
  }
  return notes;
}

}  // namespace

void add_convert(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command =
      add_command(app, "convert", "laterna convert scene.toml calibration.yml --as scan3d", formats_text());
  command->add_option("FROM", words->from, "Calibration, scene, capture folder or cloud of points")
      ->required();
  command->add_option("TO", words->to, "New file or folder")->required();
  command->add_option("--as", words->as, "TO's format, by its name above (default: by its ending)");
  command->add_option("--from", words->from_format, "FROM's format (default: by its content)");
  command
      ->add_option("--unit", words->unit_m, "Metres in one unit of FROM, such as 0.001, where it says none")
      ->capture_default_str();
  command->add_option("--to-unit", words->to_unit_m, "Metres in one unit of TO, where it says none")
      ->capture_default_str();
  command->add_option("--camera-size", words->camera_size,
                      "WIDTHxHEIGHT of cameras where FROM does not say it");
  command->add_option("--projector-size", words->projector_size, "WIDTHxHEIGHT of projectors likewise");
  command->add_option("--camera", words->capture.camera,
                      "Of a capture: whose pictures (default: the only one's)");
  command->add_option("--projector", words->capture.projector,
                      "Of a capture: whose patterns (default: likewise)");
  command->add_option("--board", words->capture.board, "vnl: the printed board, such as chessboard,9x6,30mm");
  command->add_flag("--decoded", words->decoded, "ply: points from decoded pictures, not from the truth");
  command->add_option("--rig", words->rig,
                      "ply --decoded: the calibration to intersect with (default: the scene)");
  command->add_option("--points", words->most_points, "csv: how many points are kept at most")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->callback([words, &common] {
    const Notes notes = convert(*words, common);
    if (common.json) {
      fmt::print("{}\n", nlohmann::json{{"written", words->to}, {"warnings", notes}}.dump());
      return;
    }
    for (const std::string& note : notes) fmt::print("note: {}\n", note);
    fmt::print("open {}\n", words->to);
  });
}

}  // namespace laterna
