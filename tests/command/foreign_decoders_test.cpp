// Captures in other calibrators' folders, decoded by the formulas that those tools publish, against the
// truth.
#include "sim/image_file.h"
#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace laterna {
namespace {

namespace fs = std::filesystem;
using testing::laterna;
using testing::ScratchFolder;

// Each writes u and v of every camera pixel as floats, NaN where it decides nothing.
const char* const decoders = R"(
import sys, glob, numpy as np, cv2
tool, folder, width, height = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
grey = lambda name: cv2.imread(name, cv2.IMREAD_GRAYSCALE)

def gray_to_binary(code):
    for shift in (1, 2, 4, 8, 16):
        code = code ^ (code >> shift)
    return code

def procam():                        # kamino410/procam-calibration, calibrate.py: OpenCV's own decoder
    code = cv2.structured_light_GrayCodePattern.create(width, height)
    code.setBlackThreshold(40), code.setWhiteThreshold(5)
    pictures = [grey(f) for f in sorted(glob.glob(folder + '/capture_0/graycode_*'))]
    assert len(pictures) == code.getNumberOfPatternImages() + 2
    black, white = pictures.pop(), pictures.pop()
    uv = np.full(black.shape + (2,), np.nan, np.float32)
    for y in range(black.shape[0]):
        for x in range(black.shape[1]):
            if int(white[y, x]) - int(black[y, x]) <= 40: continue
            error, pixel = code.getProjPixel(pictures, x, y)
            if not error: uv[y, x] = pixel
    return uv

def scan3d():                        # scan3d-capture: robust bits with direct and global light, b = 0.3, m = 5
    b, m = 0.3, 5
    pictures = [grey(f).astype(int) for f in sorted(glob.glob(folder + '/set_00/*.png'))]
    n = len(pictures)
    patterns, bits = n // 2 - 1, (n // 2 - 1) // 2
    assert 2 + 4 * bits == n and patterns >= 8
    w, h = map(int, open(folder + '/set_00/projector_info.txt').readline().split())
    first = n - patterns - 8 + 1
    some = np.stack([pictures[k - 1] for i in range(4) for k in (first + i, first + i + patterns)])
    high, low = some.max(0), some.min(0)
    direct = np.floor((high - low) / (1 - b) + 0.5)
    other = np.floor(2 * (low - b * high) / (1 - b * b) + 0.5)
    direct, other = np.where(other > 0, direct, high), np.where(other > 0, other, 0)
    uv = np.zeros(high.shape + (2,), np.float32)
    for axis, size in ((0, w), (1, h)):
        code, sure = np.zeros(high.shape, int), direct >= m
        for k in range(bits):
            p, q = pictures[2 + 2 * (axis * bits + k)], pictures[3 + 2 * (axis * bits + k)]
            one = np.where(direct > other, p > q, (p >= other) & (q <= direct))
            zero = np.where(direct > other, p <= q, (p <= direct) & (q >= other))
            sure &= one | zero
            code += one.astype(int) << (bits - 1 - k)
        code = np.clip(gray_to_binary(code) - ((1 << bits) - size) // 2, 0, size - 1)
        uv[..., axis] = np.where(sure & (high - low > 20), code, np.nan)
    return uv

def slstudio_frames():               # jakobwilm/slstudio, CameraVirtual.cpp
    return [grey(f) for f in sorted(glob.glob(folder + '/frameSeq_00/frameSeq_*.bmp'))]

def slstudio_gray():                 # CodecGrayCode.cpp: white, black, 10 bits of columns, 6 of rows
    frames = [f.astype(int) for f in slstudio_frames()]
    assert len(frames) == 18
    low, shading = frames[1], frames[0] - frames[1]
    uv = np.zeros(low.shape + (2,), np.float32)
    for axis, size, first, count in ((0, width, 2, 10), (1, height, 12, 6)):
        total = int(np.ceil(np.log2(size)))
        code = sum((np.abs(frames[0] - f) < np.abs(f - low)).astype(int) << (total - 1 - k)
                   for k, f in enumerate(frames[first:first + count]))
        uv[..., axis] = np.where(shading > 20, gray_to_binary(code), np.nan)
    return uv

def slstudio_phase():                # CodecCalibration.cpp: three steps of 1/16 of the width, three of all of it
    frames = [f.astype(float) for f in slstudio_frames()]
    assert len(frames) == 12
    phase = lambda a, b, c: np.arctan2(np.sqrt(3) * (b - c), 2 * a - c - b) % (2 * np.pi)
    uv = []
    for axis, size in ((0, width), (1, height)):
        fine, cue = phase(*frames[6 * axis:6 * axis + 3]), phase(*frames[6 * axis + 3:6 * axis + 6])
        fine = fine + np.rint((cue * 16 - fine) / (2 * np.pi)) * 2 * np.pi
        uv.append(fine / 16 * size / (2 * np.pi))
    a, b, c = frames[:3]
    uv = np.stack(uv, -1)
    uv[np.hypot(2 * a - b - c, np.sqrt(3) * (b - c)) <= 10] = np.nan
    return uv

globals()[tool]().astype(np.float32).tofile(tool + '.bin')
)";

std::string scene(int width, int height, const std::string& patterns = "") {
  return fmt::format(R"(
[[mesh]]
shape = "relief"
shape_size = [3, 2, 0.3]
seed = 3
[[projector]]
size = [{}, {}]
fx = {}
fy = {}
cx = {}
cy = {}
position = [0.4, -0.2, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [80, 60]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
{}
)",
                     width, height, 1.2 * width, 1.6 * height, width / 2.0, height / 2.0, patterns);
}

struct Decoded {
  int pixels = 0;
  double share = 0;     ///< of the camera pixels that the projector lights
  glm::dvec2 worst{0};  ///< largest |decoded - true| of each axis, px
};

// Runs a decoder over the folder; `pixel_from_code`: u = m·code + (m - 1)/2. Columns nearer to the
// projector's sides than `edge_px` are left out.
Decoded decode(const fs::path& folder, const std::string& tool, const std::string& export_name,
               glm::ivec2 size, glm::ivec2 m = {1, 1}, double edge_px = -1) {
  testing::write_text(folder / "decoders.py", decoders);
  const std::string command = fmt::format("cd '{}' && /usr/bin/python3 decoders.py {} {} {} {} 2> {}.err",
                                          folder.string(), tool, export_name, size.x, size.y, tool);
  EXPECT_EQ(std::system(command.c_str()), 0) << testing::read_text(folder / (tool + ".err"));
  const ExrLayers truth = read_exr_layers(folder / "capture" / "truth" / "camera_projector.exr");
  const auto plane = [&](const char* name) {
    const auto at = std::find(truth.names.begin(), truth.names.end(), name);
    EXPECT_NE(at, truth.names.end()) << name;
    return truth.planes[std::size_t(at - truth.names.begin())];
  };
  const Image<float> u = plane("projector.u"), v = plane("projector.v");
  const std::string bytes = testing::read_text(folder / (tool + ".bin"));
  EXPECT_EQ(bytes.size(), u.values.size() * 8);
  Decoded result;
  int lit = 0;
  for (std::size_t i = 0; i < u.values.size() && bytes.size() == u.values.size() * 8; ++i) {
    if (!std::isfinite(u.values[i])) continue;
    if (const glm::dvec2 uv(u.values[i], v.values[i]);
        std::min({uv.x, uv.y, size.x - 1 - uv.x, size.y - 1 - uv.y}) < edge_px)
      continue;
    ++lit;
    float code[2];
    std::memcpy(code, bytes.data() + 8 * i, sizeof code);
    if (!std::isfinite(code[0]) || !std::isfinite(code[1])) continue;
    ++result.pixels;
    const glm::dvec2 found = glm::dvec2(m) * glm::dvec2(code[0], code[1]) + 0.5 * glm::dvec2(m - 1);
    result.worst = glm::max(result.worst, glm::abs(found - glm::dvec2(u.values[i], v.values[i])));
  }
  result.share = double(result.pixels) / std::max(1, lit);
  ::testing::Test::RecordProperty(
      "worst_px", fmt::format("{:.3f} {:.3f} of {} pixels, {:.3f} of the lit", result.worst.x, result.worst.y,
                              result.pixels, result.share));
  return result;
}

void capture(const fs::path& folder, const std::string& text, const std::string& layouts) {
  testing::write_text(folder / "scene.toml", text);
  const auto captured = laterna("capture scene.toml -o capture --format pgm", folder);
  ASSERT_EQ(captured.exit_code, 0) << captured.err;
  const auto converted = laterna(fmt::format("convert capture {0} --as {0}", layouts), folder);
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
}

// The pixel that lights is the nearest: half of one, and single precision of hundreds of pixels.
constexpr double half_px = 0.5 + 1e-4;

TEST(ForeignDecoders, ProcamCalibration) {
  const ScratchFolder scratch;
  capture(scratch.path(), scene(640, 40), "procam");
  const Decoded d = decode(scratch.path(), "procam", "procam", {640, 40});
  EXPECT_GT(d.share, 0.95);  // but for what is too dim for its thresholds
  EXPECT_LE(d.worst.x, half_px);
  EXPECT_LE(d.worst.y, half_px);
}

TEST(ForeignDecoders, Scan3dCapture) {
  const ScratchFolder scratch;
  capture(scratch.path(), scene(150, 60), "scan3d");  // 8 and 6 bits: columns in pixels of 4
  const Decoded d = decode(scratch.path(), "scan3d", "scan3d", {150, 60}, {4, 1});
  EXPECT_GT(d.share, 0.95);
  EXPECT_LE(d.worst.x, 4 * 0.5 + 1e-4);  // half of four
  EXPECT_LE(d.worst.y, half_px);
}

TEST(ForeignDecoders, SlstudioGrayCodes) {
  const ScratchFolder scratch;
  capture(scratch.path(), scene(640, 40), "slstudio");
  const Decoded d = decode(scratch.path(), "slstudio_gray", "slstudio", {640, 40});
  EXPECT_GT(d.share, 0.95);
  EXPECT_LE(d.worst.x, half_px);
  EXPECT_LE(d.worst.y, half_px);
}

TEST(ForeignDecoders, SlstudioFringes) {
  const ScratchFolder scratch;
  capture(scratch.path(),
          scene(128, 128, "[patterns]\nkind = \"multi_frequency\"\nsteps = 3\npitches_px = [8, 128]"),
          "slstudio");
  // A phase near 0 may turn over: one of its 8-pixel periods at each side is left out.
  const Decoded d = decode(scratch.path(), "slstudio_phase", "slstudio", {128, 128}, {1, 1}, 8);
  EXPECT_GT(d.share, 0.95);
  // Half a pixel, and 8 bits: 0.3 DN of 50 at three steps are 0.005 of a radian, 0.007 px of 8; fivefold.
  EXPECT_LE(d.worst.x, 0.5 + 0.035);
  EXPECT_LE(d.worst.y, 0.5 + 0.035);
}

}  // namespace
}  // namespace laterna
