#include "apps/lab/classics/shader_projector.h"

#include "apps/lab/classics/demo.h"
#include "render/classic/vertex_values.h"
#include "sim/scene_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace laterna {

namespace {

/// (u, v) at each pixel with the divide where the vertex shader could have it, at the vertices, and s/q, t/q
/// between them.
PixelArray<glm::dvec4> divided_at_vertices(const ClassicDemo& demo) {
  const SurfaceMap& surface = demo.view.surface;
  std::vector<std::vector<glm::dvec4>> of_vertex;
  for (const Object& object : demo.scene.objects) {
    const Device& device = demo.projector().device;
    const glm::dmat4 t = texture_from_object(device.intrinsics, device.planes, device.device_from_world,
                                             object.world_from_object);
    std::vector<glm::dvec4>& values = of_vertex.emplace_back();
    for (const glm::dvec3& x : object.mesh.positions) {
      const glm::dvec4 strq = t * glm::dvec4(x, 1.0);
      values.push_back(strq / strq.w);
    }
  }
  PixelArray<glm::dvec4> out(surface.width, surface.height);
  for (std::size_t p = 0; p < out.values.size(); ++p) {
    out.values[p] = glm::dvec4(NAN);
    const std::uint32_t object = surface.object.values[p];
    if (surface.hit(p))
      out.values[p] = vertex_value(demo.scene.objects[object].mesh, of_vertex[object], surface, p);
  }
  return out;
}

void show_divide(const ClassicDemo& demo, ClassicResult& result) {
  const auto per_vertex = divided_at_vertices(demo);
  Image<double> wrong(per_vertex.width, per_vertex.height, demo.scene.ambient_lx / demo.full_lx);
  for (std::size_t p = 0; p < wrong.values.size(); ++p) {
    if (!demo.view.surface.hit(p)) wrong.values[p] = 0;
    if (survives(per_vertex.values[p], {.q = true, .st = true, .r = false}))
      wrong.values[p] += demo.white_lx / demo.full_lx *
                         slide_value(demo.slide, per_vertex.values[p], Lookup::nearest, Wrap::clamp_to_edge);
  }
  result.pictures.push_back(
      {"shader_projector_divide",
       side_by_side({{"divide per fragment", shown(demo.passes({.back_face = false}).back())},
                     {"divide per vertex", shown(wrong)}},
                    2)});
  result.figures.insert(
      result.figures.end(),
      {{"divide per fragment to the core's (u, v), greatest",
        demo.core_distance_px(demo.coordinates(CoordinateSource::given)), "px", 1e-9},
       {"divide per vertex to the core's (u, v), greatest", demo.core_distance_px(per_vertex), "px", 0.01}});
}

// A near plane that crosses what the camera sees: between projector and plane q > 0, but r < 0.
void show_planes(const std::filesystem::path& file, ClassicResult& result) {
  const ClassicDemo demo(file, {"projector.near=3.4"});
  const auto strq = demo.coordinates(CoordinateSource::given);
  std::size_t q = 0, r = 0, disagree = 0;
  for (std::size_t p = 0; p < strq.values.size(); ++p) {
    if (!demo.view.surface.hit(p)) continue;
    q += strq.values[p].w > 0, r += strq.values[p].z > 0;
    const auto why = Unlit(demo.view.lights[0].why.values[p]);
    disagree += (strq.values[p].w > 0 && !(strq.values[p].z > 0)) != (why == Unlit::before_near);
  }
  const auto picture = [&](bool with_r) { return shown(demo.passes({.tests = {.r = with_r}}).back()); };
  result.pictures.push_back(
      {"shader_projector_planes",
       side_by_side({{"q > 0", picture(false)}, {"r > 0: the near plane", picture(true)}}, 2)});
  result.figures.insert(
      result.figures.end(),
      {{"near plane at 3.4 m: pixels with q > 0", double(q), "", 5},
       {"near plane at 3.4 m: pixels with r > 0", double(r), "", 5},
       {"pixels where q > 0 and not r > 0 is not the core's near plane", double(disagree), "", 0}});
}

/// The second camera: the same one, gone a step to the side.
const std::vector<std::string> moved = {"camera.position=[0.4, -4.3, 2.6]"};

/// The lit pixels' world points in one picture, projected again: their (u, v) against those that the slide
/// had there.
double drift_px(const ClassicDemo& demo, const Projector& other) {
  const WorldProjection projection(other.device);
  const auto points = points_world(demo.view.surface, demo.scene);
  const LightMap& light = demo.view.lights[0];
  double most = 0;
  for (std::size_t p = 0; p < points.values.size(); ++p)
    if (light.lit(p))
      most = std::max(most, glm::distance(glm::dvec2(projection.project(points.values[p])),
                                          {light.u_px.values[p], light.v_px.values[p]}));
  return most;
}

/// The scene with its projector at the camera's eye, looking where it looks.
Scene at_the_eye(const std::filesystem::path& file, const std::vector<std::string>& set) {
  Scene scene = load_scene(file, set);
  Device& projector = scene.projectors[0].device;
  projector.device_from_world = scene.cameras[0].device.device_from_world;
  projector.intrinsics = intrinsics_from_fov_y(projector.intrinsics.size, glm::radians(28.0), 1);
  return scene;
}

/// From a projector at the eye the slide stands still in the picture: u and v are a line in the camera's x
/// and y, whatever the surface. The greatest distance from that line.
double eye_distance_px(const ClassicDemo& demo) {
  const Intrinsics &c = demo.scene.cameras[0].device.intrinsics, &k = demo.projector().device.intrinsics;
  const LightMap& light = demo.view.lights[0];
  double most = 0;
  for (std::size_t p = 0; p < light.why.values.size(); ++p) {
    if (!light.lit(p)) continue;
    const double x = (double(p % std::size_t(light.width)) - c.cx) / c.fx,
                 y = (double(p / std::size_t(light.width)) - c.cy) / c.fy;
    most = std::max(
        most, std::hypot(light.u_px.values[p] - (k.fx * x + k.cx), light.v_px.values[p] - (k.fy * y + k.cy)));
  }
  return most;
}

void show_fixed(const ClassicDemo& demo, const std::filesystem::path& file, ClassicResult& result) {
  const ClassicDemo world_after(file, moved);
  const ClassicDemo eye_before(at_the_eye(file, {})), eye_after(at_the_eye(file, moved));
  result.pictures.push_back(
      {"shader_projector_fixed", side_by_side({{"fixed in the world", shown(demo.core())},
                                               {"the camera moves", shown(world_after.core())},
                                               {"fixed to the eye", shown(eye_before.core())},
                                               {"the camera moves", shown(eye_after.core())}},
                                              2)});
  result.figures.insert(result.figures.end(),
                        {{"fixed in the world: (u, v) of a point after the camera moved, greatest change",
                          drift_px(world_after, demo.projector()), "px", 1e-9},
                         {"fixed to the eye: (u, v) of a point after the camera moved, greatest change",
                          drift_px(eye_after, eye_before.projector()), "px", 1},
                         {"fixed to the eye: the slide's place in the picture, greatest change",
                          std::max(eye_distance_px(eye_before), eye_distance_px(eye_after)), "px", 1e-8}});
}

void show_occlusion(const ClassicDemo& demo, const std::filesystem::path& file, ClassicResult& result) {
  const ClassicDemo cured(file, {"effects.shadow=true"});
  std::size_t through = 0, lit = 0, lost = 0;
  for (std::size_t p = 0; p < demo.view.lights[0].why.values.size(); ++p) {
    const auto why = Unlit(cured.view.lights[0].why.values[p]);
    through += demo.view.lights[0].lit(p) && why == Unlit::shadow;
    lit += demo.view.lights[0].lit(p);
    lost += demo.view.lights[0].lit(p) && why != Unlit::shadow && why != Unlit::lit;
  }
  result.pictures.push_back(
      {"shader_projector_occlusion",
       side_by_side({{"no occlusions", shown(demo.core())}, {"shadow = true", shown(cured.core())}}, 2)});
  result.figures.insert(result.figures.end(),
                        {{"share of lit pixels that the slide reaches through other things",
                          double(through) / double(lit), "", 1e-3},
                         {"pixels that the cure darkens without an occluder", double(lost), "", 0}});
}

}  // namespace

ClassicResult shader_projector(const std::filesystem::path& scenes) {
  const std::filesystem::path file = scenes / "shader_projector.toml";
  const ClassicDemo demo(file);
  ClassicResult result;
  result.pictures.push_back({"shader_projector", shown(demo.core())});
  show_divide(demo, result);
  show_planes(file, result);
  show_fixed(demo, file, result);
  show_occlusion(demo, file, result);
  return result;
}

}  // namespace laterna
