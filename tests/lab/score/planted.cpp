#include "tests/lab/score/planted.h"

#include "calib/refine.h"
#include "calib/solve.h"
#include "sim/rq.h"

#include <cmath>
#include <utility>

namespace laterna::testing {

namespace {

using Random = std::mt19937_64;
using Edit = std::function<void(Device&)>;

Planted of_projector(const char* suspect, const char* how, const Edit& edit) {
  return {suspect, how, [edit](Rig& r, const CalibratedRig&, Random&) { edit(r.projectors[0]); }};
}

Planted of_all(const char* suspect, const char* how, const Edit& edit) {
  return {suspect, how, [edit](Rig& r, const CalibratedRig&, Random&) {
            edit(r.projectors[0]);
            edit(r.cameras[0]);
          }};
}

// Edits projector_from_camera, and leaves the camera where it stands.
Planted of_pair(const char* suspect, const char* how, const std::function<Rigid(const Rigid&)>& edit) {
  return {suspect, how, [edit](Rig& r, const CalibratedRig&, Random&) {
            const Rigid camera = r.cameras[0].device_from_world;
            Rigid& projector = r.projectors[0].device_from_world;
            projector = compose(edit(compose(projector, inverse(camera))), camera);
          }};
}

glm::dmat3 signs(double x, double y, double z) { return {x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z}; }

void turn(Device& d, const glm::dmat3& m) {
  d.device_from_world = {m * d.device_from_world.rotation, m * d.device_from_world.translation};
}

Rigid transposed(const Rigid& m) { return {glm::transpose(m.rotation), m.translation}; }

Rigid transposed_in_place(const Rigid& m) {
  const glm::dmat3 rotation = glm::transpose(m.rotation);
  return {rotation, -(rotation * center_in_world(m))};
}

void add_sizes(std::vector<Planted>& all) {
  const auto size = [](Intrinsics& k) { std::swap(k.size.x, k.size.y); };
  const auto centre = [](Intrinsics& k) { std::swap(k.cx, k.cy); };
  const auto focal = [](Intrinsics& k) { std::swap(k.fx, k.fy); };
  const char* name = "size_swapped";
  all.push_back(of_projector(name, "size", [=](Device& d) { size(d.intrinsics); }));
  all.push_back(of_projector(name, "centre", [=](Device& d) { centre(d.intrinsics); }));
  all.push_back(
      of_projector(name, "size, centre", [=](Device& d) { size(d.intrinsics), centre(d.intrinsics); }));
  all.push_back(of_projector(name, "size, centre, focal", [=](Device& d) {
    size(d.intrinsics), centre(d.intrinsics), focal(d.intrinsics);
  }));
  all.push_back(of_projector(name, "other middle", [=](Device& d) {
    const double half = (d.intrinsics.size.x - d.intrinsics.size.y) / 2.0;
    d.intrinsics.cx -= half, d.intrinsics.cy += half;
  }));
}

void add_pixels(std::vector<Planted>& all) {
  for (const double half : {0.5, -0.5})
    all.push_back(of_projector("half_pixel", half > 0 ? "+" : "-",
                               [=](Device& d) { d.intrinsics.cx += half, d.intrinsics.cy += half; }));
  const glm::dmat3 opengl = signs(1, -1, -1);
  const char* name = "y_flipped";
  all.push_back(of_projector(name, "cy",
                             [](Device& d) { d.intrinsics.cy = d.intrinsics.size.y - 1 - d.intrinsics.cy; }));
  all.push_back(of_projector(name, "cy from the edge",
                             [](Device& d) { d.intrinsics.cy = d.intrinsics.size.y - d.intrinsics.cy; }));
  all.push_back(of_projector(name, "OpenGL frame", [=](Device& d) { turn(d, opengl); }));
  all.push_back(of_all(name, "OpenGL frames", [=](Device& d) { turn(d, opengl); }));
  all.push_back(of_projector(name, "rows counted upwards, behind", [=](Device& d) {
    d.intrinsics.cy = d.intrinsics.size.y - 1 - d.intrinsics.cy;
    if (d.lens.parameters.size() >= 4) d.lens.parameters[2] = -d.lens.parameters[2];
    turn(d, signs(-1, 1, -1));
  }));
}

void add_poses(std::vector<Planted>& all) {
  const auto invert = [](Device& d) { d.device_from_world = inverse(d.device_from_world); };
  all.push_back(of_projector("inverse_pose", "projector", invert));
  all.push_back(of_all("inverse_pose", "all", invert));
  all.push_back(of_pair("inverse_pose", "pair", [](const Rigid& m) { return inverse(m); }));
  const char* name = "rotation_transposed";
  all.push_back(of_projector(name, "projector",
                             [](Device& d) { d.device_from_world = transposed(d.device_from_world); }));
  all.push_back(of_projector(name, "projector, in place", [](Device& d) {
    d.device_from_world = transposed_in_place(d.device_from_world);
  }));
  all.push_back(
      of_all(name, "all", [](Device& d) { d.device_from_world = transposed(d.device_from_world); }));
  all.push_back(of_pair(name, "pair", transposed));
  for (const double unit : {1e3, 1e-3, 1e2, 1e-2, 1 / 0.0254}) {
    const auto scale = [unit](Device& d) { d.device_from_world.translation *= unit; };
    all.push_back(of_projector("unit_scale", "projector", scale));
    all.push_back(of_all("unit_scale", "all", scale));
  }
}

void add_exchanges(std::vector<Planted>& all) {
  const glm::dmat3 rows(glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1));
  const auto add = [&](const char* how, const glm::dmat3& turned) {
    all.push_back(of_projector("axes_exchanged", how, [=](Device& d) {
      std::swap(d.intrinsics.fx, d.intrinsics.fy), std::swap(d.intrinsics.cx, d.intrinsics.cy);
      auto& lens = d.lens.parameters;
      if (lens.size() >= 4) std::swap(lens[2], lens[3]);
      turn(d, turned);
    }));
  };
  add("behind", -rows);
  add("z turned", rows * signs(1, 1, -1));
  add("quarter turn", rows * signs(-1, 1, 1));
}

// The free matrix H·K about the same centre, as K and R without its skew.
void drop_skew(Device& d, const glm::dmat3& h) {
  const Intrinsics& k = d.intrinsics;
  const glm::dmat3 matrix(k.fx, 0.0, 0.0, 0.0, k.fy, 0.0, k.cx, k.cy, 1.0);
  const KAndR parts = k_and_r(h * matrix * d.device_from_world.rotation, k.size);
  const glm::dvec3 centre_world = center_in_world(d.device_from_world);
  d.intrinsics = parts.intrinsics;
  d.device_from_world = {parts.rotation, -(parts.rotation * centre_world)};
}

// A projector of the scene's world takes the place of the result's, in the result's world.
void set_projector(Rig& result, const CalibratedRig& rig, Device projector) {
  const Rigid result_from_world =
      compose(inverse(result.cameras[0].device_from_world), rig.camera.device_from_world);
  projector.device_from_world = compose(projector.device_from_world, inverse(result_from_world));
  projector.name = rig.projector.name;
  result.projectors[0] = projector;
}

// One edge of the picture drawn in by `share` of it, to one side or both: a projective map of pixels.
glm::dmat3 trapezoid(glm::ivec2 size, double left, double right) {
  const double w = size.x, h = size.y, narrow = 1 - left - right;
  const double g = (1 / narrow - 1) / h;  // the lower edge's q is 1/narrow
  // (0, 0), (w, 0) stay; (0, h) → (left·w, h), (w, h) → (w - right·w, h).
  const glm::dmat3 about_edges(1.0, 0.0, 0.0, left * w / narrow / h, 1 / narrow, g, 0.0, 0.0, 1.0);
  const glm::dmat3 to(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.5, 1.0);
  const glm::dmat3 from(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -0.5, -0.5, 1.0);
  return from * about_edges * to;
}

void add_pictures(std::vector<Planted>& all) {
  const auto overscan = [](Rig& r, glm::dvec2 s) {
    Intrinsics& k = r.projectors[0].intrinsics;
    const glm::dvec2 middle = (glm::dvec2(k.size) - 1.0) / 2.0;
    k.fx *= s.x, k.fy *= s.y;
    k.cx = middle.x + s.x * (k.cx - middle.x), k.cy = middle.y + s.y * (k.cy - middle.y);
  };
  all.push_back({"overscan", "both", [=](Rig& r, const CalibratedRig&, Random& random) {
                   overscan(r, glm::dvec2(uniform(random, 0.9, 0.98)));
                 }});
  all.push_back({"overscan", "each", [=](Rig& r, const CalibratedRig&, Random& random) {
                   overscan(r, {uniform(random, 0.9, 0.98), uniform(random, 0.9, 0.98)});
                 }});
  all.push_back({"keystone", "trapezoid", [](Rig& r, const CalibratedRig&, Random& random) {
                   Device& d = r.projectors[0];
                   drop_skew(d, glm::inverse(trapezoid(d.intrinsics.size, uniform(random, 0, 0.15),
                                                       uniform(random, 0.02, 0.15))));
                 }});
  all.push_back({"keystone", "refitted", [](Rig& r, const CalibratedRig& rig, Random& random) {
                   const glm::dmat3 h = glm::inverse(trapezoid(
                       rig.projector.intrinsics.size, uniform(random, 0, 0.15), uniform(random, 0.02, 0.15)));
                   Correspondences moved = rig.seen;
                   for (glm::dvec2& p : moved.projector_pixels) {
                     const glm::dvec3 q = h * glm::dvec3(p, 1.0);
                     p = glm::dvec2(q) / q.z;
                   }
                   SolveOptions options;
                   options.lens_model = rig.projector.lens.model;
                   const auto solved = solve(moved, rig.projector.intrinsics.size, options);
                   if (solved.status != Status::refused) set_projector(r, rig, solved.estimate);
                 }});
}

}  // namespace

Device stopped_solve(const CalibratedRig& rig, int iterations, Random& random) {
  std::normal_distribution<double> normal;
  const LensGradient lens(rig.projector.lens.model);
  const WorldNormalisation normalisation = normalisation_of(rig.seen.world_points);
  const PointTable points = point_table(rig.seen, normalisation);
  for (;;) {
    Device start = rig.projector;
    Intrinsics& k = start.intrinsics;
    k.fx = k.fy = uniform(random, 1.0, 1.8) * std::max(k.size.x, k.size.y);
    k.cx = (k.size.x - 1) / 2.0, k.cy = (k.size.y - 1) / 2.0;
    for (double& parameter : start.lens.parameters) parameter = 0;
    const double distance = glm::length(apply(start.device_from_world, normalisation.center));
    const auto by = [&](double sigma) {
      return sigma * glm::dvec3(normal(random), normal(random), normal(random));
    };
    Rigid& pose = start.device_from_world;
    pose = compose(rigid_from_rotation_vector(by(0.05), by(0.05 * distance)), pose);
    ProjectorState state = state_of(start);
    state.device_from_points = device_from_normalised(pose, normalisation);
    RefineOptions options;
    options.max_iterations = iterations;
    const auto end = refine(points, lens, state, options);
    if (!end) continue;
    const auto& p = end->state.parameters;
    Device stopped = rig.projector;
    stopped.intrinsics = {k.size, p[0], p[1], p[2], p[3]};
    stopped.lens.parameters.assign(p.begin() + 4, p.end());
    stopped.device_from_world = device_from_world(end->state.device_from_points, normalisation);
    return stopped;
  }
}

std::vector<Planted> planted_mistakes() {
  std::vector<Planted> all;
  add_sizes(all);
  add_pixels(all);
  add_poses(all);
  add_exchanges(all);
  add_pictures(all);
  static constexpr std::pair<int, const char*> stops[] = {{0, "0"}, {1, "1"}, {2, "2"}, {3, "3"}};
  for (const auto& [iterations, how] : stops)
    all.push_back({"unconverged", how, [n = iterations](Rig& r, const CalibratedRig& rig, Random& random) {
                     set_projector(r, rig, stopped_solve(rig, n, random));
                   }});
  return all;
}

Planted two_mistakes(std::mt19937_64& random) {
  static const std::vector<Planted> all = planted_mistakes();
  const auto is_exact = [](const Planted& p) {
    return p.suspect != "overscan" && p.suspect != "keystone" && p.suspect != "unconverged";
  };
  for (;;) {
    const Planted& first = all[one_of(random, all.size())];
    const Planted& second = all[one_of(random, all.size())];
    if (!is_exact(first) || !is_exact(second) || first.suspect >= second.suspect) continue;
    return {first.suspect + " + " + second.suspect, first.how + " + " + second.how,
            [first, second](Rig& r, const CalibratedRig& rig, Random& drawn) {
              first.make(r, rig, drawn);
              second.make(r, rig, drawn);
            }};
  }
}

}  // namespace laterna::testing
