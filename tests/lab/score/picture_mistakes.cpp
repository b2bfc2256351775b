#include "tests/lab/score/picture_mistakes.h"

#include "calib/sum_check.h"
#include "tests/lab/score/random_rigs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace laterna::testing {

namespace {

using Random = std::mt19937_64;
using Order = std::vector<int>;  ///< the picture that stands in each place
using Edit = std::function<void(Order&, const PatternSequence&, Random&)>;

void reorder(CapturedStack& pictures, const Order& order) {
  std::visit(
      [&](auto& stack) {
        const auto taken = stack;
        for (int k = 0; k < stack.count; ++k)
          std::ranges::copy(taken.picture(order[k]), stack.picture(k).begin());
      },
      pictures);
}

PictureMistake of_order(const char* suspect, const char* how, const Edit& edit) {
  return {suspect,
          how,
          {},
          true,
          [edit](CapturedStack& pictures, const PatternSequence& sequence, Random& random) {
            Order order(picture_count(sequence));
            std::iota(order.begin(), order.end(), 0);
            edit(order, sequence, random);
            reorder(pictures, order);
          }};
}

void add_orders(std::vector<PictureMistake>& all) {
  const char* name = "dropped_frame";
  all.push_back(
      of_order(name, "lost, the last one taken twice", [](Order& o, const PatternSequence&, Random& random) {
        o.erase(o.begin() + std::ptrdiff_t(one_of(random, o.size() - 1)));
        o.push_back(o.back());
      }));
  all.push_back(
      of_order(name, "taken twice, the last one lost", [](Order& o, const PatternSequence&, Random& random) {
        const auto at = o.begin() + std::ptrdiff_t(one_of(random, o.size() - 1));
        o.insert(at, *at);
        o.pop_back();
      }));
  all.push_back(of_order(name, "two exchanged", [](Order& o, const PatternSequence&, Random& random) {
    const std::size_t i = one_of(random, o.size() - 1);
    std::swap(o[i], o[i + 1 + one_of(random, o.size() - 1 - i)]);
  }));
  all.push_back(
      of_order("axes_exchanged", "rows first", [](Order& o, const PatternSequence& sequence, Random&) {
        const auto groups = pattern_groups(sequence);
        const auto rows =
            std::find_if(groups.begin(), groups.end(), [](const auto& g) { return g.axis == 1; });
        std::rotate(o.begin(), o.begin() + rows->first,
                    o.begin() + groups.back().first + groups.back().count);
      }));
  all.push_back({"axes_exchanged", "rows decoded as columns"});
  all.back().exchanges_codes = true;
}

template <class T>
void flip(ImageStack<T>& stack, bool in_x, bool in_y) {
  for (int k = 0; k < stack.count; ++k) {
    const auto picture = stack.picture(k);
    if (in_x && in_y) std::ranges::reverse(picture);
    for (int y = 0; in_x && !in_y && y < stack.height; ++y)
      std::ranges::reverse(picture.subspan(std::size_t(y) * stack.width, stack.width));
    for (int y = 0; in_y && !in_x && y < stack.height / 2; ++y)
      std::ranges::swap_ranges(picture.subspan(std::size_t(y) * stack.width, stack.width),
                               picture.subspan(std::size_t(stack.height - 1 - y) * stack.width, stack.width));
  }
}

void add_flips(std::vector<PictureMistake>& all) {
  const auto add = [&](const char* how, bool in_x, bool in_y) {
    all.push_back({"y_flipped", how, {}, true, [=](CapturedStack& pictures, const PatternSequence&, Random&) {
                     std::visit([&](auto& stack) { flip(stack, in_x, in_y); }, pictures);
                   }});
  };
  add("pictures upside down", false, true);
  add("pictures left to right", true, false);
  add("pictures turned by half", true, true);
}

void add_responses(std::vector<PictureMistake>& all) {
  all.push_back({"gamma", "of the projector", [](Random& random) {
                   return std::vector{
                       std::string("effects.response=true"),
                       fmt::format("projector.response_exponent={}", uniform(random, 1.8, 2.6))};
                 }});
  all.push_back({"gamma",
                 "of the camera's pictures",
                 {},
                 true,
                 [](CapturedStack& pictures, const PatternSequence&, Random&) {
                   std::visit(
                       [](auto& stack) {
                         const double full = full_scale_dn(stack);
                         for (auto& value : stack.values)
                           value = std::remove_reference_t<decltype(value)>(
                               std::lround(full * std::pow(value / full, 1 / 2.2)));
                       },
                       pictures);
                 }});
}

void add_scalers(std::vector<PictureMistake>& all) {
  for (const bool knows : {true, false}) {
    all.push_back(
        {"keystone", knows ? "known" : "unknown",
         [](Random& random) {
           const double left = uniform(random, 0, 0.15), right = uniform(random, 0.05, 0.15);
           return std::vector{
               std::string("effects.scaler=true"),
               fmt::format("projector.scaler={{ keystone = [0.0, 0.0, 1.0, 0.0, {}, 1.0, {}, 1.0] }}",
                           1 - right, left)};
         },
         knows});
    all.push_back({"overscan", knows ? "known" : "unknown",
                   [](Random& random) {
                     return std::vector{
                         std::string("effects.scaler=true"),
                         fmt::format("projector.scaler={{ overscan = {} }}", uniform(random, 0.03, 0.1))};
                   },
                   knows});
  }
}

}  // namespace

std::vector<PictureMistake> picture_mistakes() {
  std::vector<PictureMistake> all{{"right", ""}};
  add_responses(all);
  add_orders(all);
  add_flips(all);
  add_scalers(all);
  return all;
}

}  // namespace laterna::testing
