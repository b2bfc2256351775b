#include "apps/laterna/command.h"
#include "apps/laterna/scene_words.h"

#include "sim/error.h"
#include "sim/scene_file.h"

#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <vector>

namespace laterna {

namespace {

const Device& find_device(const Scene& scene, const std::string& name) {
  std::string known;
  for (const Projector& p : scene.projectors) {
    if (p.device.name == name) return p.device;
    known += " \"" + p.device.name + "\"";
  }
  for (const Camera& c : scene.cameras) {
    if (c.device.name == name) return c.device;
    known += " \"" + c.device.name + "\"";
  }
  throw InputError(fmt::format("--device: found \"{}\", expected one of{}", name, known));
}

// Three finite numbers and nothing else; blank lines are passed over.
bool parse_point(const std::string& line, std::size_t number, glm::dvec3& x) {
  if (line.find_first_not_of(" \t\r") == std::string::npos) return false;
  int used = 0;
  const bool three =
      std::sscanf(line.c_str(), "%lf %lf %lf %n", &x.x, &x.y, &x.z, &used) == 3 && used == int(line.size());
  if (!three || !std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z)) {
    throw InputError(
        fmt::format("standard input:{}: found \"{}\", expected three finite numbers `x y z`", number, line));
  }
  return true;
}

}  // namespace

void add_project(CLI::App& app, Common&) {
  struct Words {
    SceneWords scene;
    std::string device;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command =
      add_command(app, "project", "echo 0 0 0 | laterna project scene.toml --device projector",
                  "Reads world points `x y z` (metres), one a line, and prints `u v q`: pixel and axial "
                  "depth. u and v are nan where\n"
                  "q <= 0 or the lens fails; outside the image the numbers stand.");
  add_scene_words(*command, words->scene);
  command->add_option("--device", words->device, "Name of a projector or a camera")->required();
  command->callback([words] {
    const Scene scene = load_scene(words->scene.file, words->scene.set);
    const WorldProjection projection(find_device(scene, words->device));
    std::string line;
    std::vector<glm::dvec3> points;  // all are read before the first answer: bad input leaves no half of one
    glm::dvec3 point(0.0);
    for (std::size_t number = 1; std::getline(std::cin, line); ++number) {
      if (parse_point(line, number, point)) points.push_back(point);
    }
    for (const glm::dvec3& x : points) {
      const glm::dvec3 uvq = projection.project(x);
      const auto text = [](double value) {
        return std::isnan(value) ? std::string("nan") : fmt::format("{}", value);
      };
      fmt::print("{} {} {}\n", text(uvq.x), text(uvq.y), text(uvq.z));
    }
  });
}

}  // namespace laterna
