#include "sim/new_scene.h"

namespace laterna {

std::string new_scene_text() {
  return R"(# A scene of Laterna: what is lit, what lights it, what sees it.
#
#   laterna check scene.toml        is it sound?
#   laterna preview scene.toml      one picture: rig, frusta, overlap
#   laterna roundtrip scene.toml    cast patterns, photograph, decode, recover the projector
#
# Lengths are metres. World: here x right along the wall, y into it, z up.
# Every key is listed in data/scene-reference.md; what is left out has its default.

name = "wall and ball"
ambient_lx = 2.0                     # lux on every surface, from everywhere: a dim room

[[mesh]]
name = "wall"
shape = "relief"                     # instead of `file`: plane, box, sphere, relief, v_groove
shape_size = [1.3, 0.85, 0.25]       # m, width, height and depth of its bumps
detail = 256                         # columns and rows
seed = 1                             # other seeds give other bumps
rotate_deg = [90, 0, 0]              # degrees about x, then y, then z: from lying to standing
albedo = 0.8                         # reflected over incident light, 0 to 1

[[mesh]]
name = "ball"
shape = "sphere"
shape_size = [0.3, 0.3, 0.3]         # m, the diameter three times
detail = 96                          # bands of latitude
translate = [0.1, -0.3, -0.05]       # m, where its centre stands
albedo = 0.6

# A mesh of your own, relative to this file (PLY, OBJ, STL, glTF, IFC, also .gz):
#
# [[mesh]]
# file = "house.obj"
# unit = "mm"                        # of the file's coordinates
# up = "y"                           # the file's axis that points up
# translate = [0, 0, -0.5]

[[projector]]
name = "projector"
size = [1920, 1080]                  # px, width and height of the panel
throw_ratio = 1.3                    # distance over picture width; or fx, fy, cx, cy in px; or fov_y_deg
lens_shift = [0.0, 0.5]              # fractions of width and height that move the picture left and up
position = [-0.2, -1.6, -0.35]       # m
look_at = [0.0, 0.0, -0.35]          # m, a point on its axis
up = [0, 0, 1]                       # shown upwards in its picture
flux_lm = 1000                       # lumen of the all-white picture
# lens = { model = "LENSMODEL_OPENCV4", parameters = [-0.05, 0.0, 0.0, 0.0] }  # k1, k2, p1, p2
# near = 0.5                         # m, the light begins here; absent: at the lens
# far = 3.0                          # m, the light ends here; absent: never

[[camera]]
name = "camera"
size = [1280, 800]                   # px
fov_x_deg = 50                       # degrees, the full horizontal angle
position = [0.45, -1.45, 0.15]       # m
look_at = [0.0, 0.0, 0.0]            # m
sensor = { bit_depth = 8, noise_sigma_dn = 0.5 }  # bits; noise in digital numbers

[patterns]
kind = "gray"                        # Gray code columns and rows, with inverses
)";
}

}  // namespace laterna
