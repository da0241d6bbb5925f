// Hand-written loops over all pairs: a plain loop that visits each pair once, and loops with vectors of eight or four
// numbers.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace bench {

/// Positions and forces, with one array for each coordinate.
struct ParticleArrays {
  std::size_t space;
  std::size_t count;
  std::vector<double> x[3];
  std::vector<double> f[3];
};

/// The factor c(u) of the force F = c(u) d of a pair, for the potentials r^-12 - 2 r^-6 (Lennard-Jones) and -1/r.
struct LennardJonesPair {
  template <class V>
  static V c(const V& u) {
    const V s = 1.0 / u;
    const V s2 = s * s;
    const V s3 = s2 * s;
    return 12.0 * (s2 * s2) * (s3 - 1.0);
  }
};
struct NewtonPair {
  static double root(double u) { return std::sqrt(u); }
  template <class V>
  static V root(const V& u) {
    V r = u;
    for (std::size_t k = 0; k < sizeof(V) / sizeof(double); ++k) r[k] = __builtin_sqrt(u[k]);
    return r;
  }
  template <class V>
  static V c(const V& u) {
    return -1.0 / (u * root(u));
  }
};

template <class Pair, std::size_t Space>
[[gnu::noinline]] void plain_loop(ParticleArrays& s) {
  for (std::size_t k = 0; k < Space; ++k) s.f[k].assign(s.count, 0.0);
  for (std::size_t i = 0; i < s.count; ++i) {
    double own[Space]{};
    for (std::size_t j = i + 1; j < s.count; ++j) {
      double d[Space];
      double u = 0;
      for (std::size_t k = 0; k < Space; ++k) {
        d[k] = s.x[k][i] - s.x[k][j];
        u += d[k] * d[k];
      }
      const double c = Pair::c(u);
      for (std::size_t k = 0; k < Space; ++k) {
        own[k] += c * d[k];
        s.f[k][j] -= c * d[k];
      }
    }
    for (std::size_t k = 0; k < Space; ++k) s.f[k][i] += own[k];
  }
}

/// The loop over all pairs, with `width` partners of a particle in a vector.
template <class Pair, std::size_t Space, std::size_t width>
[[gnu::always_inline]] inline void vector_loop_of(ParticleArrays& s) {
  typedef double V __attribute__((vector_size(width * sizeof(double))));
  const auto load = [](const double* from) __attribute__((always_inline)) {
    V v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
  };
  for (std::size_t k = 0; k < Space; ++k) s.f[k].assign(s.count, 0.0);
  for (std::size_t i = 0; i < s.count; ++i) {
    V own[Space];
    for (std::size_t k = 0; k < Space; ++k) own[k] = V{};
    std::size_t j = i + 1;
    for (; j + width <= s.count; j += width) {
      V d[Space];
      V u = V{};
      for (std::size_t k = 0; k < Space; ++k) {
        d[k] = s.x[k][i] - load(&s.x[k][j]);
        u = u + d[k] * d[k];
      }
      const V c = Pair::c(u);
      for (std::size_t k = 0; k < Space; ++k) {
        const V push = c * d[k];
        own[k] = own[k] + push;
        const V other = load(&s.f[k][j]) - push;
        __builtin_memcpy(&s.f[k][j], &other, sizeof other);
      }
    }
    double rest[Space]{};
    for (; j < s.count; ++j) {
      double d[Space];
      double u = 0;
      for (std::size_t k = 0; k < Space; ++k) {
        d[k] = s.x[k][i] - s.x[k][j];
        u += d[k] * d[k];
      }
      const double c = Pair::c(u);
      for (std::size_t k = 0; k < Space; ++k) {
        rest[k] += c * d[k];
        s.f[k][j] -= c * d[k];
      }
    }
    for (std::size_t k = 0; k < Space; ++k) {
      for (std::size_t l = 0; l < width; ++l) rest[k] += own[k][l];
      s.f[k][i] += rest[k];
    }
  }
}
template <class Pair, std::size_t Space>
[[gnu::noinline, gnu::target("avx2")]] void loop_avx2(ParticleArrays& s) {
  vector_loop_of<Pair, Space, 4>(s);
}
// Clang uses whole registers for such vectors anyway, and does not know this option.
#if defined(__clang__)
#define BENCH_AVX512 "avx512f,avx512dq"
#else
#define BENCH_AVX512 "avx512f,avx512dq,prefer-vector-width=512"
#endif
template <class Pair, std::size_t Space>
[[gnu::noinline, gnu::target(BENCH_AVX512)]] void loop_avx512(ParticleArrays& s) {
  vector_loop_of<Pair, Space, 8>(s);
}

}  // namespace bench
