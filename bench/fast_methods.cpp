// The fast kernel: u^(-3/2) by estimate and series (core/inverse_cube.hpp) instead of square root and division. The
// hand-written loops are for AVX-512 alone, whole functions with intrinsics, and are not run where it is missing. The
// first ones do everything else as the loops with square root and division do; the folded ones show what fused
// multiply-adds and folded constants could still take off the chain.
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/splitting.hpp"
#include "plane.hpp"
#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace bench {

namespace {

#ifdef __x86_64__

#define BENCH_AVX512 gnu::target("avx512f,fma")

/// y^3 (1 + e(3/2 + 15/8 e + 35/16 e^2 + 315/128 e^3)) = leading (1 + e sum).
struct Series {
  double leading, e, sum;
};
[[BENCH_AVX512, gnu::always_inline]] inline Series series(double u, double k) {
  const __m128d v = _mm_set_sd(u);
  const double y = _mm_cvtsd_f64(_mm_rsqrt14_sd(v, v));
  const double yy = y * y;
  const double e = __builtin_fma(-u, yy, 1.0);
  const double sum = __builtin_fma(e * e, __builtin_fma(e, 315.0 / 128, 35.0 / 16), __builtin_fma(e, 15.0 / 8, 1.5));
  return {k * (yy * y), e, sum};
}

[[BENCH_AVX512, gnu::always_inline]] inline void find_kick_by_series(Plane& s, double strength) {
  const Series r = series(s.x * s.x + s.y * s.y, strength);
  const double slope = __builtin_fma(r.leading * r.e, r.sum, r.leading);
  s.kick_x = slope * s.x;
  s.kick_y = slope * s.y;
}

[[BENCH_AVX512, gnu::noinline]] void hand_verlet(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  Plane s = load(z);
  const double d = h * (1 / mass);
  const double c = (h * 0.5) * k;
  find_kick_by_series(s, c);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s);
    drift(s, d);
    find_kick_by_series(s, c);
    kick(s);
  }
  save(s, z);
}

[[BENCH_AVX512, gnu::noinline]] void hand_stv4(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr double g1 = stv4_weights[0], g2 = stv4_weights[1];
  Plane s = load(z);
  const double inverse_mass = 1 / mass;
  const double d1 = (h * g1) * inverse_mass, d2 = (h * g2) * inverse_mass;
  const double c1 = (h * (g1 / 2)) * k, c2 = (h * ((g1 + g2) / 2)) * k;
  find_kick_by_series(s, c1);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s);
    drift(s, d1);
    find_kick_by_series(s, c2);
    kick(s);
    drift(s, d2);
    find_kick_by_series(s, c2);
    kick(s);
    drift(s, d1);
    find_kick_by_series(s, c1);
    kick(s);
  }
  save(s, z);
}

/// Any composition, its factors in two arrays.
template <const auto& weights>
[[BENCH_AVX512, gnu::noinline]] void hand_table(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr std::size_t stages = weights.size();
  Plane s = load(z);
  double d[stages], c[stages];
  for (std::size_t j = 0; j < stages; ++j) {
    d[j] = (h * weights[j]) * (1 / mass);
    c[j] = (h * kick_weight<weights>(j)) * k;
  }
  find_kick_by_series(s, c[stages - 1]);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s);
#pragma GCC unroll 20
    for (std::size_t j = 0; j < stages; ++j) {
      drift(s, d[j]);
      find_kick_by_series(s, c[j]);
      kick(s);
    }
  }
  save(s, z);
}

/// With mass, k and h in the coefficients, kicks of neighbouring steps joined, and only the end of the series on the
/// chain from position to momentum.
template <const auto& weights>
[[BENCH_AVX512, gnu::noinline]] void hand_folded(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr std::size_t stages = weights.size();
  Plane s = load(z);
  double d[stages], c[stages];
  for (std::size_t i = 0; i < stages; ++i) {
    d[i] = h * weights[i] / mass;
    c[i] = h * k * (weights[i] + weights[(i + 1) % stages]) / 2;
  }
  double strength = c[stages - 1] / 2;
  for (std::int64_t i = 0; i < steps; ++i) {
    for (std::size_t j = 0; j < stages; ++j) {
      const Series r = series(__builtin_fma(s.x, s.x, s.y * s.y), strength);
      const double ax = r.leading * s.x, ay = r.leading * s.y;
      s.px = __builtin_fma(-(ax * r.e), r.sum, s.px - ax);
      s.py = __builtin_fma(-(ay * r.e), r.sum, s.py - ay);
      s.x = __builtin_fma(d[j], s.px, s.x);
      s.y = __builtin_fma(d[j], s.py, s.y);
      strength = c[j];
    }
  }
  const Series r = series(s.x * s.x + s.y * s.y, c[stages - 1] / 2);
  const double slope = __builtin_fma(r.leading * r.e, r.sum, r.leading);
  s.px -= slope * s.x;
  s.py -= slope * s.y;
  save(s, z);
}

#endif

template <class Recipe>
void add(Workload& w, const Task& task, int forces, [[maybe_unused]] HandLoop loop, [[maybe_unused]] HandLoop folded,
         const Recipe& recipe, double goal = 1.05) {
  const bool fast = hamflow::fast_kernel_available();
  if (fast) {
    w.contenders.push_back(
        {"hand, fast", [=](std::int64_t steps) { return run_hand(task, loop, forces, steps); }, "hand", 0, false});
    w.contenders.push_back({"hand, fast folded",
                            [=](std::int64_t steps) { return run_hand(task, folded, forces, steps); }, "hand, fast", 0,
                            false});
  }
  w.contenders.push_back({"typed, fast", [=](std::int64_t steps) { return run_typed_fast(task, recipe, steps); },
                          fast ? "hand, fast" : "typed", goal, !fast, 1, fast ? "hand, fast" : "typed"});
  w.contenders.push_back(
      {"named, fast",
       [=, method = w.method](std::int64_t steps) { return run_named(task, method, false, steps, "fast"); },
       "typed, fast", 1.1, !fast, 1, "typed, fast"});
}

}  // namespace

void add_fast_contenders(Workload& workload, const Task& task) {
  using namespace hamflow;
#ifdef __x86_64__
  constexpr HandLoop verlet = hand_verlet, verlet_folded = hand_folded<verlet_weights>;
  constexpr HandLoop stv4 = hand_stv4, stv4_folded = hand_folded<stv4_weights>;
  constexpr HandLoop kahan_li8 = hand_table<kahan_li8_weights>, kahan_li8_folded = hand_folded<kahan_li8_weights>;
#else
  constexpr HandLoop verlet = nullptr, verlet_folded = nullptr, stv4 = nullptr, stv4_folded = nullptr;
  constexpr HandLoop kahan_li8 = nullptr, kahan_li8_folded = nullptr;
#endif
  if (workload.method == "verlet") {
    add(workload, task, 1, verlet, verlet_folded, Composition<compositions::verlet>{});
  } else if (workload.method == "stv4") {
    add(workload, task, 3, stv4, stv4_folded, Composition<compositions::stv4>{});
  } else if (workload.method == "kahan-li8") {
    add(workload, task, 17, kahan_li8, kahan_li8_folded, Composition<compositions::kahan_li8>{}, 1.1);
  }
}

}  // namespace bench
