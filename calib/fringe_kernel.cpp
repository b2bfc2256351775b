#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calib/fringe_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "calib/fringe_kernel.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace laterna::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Products are added in two steps, never fused: every instruction set gives the same bits.
template <class V>
HWY_INLINE V add_product(V a, V b, V sum) {
  return hn::Add(hn::Mul(a, b), sum);
}

// Calls body(tag, i) for whole vectors, then one by one.
template <class Body>
HWY_INLINE void for_all(std::size_t count, const Body& body) {
  const hn::ScalableTag<float> wide;
  std::size_t i = 0;
  for (; i + hn::Lanes(wide) <= count; i += hn::Lanes(wide)) body(wide, i);
  for (; i < count; ++i) body(hn::CappedTag<float, 1>(), i);
}

template <class D, class T>
HWY_INLINE hn::Vec<D> load_floats(D d, const T* from) {
  const hn::Rebind<T, D> narrow;
  const hn::Rebind<std::int32_t, D> whole;
  return hn::ConvertTo(d, hn::PromoteTo(whole, hn::LoadU(narrow, from)));
}

// atan(q)/2π on [0, 1]: q·P(q²), the minimax fit of seven terms, 2.5e-7 rad.
template <class D>
HWY_INLINE hn::Vec<D> atan_turns(D d, hn::Vec<D> q) {
  const auto x = hn::Mul(q, q);
  auto p = hn::Set(d, 0.0010841305f);
  for (const float term :
       {-0.00534827763f, 0.0126725009f, -0.0210615181f, 0.0315251176f, -0.0530262382f, 0.159154324f})
    p = add_product(p, x, hn::Set(d, term));
  return hn::Mul(p, q);
}

template <class D>
HWY_INLINE hn::Vec<D> turns_at(D d, hn::Vec<D> c, hn::Vec<D> s) {
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto ac = hn::Abs(c), as = hn::Abs(s);
  const auto larger = hn::Max(ac, as), smaller = hn::Min(ac, as);
  const auto q = hn::Div(smaller, hn::IfThenElse(hn::Eq(larger, zero), one, larger));
  auto turns = atan_turns(d, q);
  turns = hn::IfThenElse(hn::Gt(as, ac), hn::Sub(hn::Set(d, 0.25f), turns), turns);
  turns = hn::IfThenElse(hn::Lt(c, zero), hn::Sub(hn::Set(d, 0.5f), turns), turns);
  turns = hn::IfThenElse(hn::Lt(s, zero), hn::Sub(one, turns), turns);
  return hn::IfThenElse(hn::Lt(turns, one), turns, zero);
}

template <class T>
HWY_INLINE void fit_all(const T* const* pictures, int steps, const float* cosines, const float* sines,
                        std::size_t count, const FringeArrays& out) {
  for_all(count, [&](auto d, std::size_t i) HWY_ATTR {
    auto sum = hn::Zero(d), c = hn::Zero(d), s = hn::Zero(d);
    for (int j = 0; j < steps; ++j) {
      const auto value = load_floats(d, pictures[j] + i);
      sum = hn::Add(sum, value);
      c = add_product(value, hn::Set(d, cosines[j]), c);
      s = add_product(value, hn::Set(d, sines[j]), s);
    }
    hn::StoreU(hn::Mul(sum, hn::Set(d, 1.0f / float(steps))), d, out.mean + i);
    hn::StoreU(c, d, out.c + i);
    hn::StoreU(s, d, out.s + i);
    hn::StoreU(turns_at(d, c, s), d, out.turns + i);
  });
}

void fit_fringe_8(const std::uint8_t* const* pictures, int steps, const float* cosines, const float* sines,
                  std::size_t count, const FringeArrays& out) {
  fit_all(pictures, steps, cosines, sines, count, out);
}
void fit_fringe_16(const std::uint16_t* const* pictures, int steps, const float* cosines, const float* sines,
                   std::size_t count, const FringeArrays& out) {
  fit_all(pictures, steps, cosines, sines, count, out);
}

template <class T>
HWY_INLINE void variance_all(const FringeSamples<T>& f, const float* mean, const float* c, const float* s,
                             std::size_t count, float* variance) {
  constexpr float turn_squared = 39.4784176f;  // (2π)²
  const float n = float(f.steps);
  for_all(count, [&](auto d, std::size_t i) HWY_ATTR {
    const auto m = hn::LoadU(d, mean + i), vc = hn::LoadU(d, c + i), vs = hn::LoadU(d, s + i);
    auto squares = hn::Zero(d);
    for (int j = 0; f.steps > 3 && j < f.steps; ++j) {
      auto rest = hn::Sub(load_floats(d, f.pictures[j] + i), m);
      rest = hn::Sub(rest, hn::Mul(vc, hn::Set(d, f.cosines[j])));
      rest = add_product(vs, hn::Set(d, f.sines[j]), rest);
      squares = add_product(rest, rest, squares);
    }
    const auto one = hn::Set(d, 1.0f), white = load_floats(d, f.white + i);
    const auto both = hn::Add(white, load_floats(d, f.black + i));
    const auto off = hn::Sub(m, hn::Mul(hn::Set(d, 0.5f), both));
    const auto has_sum = hn::Lt(white, hn::Set(d, f.full_scale));
    const auto by_sum = hn::Mul(hn::Mul(off, off), hn::Set(d, 1 / (1 / n + 0.5f)));
    const auto chi2 =
        hn::Mul(hn::Add(squares, hn::IfThenElseZero(has_sum, by_sum)), hn::Set(d, 1 / f.constant));
    const auto freedom = hn::Add(hn::Set(d, n - 3), hn::IfThenElseZero(has_sum, one));
    const auto misfit = hn::Div(chi2, hn::Max(freedom, one));  // without freedom χ² is 0
    const auto squared = add_product(vs, vs, hn::Mul(vc, vc));
    const auto plain = hn::Div(hn::Set(d, 2 * f.constant / n), squared);
    const auto grown = hn::IfThenElse(hn::Gt(misfit, hn::Set(d, f.max_chi2)), hn::Mul(plain, misfit), plain);
    const auto clear = hn::And(hn::Ge(squared, hn::Set(d, f.min_modulation * f.min_modulation)),
                               hn::Le(plain, hn::Set(d, f.max_variance)));
    const auto none = hn::Set(d, std::numeric_limits<float>::infinity());
    hn::StoreU(hn::IfThenElse(clear, hn::Mul(grown, hn::Set(d, 1 / turn_squared)), none), d, variance + i);
  });
}

void variance_8(const FringeSamples<std::uint8_t>& f, const float* mean, const float* c, const float* s,
                std::size_t count, float* variance) {
  variance_all(f, mean, c, s, count, variance);
}
void variance_16(const FringeSamples<std::uint16_t>& f, const float* mean, const float* c, const float* s,
                 std::size_t count, float* variance) {
  variance_all(f, mean, c, s, count, variance);
}

void turns_all(const float* c, const float* s, std::size_t count, float* turns) {
  for_all(count, [&](auto d, std::size_t i) HWY_ATTR {
    hn::StoreU(turns_at(d, hn::LoadU(d, c + i), hn::LoadU(d, s + i)), d, turns + i);
  });
}

// cost(d, i, k, x) of every place; the best two are kept.
template <class Cost>
HWY_INLINE void choose(const PeriodSearch& search, std::size_t count, const PeriodArrays& out,
                       const Cost& cost) {
  for_all(count, [&](auto d, std::size_t i) HWY_ATTR {
    const auto none = hn::Set(d, std::numeric_limits<float>::infinity());
    const auto turns = hn::LoadU(d, search.turns + i), pitch = hn::Set(d, search.pitch_px);
    auto best = hn::Zero(d), least = none, second = none;
    for (int k = search.first; k <= search.last; ++k) {
      const auto place = hn::Set(d, float(k)), x = hn::Mul(hn::Add(place, turns), pitch);
      const auto inside =
          hn::And(hn::Ge(x, hn::Set(d, search.low_px)), hn::Le(x, hn::Set(d, search.high_px)));
      const auto value = hn::IfThenElse(inside, cost(d, i, k, x), none);
      const auto better = hn::Lt(value, least);
      second = hn::IfThenElse(better, least, hn::Min(second, value));
      best = hn::IfThenElse(better, place, best);
      least = hn::Min(least, value);
    }
    hn::StoreU(best, d, out.best + i);
    hn::StoreU(least, d, out.cost + i);
    hn::StoreU(second, d, out.second_cost + i);
  });
}

void choose_by_phase(const PeriodSearch& search, const PhaseWitness* witnesses, int count_witnesses,
                     std::size_t count, const PeriodArrays& out) {
  choose(search, count, out, [&](auto d, std::size_t i, int, auto x) HWY_ATTR {
    auto sum = hn::Zero(d);
    for (int m = 0; m < count_witnesses; ++m) {
      const PhaseWitness& w = witnesses[m];
      const auto turns = hn::Sub(hn::Mul(x, hn::Set(d, 1 / w.pitch_px)), hn::LoadU(d, w.turns + i));
      const auto apart = hn::Mul(hn::Sub(turns, hn::Round(turns)), hn::Set(d, w.pitch_px));
      sum = add_product(hn::Mul(apart, apart), hn::LoadU(d, w.weight + i), sum);
    }
    return sum;
  });
}

void choose_by_sample(const PeriodSearch& search, const SampleWitness* witnesses, int count_witnesses,
                      std::size_t count, const PeriodArrays& out) {
  choose(search, count, out, [&](auto d, std::size_t i, int k, auto) HWY_ATTR {
    auto sum = hn::Zero(d);
    for (int m = 0; m < count_witnesses; ++m) {
      const SampleWitness& w = witnesses[m];
      const auto cosine = hn::Set(d, w.cosines[k - search.first]),
                 sine = hn::Set(d, w.sines[k - search.first]);
      auto rest = hn::Sub(hn::LoadU(d, w.rest + i), hn::Mul(hn::LoadU(d, w.c + i), cosine));
      rest = add_product(hn::LoadU(d, w.s + i), sine, rest);
      sum = add_product(rest, rest, sum);
    }
    return sum;
  });
}

}  // namespace
}  // namespace laterna::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace laterna {

HWY_EXPORT(fit_fringe_8);
HWY_EXPORT(fit_fringe_16);
HWY_EXPORT(variance_8);
HWY_EXPORT(variance_16);
HWY_EXPORT(turns_all);
HWY_EXPORT(choose_by_phase);
HWY_EXPORT(choose_by_sample);

void fit_fringe(const std::uint8_t* const* pictures, int steps, const float* cosines, const float* sines,
                std::size_t count, const FringeArrays& out) {
  HWY_DYNAMIC_DISPATCH(fit_fringe_8)(pictures, steps, cosines, sines, count, out);
}
void fit_fringe(const std::uint16_t* const* pictures, int steps, const float* cosines, const float* sines,
                std::size_t count, const FringeArrays& out) {
  HWY_DYNAMIC_DISPATCH(fit_fringe_16)(pictures, steps, cosines, sines, count, out);
}
void fringe_variance(const FringeSamples<std::uint8_t>& samples, const float* mean, const float* c,
                     const float* s, std::size_t count, float* variance) {
  HWY_DYNAMIC_DISPATCH(variance_8)(samples, mean, c, s, count, variance);
}
void fringe_variance(const FringeSamples<std::uint16_t>& samples, const float* mean, const float* c,
                     const float* s, std::size_t count, float* variance) {
  HWY_DYNAMIC_DISPATCH(variance_16)(samples, mean, c, s, count, variance);
}
void turns_of(const float* c, const float* s, std::size_t count, float* turns) {
  HWY_DYNAMIC_DISPATCH(turns_all)(c, s, count, turns);
}
void choose_period(const PeriodSearch& search, const PhaseWitness* witnesses, int count_witnesses,
                   std::size_t count, const PeriodArrays& out) {
  HWY_DYNAMIC_DISPATCH(choose_by_phase)(search, witnesses, count_witnesses, count, out);
}
void choose_period(const PeriodSearch& search, const SampleWitness* witnesses, int count_witnesses,
                   std::size_t count, const PeriodArrays& out) {
  HWY_DYNAMIC_DISPATCH(choose_by_sample)(search, witnesses, count_witnesses, count, out);
}

}  // namespace laterna
#endif
