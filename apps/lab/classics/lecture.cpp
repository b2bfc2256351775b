#include "apps/lab/classics/lecture.h"

#include "apps/lab/classics/demo.h"
#include "render/bake.h"
#include "render/classic/shadow_map.h"
#include "sim/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace laterna {

namespace {

/// The photograph that the camera takes, and each object's texture made of it.
struct Reprojected {
  Image<float> photograph;  ///< cd/m²
  std::vector<BakedTexture> textures;
};

Reprojected reproject(const ClassicDemo& demo, int texels) {
  Reprojected out{core_picture(demo.view), {}};
  for (std::uint32_t object = 0; object < demo.scene.objects.size(); ++object)
    out.textures.push_back(
        bake_photograph(demo.view.rays, demo.scene, object, demo.scene.cameras[0], out.photograph, texels));
  return out;
}

/// The scene with each object's texture in place of its albedo, in uniform light alone: luminance is the
/// texture's value.
Scene wearing(const Scene& scene, const std::vector<BakedTexture>& textures) {
  Scene out = scene;
  for (std::size_t k = 0; k < textures.size(); ++k) {
    out.objects[k].albedo = 1;
    out.objects[k].albedo_map = std::make_shared<Image<float>>(textures[k].value);
  }
  out.ambient_lx = std::numbers::pi;
  for (Projector& projector : out.projectors) projector.flux_lm = 1e-9;
  return out;
}

double rms_dn(const Image<float>& a, const Image<float>& b, double white) {
  double sum = 0;
  for (std::size_t p = 0; p < a.values.size(); ++p)
    sum += std::pow(255 * (double(a.values[p]) - b.values[p]) / white, 2);
  return std::sqrt(sum / double(a.values.size()));
}

double peak(const Image<float>& image) { return std::ranges::max(image.values); }

void show_reprojection(const ClassicDemo& demo, ClassicResult& result) {
  const double white = peak(core_picture(demo.view));
  std::vector<Panel> panels;
  for (const int texels : {256, 512, 1024}) {
    const Reprojected made = reproject(demo, texels);
    const Scene worn = wearing(demo.scene, made.textures);
    const Image<float> again = core_picture(CoreView(worn));
    if (panels.empty()) panels.push_back({"the photograph", grey_canvas(made.photograph, white)});
    panels.push_back({fmt::format("taken again, {} texels", texels), grey_canvas(again, white)});
    result.figures.push_back({fmt::format("photograph taken again, {} texels: rms", texels),
                              rms_dn(made.photograph, again, white), "DN", 0.02});
  }
  result.pictures.push_back({"lecture_photograph", side_by_side(panels, 2)});
}

/// The scene from the other side of the projector, and all albedos 1, so that its luminance is its light.
const std::vector<std::string> other_camera = {"camera.position=[0.2, -4.2, 3.0]",
                                               "camera.look_at=[0.1, 0.8, 0.6]"};

// The light of the first camera's scene, kept as textures, seen from another place; against light computed
// there.
void show_light_map(const ClassicDemo& demo, const std::filesystem::path& file, ClassicResult& result) {
  const Reprojected light_maps = reproject(demo, 1024);
  const ClassicDemo there(file, other_camera);
  const Image<float> direct = core_picture(there.view);
  const Scene worn = wearing(there.scene, light_maps.textures);
  const CoreView reused(worn);
  Image<float> baked = core_picture(reused);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t p = 0; p < baked.values.size(); ++p) {
    if (!(baked.values[p] > 0)) continue;  // the first camera did not see it
    sum += std::pow((baked.values[p] - direct.values[p]) / peak(direct), 2), ++count;
  }
  result.pictures.push_back(
      {"lecture_light_map", side_by_side({{"computed there", grey_canvas(direct, peak(direct))},
                                          {"light maps of the first view", grey_canvas(baked, peak(direct))}},
                                         2)});
  result.figures.insert(result.figures.end(), {{"light maps from another place: rms share of the brightest",
                                                std::sqrt(sum / double(count)), "", 2e-3},
                                               {"light maps from another place: share of the picture",
                                                double(count) / double(baked.values.size()), "", 2e-3}});
}

/// Pixels that would be lit but for a shadow, and how many of them a shadow map judges otherwise than shadow
/// rays.
double wrong_share(const ClassicDemo& demo, const ShadowMap& map, double bias_m) {
  const LightMap& light = demo.view.lights[0];
  const WorldProjection projection(demo.projector().device);
  const auto points = points_world(demo.view.surface, demo.scene);
  std::size_t judged = 0, wrong = 0;
  for (std::size_t p = 0; p < points.values.size(); ++p) {
    const auto why = Unlit(light.why.values[p]);
    if (why != Unlit::lit && why != Unlit::shadow) continue;
    const glm::dvec3 at = projection.project(points.values[p]);
    ++judged;
    wrong += lit_by(map, glm::dvec2(at), demo.projector().device.intrinsics.size, at.z, bias_m) !=
             (why == Unlit::lit);
  }
  return double(wrong) / double(judged);
}

Image<double> by_shadow_map(const ClassicDemo& open, const ShadowMap& map, double bias_m) {
  Image<double> picture = open.core();
  const WorldProjection projection(open.projector().device);
  const auto points = points_world(open.view.surface, open.scene);
  const double ambient = open.scene.ambient_lx / open.full_lx;
  for (std::size_t p = 0; p < picture.values.size(); ++p) {
    if (!open.view.lights[0].lit(p)) continue;
    const glm::dvec3 at = projection.project(points.values[p]);
    if (!lit_by(map, glm::dvec2(at), open.projector().device.intrinsics.size, at.z, bias_m))
      picture.values[p] = ambient;
  }
  return picture;
}

void show_shadow_map(const ClassicDemo& demo, const std::filesystem::path& file, ClassicResult& result) {
  LineChart chart{"lecture_shadow_map",
                  "A shadow map of n x n texels against shadow rays",
                  "n, texels a side",
                  "share of pixels judged wrongly",
                  {}};
  for (const double bias_m : {0.0, 0.002, 0.01, 0.05})
    chart.series.push_back({fmt::format("bias {:g} mm", 1000 * bias_m), {}, 0.02});
  for (const int n : {64, 128, 256, 512, 1024, 2048}) {
    const ShadowMap map = make_shadow_map(demo.view.rays, demo.scene, demo.projector(), n);
    std::size_t k = 0;
    for (const double bias_m : {0.0, 0.002, 0.01, 0.05})
      chart.series[k++].points.emplace_back(n, wrong_share(demo, map, bias_m));
  }
  const ClassicDemo open(file, {"effects.shadow=false"});
  const double white = std::ranges::max(open.core().values);
  const ShadowMap coarse = make_shadow_map(demo.view.rays, demo.scene, demo.projector(), 256);
  const auto panel = [&](double bias_m) { return shown(by_shadow_map(open, coarse, bias_m), white); };
  result.pictures.push_back(
      {"lecture_shadow_map_acne", side_by_side({{"256 x 256, no bias", panel(0)},
                                                {"256 x 256, bias 10 mm", panel(0.01)},
                                                {"256 x 256, bias 300 mm: light leaks", panel(0.3)},
                                                {"shadow rays", shown(demo.core(), white)}},
                                               2)});
  result.figures.insert(
      result.figures.end(),
      {{"shadow map of 256 x 256, no bias: judged wrongly", chart.series[0].points[2].second, "", 0.01},
       {"shadow map of 256 x 256, bias 10 mm: judged wrongly", chart.series[2].points[2].second, "", 2e-3},
       {"shadow map of 2048 x 2048, bias 2 mm: judged wrongly", chart.series[1].points[5].second, "", 1e-3}});
  result.charts.push_back(std::move(chart));
}

// Phong's sum: ambient, diffuse and specular light, each alone and together; the highlight where the mirror
// has it.
const std::string phong = "{model=\"phong\", strength=0.1, exponent=60}";

double highlight_off_mirror_deg(const ClassicDemo& whole, const ClassicDemo& matt) {
  const Image<double> glossy = whole.core(), plain = matt.core();
  const auto points = points_world(whole.view.surface, whole.scene);
  const auto normals = normals_world(whole.view.surface, whole.view.rays);
  std::size_t brightest = 0;
  double most = 0;
  for (std::size_t p = 0; p < points.values.size(); ++p)
    if (whole.view.surface.object.values[p] == 3 && glossy.values[p] - plain.values[p] > most)
      most = glossy.values[p] - plain.values[p], brightest = p;
  const glm::dvec3 x = points.values[brightest], n = normals.values[brightest];
  const glm::dvec3 l = glm::normalize(center_in_world(whole.projector().device.device_from_world) - x);
  const glm::dvec3 v = glm::normalize(center_in_world(whole.scene.cameras[0].device.device_from_world) - x);
  return glm::degrees(std::acos(std::clamp(glm::dot(glm::reflect(-l, n), v), -1.0, 1.0)));
}

void show_phong(const std::filesystem::path& file, ClassicResult& result) {
  const std::vector<std::string> white_light = {"effects.slide=false", "patterns.kind=\"gray\""};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), white_light.begin(), white_light.end());
    return more;
  };
  const std::vector<std::string> gloss = with({"effects.gloss=true", "mesh.3.gloss=" + phong});
  const ClassicDemo whole(file, gloss), matt(file, white_light);
  const ClassicDemo ambient(file, with({"projector.flux_lm=1e-9"})), diffuse(file, with({"ambient_lx=0"}));
  const ClassicDemo specular(
      file, with({"effects.gloss=true", "mesh.3.gloss=" + phong, "ambient_lx=0", "mesh.3.albedo=0"}));
  const auto luminance = [](const ClassicDemo& demo) { return core_picture(demo.view); };
  const Image<float> sum = luminance(whole), a = luminance(ambient), d = luminance(diffuse);
  Image<float> s = luminance(specular);
  double apart = 0;
  for (std::size_t p = 0; p < sum.values.size(); ++p) {
    if (whole.view.surface.object.values[p] != 3) s.values[p] = 0;  // the rest of the room is not glossy
    apart = std::max(apart, std::abs(double(sum.values[p]) - a.values[p] - d.values[p] - s.values[p]));
  }
  const double white = peak(sum);
  result.pictures.push_back({"lecture_phong", side_by_side({{"ambient", grey_canvas(a, white)},
                                                            {"diffuse", grey_canvas(d, white)},
                                                            {"specular", grey_canvas(s, white)},
                                                            {"the sum", grey_canvas(sum, white)}},
                                                           2)});
  result.figures.insert(result.figures.end(),
                        {{"Phong: whole to ambient + diffuse + specular, greatest share of the brightest",
                          apart / white, "", 1e-5},
                         {"Phong: the highlight from the mirror direction",
                          highlight_off_mirror_deg(whole, matt), "deg", 0.5}});
}

/// Pixels of the ball in one picture and not in the other.
double outline_moved(const ClassicDemo& a, const ClassicDemo& b) {
  std::size_t count = 0;
  for (std::size_t p = 0; p < a.view.surface.object.values.size(); ++p)
    count += (a.view.surface.object.values[p] == 3) != (b.view.surface.object.values[p] == 3);
  return double(count);
}

void show_surfaces(const ClassicDemo& demo, const std::filesystem::path& file, ClassicResult& result) {
  const ClassicDemo solid(
      file, {"effects.solid_albedo=true", "mesh.3.solid={kind=\"checker\", cell=0.12, low=0.2}"});
  const ClassicDemo bump(file, {"effects.normal_map=true", "mesh.3.normal_map=\"slides/dents_normals.png\""});
  const ClassicDemo raised(file, {"effects.displacement=true", "mesh.3.displacement_map=\"slides/dents.png\"",
                                  "mesh.3.displacement=0.08", "mesh.3.displacement_edge_px=2"});
  const double white = std::ranges::max(demo.core().values);
  result.pictures.push_back(
      {"lecture_surfaces", side_by_side({{"the plain ball", shown(demo.core(), white)},
                                         {"solid texture", shown(solid.core(), white)},
                                         {"bump map", shown(bump.core(), white)},
                                         {"displacement map", shown(raised.core(), white)}},
                                        2)});
  result.figures.insert(
      result.figures.end(),
      {{"solid texture: pixels of the ball's outline that moved", outline_moved(demo, solid), "", 0},
       {"bump map: pixels of the ball's outline that moved", outline_moved(demo, bump), "", 0},
       {"displacement map: pixels of the ball's outline that moved", outline_moved(demo, raised), "", 20}});
}

/// Of pixels that `cured` leaves dark for this reason, those that `faulty` lights.
double share_of(const ClassicDemo& cured, const Image<double>& faulty, Unlit reason) {
  const Image<double> right = cured.core();
  std::size_t count = 0;
  for (std::size_t p = 0; p < right.values.size(); ++p)
    count += Unlit(cured.view.lights[0].why.values[p]) == reason && faulty.values[p] > right.values[p] + 1e-6;
  return double(count) / double(right.values.size());
}

// Reverse projection (no test of q) and penetration (no shadow), on the projected-light tutorial's and this
// room.
void show_faults(const ClassicDemo& demo, const std::filesystem::path& scenes, ClassicResult& result) {
  const ClassicDemo open(scenes / "lecture.toml", {"effects.shadow=false"});
  const ClassicDemo torch(scenes / "projected_light.toml");
  const Image<double> reversed = torch.passes({.tests = {.q = false, .r = false}, .back_face = false}).back();
  const Image<double> penetrated = open.core();
  const double white = std::ranges::max(penetrated.values);
  result.pictures.push_back(
      {"lecture_penetration",
       side_by_side(
           {{"penetration", shown(penetrated, white)}, {"cured by shadows", shown(demo.core(), white)}}, 2)});
  result.pictures.push_back(
      {"lecture_reverse",
       side_by_side({{"reverse projection", shown(reversed)}, {"cured by q > 0", shown(torch.core())}}, 2)});
  result.figures.insert(
      result.figures.end(),
      {{"penetration: share of the picture", share_of(demo, penetrated, Unlit::shadow), "", 1e-3},
       {"penetration, cured", share_of(demo, demo.core(), Unlit::shadow), "", 0},
       {"reverse projection: share of the picture", share_of(torch, reversed, Unlit::behind), "", 1e-3},
       {"reverse projection, cured", share_of(torch, torch.core(), Unlit::behind), "", 0}});
}

}  // namespace

ClassicResult lecture(const std::filesystem::path& scenes) {
  const std::filesystem::path file = scenes / "lecture.toml";
  const ClassicDemo demo(file);
  ClassicResult result;
  result.pictures.push_back({"lecture", shown(demo.core(), std::ranges::max(demo.core().values))});
  show_reprojection(demo, result);
  show_light_map(demo, file, result);
  show_shadow_map(demo, file, result);
  show_phong(file, result);
  show_surfaces(demo, file, result);
  show_faults(demo, scenes, result);
  return result;
}

}  // namespace laterna
