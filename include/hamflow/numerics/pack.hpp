// Many numbers at once, one of each member of an ensemble: a few SIMD registers behind the operators of a number.
// Everything is done lane by lane, in the operations and in the order of the scalar code, so that a lane has the bits
// of a double. Several registers make one pack because a step of a splitting method is one chain of dependent
// operations: while one register waits for its square root, the others work.
//
// Packs exist for more than one instruction set in one program, chosen at run time. Each has registers of its own
// length, hence is a type of its own, and so is every function template that takes it: the linker never merges code of
// one set with that of another. Functions that need an instruction carry its target themselves, take references (by
// value the calling convention would depend on the target) and are inlined where the caller has the target too.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "hamflow/core/math.hpp"

namespace hamflow {

namespace simd {

template <std::size_t Lanes>
struct RegisterOf {
  typedef double type __attribute__((vector_size(Lanes * sizeof(double))));
  typedef long long mask __attribute__((vector_size(Lanes * sizeof(double))));
};
template <std::size_t Lanes>
using Register = typename RegisterOf<Lanes>::type;

// square_root: y <- sqrt(x), correctly rounded in every lane.
#if defined(__x86_64__) && defined(__GNUC__)
inline void square_root(Register<2>& y, const Register<2>& x) { __asm__("sqrtpd %1, %0" : "=x"(y) : "x"(x)); }
__attribute__((target("avx2"))) inline void square_root(Register<4>& y, const Register<4>& x) {
  __asm__("vsqrtpd %1, %0" : "=x"(y) : "x"(x));
}
__attribute__((target("avx512f"))) inline void square_root(Register<8>& y, const Register<8>& x) {
  __asm__("vsqrtpd %1, %0" : "=v"(y) : "v"(x));
}

/// slope <- k u^(-3/2): the operations of inverse_cube_series (numerics/inverse_cube.hpp), in its order.
__attribute__((target("avx512f"))) inline void inverse_cube(Register<8>& slope, const Register<8>& u,
                                                            const Register<8>& k) {
  using R = Register<8>;
  R y;
  __asm__("vrsqrt14pd %1, %0" : "=v"(y) : "v"(u));
  const R yy = y * y;
  R e = R{} + 1.0;  // 1 - u y^2
  __asm__("vfnmadd231pd %2, %1, %0" : "+v"(e) : "v"(u), "v"(yy));
  R low = R{} + 3.0 / 2;  // 15/8 e + 3/2
  __asm__("vfmadd231pd %2, %1, %0" : "+v"(low) : "v"(e), "v"(R{} + 15.0 / 8));
  R sum = R{} + 35.0 / 16;  // 315/128 e + 35/16
  __asm__("vfmadd231pd %2, %1, %0" : "+v"(sum) : "v"(e), "v"(R{} + 315.0 / 128));
  __asm__("vfmadd213pd %2, %1, %0" : "+v"(sum) : "v"(e * e), "v"(low));  // e^2 sum + low
  slope = k * (y * yy);
  __asm__("vfmadd231pd %2, %1, %0" : "+v"(slope) : "v"(slope * e), "v"(sum));
}
#else
template <class R>
inline void square_root(R& y, const R& x) {
  for (std::size_t i = 0; i < sizeof(R) / sizeof(double); ++i) y[i] = std::sqrt(x[i]);
}
#endif

}  // namespace simd

/// Lanes x Registers numbers.
template <std::size_t Lanes, std::size_t Registers>
class Pack {
 public:
  using Register = simd::Register<Lanes>;
  using Mask = typename simd::RegisterOf<Lanes>::mask;
  static constexpr std::size_t size = Lanes * Registers;
  static constexpr bool fast_inverse_cube = Lanes == 8;  // AVX-512: inverse_cube(pack, pack) below

  Pack() = default;
  /// The same in every lane.
  [[gnu::always_inline]] Pack(double x) {  // NOLINT: a constant is a pack
    for (Register& r : part) r = Register{} + x;
  }

  /// A yes or no for every lane.
  struct Flags {
    bool get(std::size_t lane) const { return part[lane / Lanes][lane % Lanes] != 0; }
    /// No, once x >= 0 is infinite or NaN.
    [[gnu::always_inline]] void keep_where_finite(const Pack& x) {
      const Register most = Register{} + std::numeric_limits<double>::max();
      for (std::size_t i = 0; i < Registers; ++i) part[i] &= x.part[i] <= most;
    }
    Mask part[Registers]{};
  };

  double get(std::size_t lane) const { return part[lane / Lanes][lane % Lanes]; }
  void set(std::size_t lane, double x) { part[lane / Lanes][lane % Lanes] = x; }

  [[gnu::always_inline]] friend Pack operator+(const Pack& a, const Pack& b) {
    return combined(a, b, [](const Register& x, const Register& y, Register& z) { z = x + y; });
  }
  [[gnu::always_inline]] friend Pack operator-(const Pack& a, const Pack& b) {
    return combined(a, b, [](const Register& x, const Register& y, Register& z) { z = x - y; });
  }
  [[gnu::always_inline]] friend Pack operator*(const Pack& a, const Pack& b) {
    return combined(a, b, [](const Register& x, const Register& y, Register& z) { z = x * y; });
  }
  [[gnu::always_inline]] friend Pack operator/(const Pack& a, const Pack& b) {
    return combined(a, b, [](const Register& x, const Register& y, Register& z) { z = x / y; });
  }
  [[gnu::always_inline]] friend Pack operator-(const Pack& a) {
    return combined(a, a, [](const Register& x, const Register&, Register& z) { z = -x; });
  }
  [[gnu::always_inline]] Pack& operator+=(const Pack& b) { return *this = *this + b; }
  [[gnu::always_inline]] Pack& operator-=(const Pack& b) { return *this = *this - b; }
  [[gnu::always_inline]] Pack& operator*=(const Pack& b) { return *this = *this * b; }
  [[gnu::always_inline]] Pack& operator/=(const Pack& b) { return *this = *this / b; }
  /// Whether all lanes are equal.
  [[gnu::always_inline]] friend constexpr bool operator==(const Pack& a, const Pack& b) {
    Mask differ{};
    for (std::size_t i = 0; i < Registers; ++i) differ |= a.part[i] != b.part[i];
    return !any(differ);
  }

  [[gnu::always_inline]] friend Pack sqrt(const Pack& a) {
    return combined(a, a, [](const Register& x, const Register&, Register& z) { simd::square_root(z, x); });
  }
  [[gnu::always_inline]] friend Pack abs(const Pack& a) {
    return combined(a, a, [](const Register& x, const Register&, Register& z) {
      z = (Register)((Mask)x & (Mask{} + 0x7fffffffffffffffLL));
    });
  }
  /// b where a < b, else a: also for a NaN the result of larger(double, double).
  [[gnu::always_inline]] friend Pack larger(const Pack& a, const Pack& b) {
    return combined(a, b, [](const Register& x, const Register& y, Register& z) { z = x < y ? y : x; });
  }

  // Functions of the system's library, one lane after the other.
  friend Pack sin(const Pack& a) {
    return each(a, [](double x) { return std::sin(x); });
  }
  friend Pack cos(const Pack& a) {
    return each(a, [](double x) { return std::cos(x); });
  }
  friend Pack tan(const Pack& a) {
    return each(a, [](double x) { return std::tan(x); });
  }
  friend Pack exp(const Pack& a) {
    return each(a, [](double x) { return std::exp(x); });
  }
  friend Pack log(const Pack& a) {
    return each(a, [](double x) { return std::log(x); });
  }
  friend Pack atan(const Pack& a) {
    return each(a, [](double x) { return std::atan(x); });
  }
  friend Pack sinh(const Pack& a) {
    return each(a, [](double x) { return std::sinh(x); });
  }
  friend Pack cosh(const Pack& a) {
    return each(a, [](double x) { return std::cosh(x); });
  }
  friend Pack tanh(const Pack& a) {
    return each(a, [](double x) { return std::tanh(x); });
  }
  friend Pack pow(const Pack& a, const Pack& b) {
    Pack y;
    for (std::size_t i = 0; i < size; ++i) y.set(i, std::pow(a.get(i), b.get(i)));
    return y;
  }

  Register part[Registers]{};

 private:
  template <class F>
  [[gnu::always_inline]] static Pack combined(const Pack& a, const Pack& b, const F& f) {
    Pack c;
#pragma GCC unroll 8
    for (std::size_t i = 0; i < Registers; ++i) f(a.part[i], b.part[i], c.part[i]);
    return c;
  }
  template <class F>
  static Pack each(const Pack& a, const F& f) {
    Pack y;
    for (std::size_t i = 0; i < size; ++i) y.set(i, f(a.get(i)));
    return y;
  }
  [[gnu::always_inline]] static constexpr bool any(const Mask& mask) {
    long long all = 0;
    for (std::size_t i = 0; i < Lanes; ++i) all |= mask[i];
    return all != 0;
  }
};

#if defined(__x86_64__) && defined(__GNUC__)
/// k u^(-3/2) with the bits of the scalar inverse_cube on a machine with AVX-512.
template <std::size_t Registers>
[[gnu::always_inline]] inline Pack<8, Registers> inverse_cube(const Pack<8, Registers>& u,
                                                              const Pack<8, Registers>& k) {
  Pack<8, Registers> slope;
#pragma GCC unroll 8
  for (std::size_t i = 0; i < Registers; ++i) simd::inverse_cube(slope.part[i], u.part[i], k.part[i]);
  return slope;
}
#endif

}  // namespace hamflow
