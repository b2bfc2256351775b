#include "apps/bench/decode_ratio.h"

#include "apps/bench/timing.h"
#include "calib/decode_gray.h"
#include "calib/fringe_fit.h"
#include "calib/fringe_kernel.h"
#include "sim/parallel.h"

#include <opencv2/structured_light.hpp>

#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>

namespace laterna {

namespace {

constexpr glm::ivec2 size{1280, 800};
constexpr double two_pi = 2 * std::numbers::pi;

// A camera that sees the panel pixel upon pixel, white at 200 DN.
ImageStack<std::uint8_t> pictures_of(const PatternSequence& sequence) {
  ImageStack<std::uint8_t> stack(size.x, size.y, picture_count(sequence));
  for (int k = 0; k < stack.count; ++k) {
    const Image<std::uint8_t> picture = pattern_picture(sequence, k);
    std::transform(picture.values.begin(), picture.values.end(), stack.picture(k).begin(),
                   [](std::uint8_t v) { return std::uint8_t(20 + v * 180 / 255); });
  }
  return stack;
}

double read_seconds(const ImageStack<std::uint8_t>& stack) {
  std::uint64_t sums[8] = {};
  const double time = seconds([&] {
    const std::uint8_t* bytes = stack.values.data();
    for (std::size_t i = 0; i + 64 <= stack.values.size(); i += 64) {
      std::uint64_t words[8];
      std::memcpy(words, bytes + i, 64);
      for (int k = 0; k < 8; ++k) sums[k] += words[k];
    }
  });
  volatile std::uint64_t sink = 0;
  for (const std::uint64_t sum : sums) sink = sink + sum;
  return time;
}

/// OpenCV's decoder on every 61st pixel, as seconds for all of them.
class Peer {
 public:
  explicit Peer(ImageStack<std::uint8_t>& stack)
      : decoder_(cv::structured_light::GrayCodePattern::create(size.x, size.y)) {
    decoder_->setBlackThreshold(40), decoder_->setWhiteThreshold(5);
    for (int k = 0; k + 2 < stack.count; ++k)
      pictures_.emplace_back(size.y, size.x, CV_8UC1, stack.picture(k).data());
  }
  double seconds_for_all(const GrayCodes& ours) const {
    std::size_t asked = 0, wrong = 0;
    const double time = seconds([&] {
      for (std::size_t i = 0; i < ours.valid.values.size(); i += 61, ++asked) {
        cv::Point pixel;
        const bool error = decoder_->getProjPixel(pictures_, int(i % size.x), int(i / size.x), pixel);
        wrong += error || !ours.valid.values[i] || pixel.x != ours.column.values[i] ||
                 pixel.y != ours.row.values[i];
      }
    });
    if (wrong) throw std::runtime_error("OpenCV decodes other projector pixels");
    return time * double(ours.valid.values.size()) / double(asked);
  }

 private:
  cv::Ptr<cv::structured_light::GrayCodePattern> decoder_;
  std::vector<cv::Mat> pictures_;
};

/// Four steps of a fringe, in blocks whose results stay in the cache, as decoding does it. All three give
/// mean, c, s and the angle in turns; the peers make the sums as the kernel does and take the angle from
/// libm.
class Fringe {
 public:
  Fringe() : stack_(size.x, size.y, steps + 2) {
    std::fill(stack_.picture(steps).begin(), stack_.picture(steps).end(), std::uint8_t(210));
    std::fill(stack_.picture(steps + 1).begin(), stack_.picture(steps + 1).end(), std::uint8_t(30));
    for (int j = 0; j < steps; ++j)
      for (std::size_t i = 0; i < stack_.picture_size(); ++i)
        stack_.picture(j)[i] =
            std::uint8_t(std::lround(120 + 90 * std::cos(two_pi * (double(i % 4099) / 4099 + j / 4.0))));
  }
  double own_seconds() {
    return seconds([&] {
      for_blocks([&](const std::uint8_t* const* pictures) {
        fit_fringe(pictures, steps, cosines, sines, block, {mean_, c_, s_, own_});
      });
    });
  }
  /// With the sigma of each pixel, as decode_phase() takes it.
  double fit_seconds() {
    const PatternGroup group{PatternGroup::Kind::fringe, 0, 0, steps, 0, 32};
    return seconds([&] {
      for (std::size_t begin = 0; begin < pixels(); begin += block)
        own_[0] += laterna::fit_fringe(stack_, group, {1, 0}, {255, 4, 5}, begin, block).variance[0];
    });
  }
  template <class Real>
  double libm_seconds() {
    return seconds(
        [&] { for_blocks([&](const std::uint8_t* const* pictures) { fit_by_libm<Real>(pictures); }); });
  }
  void check() const {
    for (std::size_t i = 0; i < block; ++i) {
      const double apart = own_[i] - libm_[i];
      if (two_pi * std::abs(apart - std::round(apart)) > 5e-6)
        throw std::runtime_error("phases differ by more than 5e-6 rad");
    }
  }
  std::size_t pixels() const { return stack_.picture_size() / block * block; }

 private:
  static constexpr int steps = 4;
  static constexpr std::size_t block = 4096;
  static constexpr float cosines[] = {0.5f, 0, -0.5f, 0}, sines[] = {0, -0.5f, 0, 0.5f};

  template <class Body>
  void for_blocks(const Body& body) {
    for (std::size_t begin = 0; begin + block <= stack_.picture_size(); begin += block) {
      const std::uint8_t* pictures[steps];
      for (int j = 0; j < steps; ++j) pictures[j] = stack_.picture(j).data() + begin;
      body(pictures);
    }
  }
  template <class Real>
  void fit_by_libm(const std::uint8_t* const* pictures) {
    for (std::size_t i = 0; i < block; ++i) {
      float sum = 0, c = 0, s = 0;
      for (int j = 0; j < steps; ++j) {
        const float value = pictures[j][i];
        sum += value, c += value * cosines[j], s += value * sines[j];
      }
      mean_[i] = sum / steps, c_[i] = c, s_[i] = s;
      libm_[i] = float(std::atan2(Real(s), Real(c)) * Real(1 / two_pi));
    }
  }

  ImageStack<std::uint8_t> stack_;
  float mean_[block], c_[block], s_[block], own_[block], libm_[block];
};

template <class Pass>
double best_of_three(const Pass& pass) {
  return std::min({pass(), pass(), pass()});
}

}  // namespace

DecodeTimes time_decode(int repeats) {
  const int threads = thread_count();
  set_thread_count(1);
  const PatternSequence sequence{{}, size};
  CapturedStack stack = pictures_of(sequence);
  auto& pictures = std::get<ImageStack<std::uint8_t>>(stack);
  const Peer peer(pictures);
  auto fringe = std::make_unique<Fringe>();
  GrayCodes codes;
  std::vector<double> over_read, opencv, atan2, atan2f, fit, own_ns;
  for (int i = -1; i < repeats; ++i) {  // the first round warms up
    const double read = read_seconds(pictures);
    const double gray = seconds([&] { decode_gray_codes(stack, sequence, {40, 6, 0, 0}, codes); });
    const double other = peer.seconds_for_all(codes);
    // The best of three passes: the four pictures come from the last cache for all.
    const double with_sigma = best_of_three([&] { return fringe->fit_seconds(); });
    const double own = best_of_three([&] { return fringe->own_seconds(); });
    const double libmf = best_of_three([&] { return fringe->libm_seconds<float>(); });
    const double libm = best_of_three([&] { return fringe->libm_seconds<double>(); });
    fringe->check();
    if (i < 0) continue;
    over_read.push_back(gray / read), opencv.push_back(other / gray);
    atan2.push_back(libm / own), atan2f.push_back(libmf / own);
    fit.push_back(libm / with_sigma);
    own_ns.push_back(1e9 * own / double(fringe->pixels()));
  }
  set_thread_count(threads);
  return {median(over_read), median(opencv), median(atan2), median(atan2f), median(fit), median(own_ns)};
}

}  // namespace laterna
