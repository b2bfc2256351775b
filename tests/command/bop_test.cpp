// A simulated capture as a scene of BOP's, looked at as BOP's own tools would: K, poses, models and depth by
// NumPy.
#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>

namespace laterna {
namespace {

using nlohmann::json;
using testing::laterna;
using testing::ScratchFolder;

// A ball, and a cuboid that hides a part of it and leaves the picture on the left, before a plane; off the
// middle, askew.
const char* const three_meshes = R"(
[[mesh]]
shape = "plane"
detail = 1
shape_size = [3, 2, 1]
rotate_deg = [10, 20, 0]
[[mesh]]
shape = "sphere"
name = "ball"
detail = 1
shape_size = [0.5, 0.5, 0.5]
translate = [-0.1, 0.2, 0.5]
[[mesh]]
shape = "box"
name = "cuboid"
shape_size = [0.7, 0.25, 0.2]
rotate_deg = [20, 30, 15]
translate = [-0.6, 0.1, 0.9]
[[projector]]
size = [40, 20]
throw_ratio = 1.2
position = [0.4, -0.2, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [64, 48]
fx = 73
fy = 80
cx = 33.25
cy = 21.5
position = [-0.35, 0.15, 2.6]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
)";

// What calc_gt_info.py and calc_model_info.py of BOP's toolkit define, computed from the files alone: each
// model is drawn at pixel centres on a canvas of three pictures by three, depth is compared, and silhouettes
// are counted.
const char* const check = R"(
import json, sys, numpy as np, cv2
scene = sys.argv[1]
load = lambda name: json.load(open(scene + '/' + name))
worst = {'silhouette': 0, 'visible': 0, 'depth_mm': 0.0, 'info': 0, 'diameter_mm': 0.0, 'box_mm': 0.0, 'vertices': 0.0}

def load_ply(path):
    lines = open(path).read().split('\n')
    count = {l.split()[1]: int(l.split()[2]) for l in lines[:20] if l.startswith('element')}
    body = lines[lines.index('end_header') + 1:]
    points = np.array([l.split()[:3] for l in body[:count['vertex']]], float)
    faces = np.array([l.split()[1:4] for l in body[count['vertex']:][:count['face']]], int)
    return points, faces

def draw(points, faces, K, W, H):                       # depth in mm at pixel centres, 0: nothing
    depth = np.full((3 * H, 3 * W), np.inf)
    u, v = np.meshgrid(np.arange(3 * W) - W, np.arange(3 * H) - H)
    rays = np.stack([(u - K[0, 2]) / K[0, 0], (v - K[1, 2]) / K[1, 1], np.ones_like(u, float)], -1)
    for a, b, c in points[faces]:
        n = np.cross(b - a, c - a)
        with np.errstate(divide='ignore', invalid='ignore'):
            z = (n @ a) / (rays @ n)
        inside = [rays @ np.cross(p, q) * np.sign(n @ a) >= 0 for p, q in ((a, b), (b, c), (c, a))]
        hit = inside[0] & inside[1] & inside[2] & (z > 0) & (z < depth)
        depth[hit] = z[hit]
    return np.where(np.isfinite(depth), depth, 0)

def box(mask, W, H):                                    # misc.calc_2d_bbox: the last less the first
    y, x = np.nonzero(mask)
    return [int(x.min()) - W, int(y.min()) - H, int(x.max() - x.min()), int(y.max() - y.min())]

infos = load('models/models_info.json')
for key, camera in load('scene_camera.json').items():
    K = np.array(camera['cam_K']).reshape(3, 3)
    depth = cv2.imread(scene + '/depth/%06d.png' % int(key), cv2.IMREAD_UNCHANGED) * camera['depth_scale']
    H, W = depth.shape
    nearest = np.full((H, W), np.inf)
    for i, (gt, found) in enumerate(zip(load('scene_gt.json')[key], load('scene_gt_info.json')[key])):
        model, faces = load_ply(scene + '/models/obj_%06d.ply' % gt['obj_id'])
        points = model @ np.array(gt['cam_R_m2c']).reshape(3, 3).T + np.array(gt['cam_t_m2c'])
        whole = draw(points, faces, K, W, H)
        alone = whole[H:2 * H, W:2 * W]
        nearest = np.where(alone > 0, np.minimum(nearest, alone), nearest)
        mask = cv2.imread(scene + '/mask/%06d_%06d.png' % (int(key), i), cv2.IMREAD_UNCHANGED)
        seen = cv2.imread(scene + '/mask_visib/%06d_%06d.png' % (int(key), i), cv2.IMREAD_UNCHANGED)
        visible = (alone > 0) & (np.abs(alone - depth) < 15)
        worst['silhouette'] += int(((alone > 0) != (mask == 255)).sum())
        worst['visible'] += int((visible != (seen == 255)).sum())
        expected = {'px_count_all': int((whole > 0).sum()), 'px_count_valid': int(depth[alone > 0].astype(bool).sum()),
                    'px_count_visib': int(visible.sum()), 'bbox_obj': box(whole > 0, W, H),
                    'bbox_visib': box(np.pad(visible, ((H, H), (W, W))), W, H)}
        worst['info'] += sum(found[name] != value for name, value in expected.items())
        worst['info'] += abs(found['visib_fract'] - visible.sum() / (whole > 0).sum()) > 1e-12
        info = infos[str(gt['obj_id'])]
        apart = np.linalg.norm(model[:, None] - model[None], axis=-1).max()
        worst['diameter_mm'] = max(worst['diameter_mm'], abs(info['diameter'] - apart))
        for k, axis in enumerate('xyz'):
            worst['box_mm'] = max(worst['box_mm'], abs(info['min_' + axis] - model[:, k].min()),
                                  abs(info['size_' + axis] - np.ptp(model[:, k])))
        # each vertex, projected, falls on a pixel of the silhouette or beside its edge
        uv = (points @ K.T)[:, :2] / points[:, 2:]
        near = cv2.dilate((whole > 0).astype(np.uint8), np.ones((3, 3)))
        x, y = np.rint(uv).astype(int).T + np.array([[W], [H]])
        worst['vertices'] = max(worst['vertices'], float((near[y, x] == 0).mean()))
    both = np.isfinite(nearest) & (depth > 0)
    worst['silhouette'] += int((np.isfinite(nearest) != (depth > 0)).sum())
    worst['depth_mm'] = max(worst['depth_mm'], float(np.abs(nearest - depth)[both].max()))
print(json.dumps({name: float(value) for name, value in worst.items()}))
)";

TEST(Bop, ACaptureIsWhatItsToolkitComputes) {
  const ScratchFolder scratch;
  testing::write_text(scratch / "scene.toml", three_meshes);
  ASSERT_EQ(laterna("capture scene.toml -o capture", scratch.path()).exit_code, 0);
  const auto converted = laterna("convert capture bop --as bop", scratch.path());
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  testing::write_text(scratch / "check.py", check);
  const std::string command = fmt::format(
      "cd '{}' && /usr/bin/python3 check.py bop > check.json 2> check.err", scratch.path().string());
  ASSERT_EQ(std::system(command.c_str()), 0) << testing::read_text(scratch / "check.err");
  const json worst = json::parse(testing::read_text(scratch / "check.json"));
  EXPECT_EQ(worst["silhouette"], 0);
  EXPECT_EQ(worst["visible"], 0);
  EXPECT_EQ(worst["info"], 0);
  EXPECT_EQ(worst["vertices"], 0);
  EXPECT_LT(worst["depth_mm"], 0.0501);   // in steps of 0.1 mm: half of one is lost
  EXPECT_LT(worst["diameter_mm"], 1e-9);  // roundings of a metre in mm
  EXPECT_LT(worst["box_mm"], 1e-9);       // likewise
  const json info = json::parse(testing::read_text(scratch / "bop" / "scene_gt_info.json"))["0"];
  EXPECT_LT(info[2]["bbox_obj"][0], 0);     // the cuboid leaves the picture
  EXPECT_LT(info[1]["visib_fract"], 0.95);  // and hides a part of the ball
  EXPECT_GT(info[1]["visib_fract"], 0.3);
}

}  // namespace
}  // namespace laterna
