// u^(-3/2), the heart of every inverse-square force, and u^(-1/2) without square root and division: both stand on the
// chain of dependent operations from one force to the next, and cost more than all the rest of it.
//
// The AVX-512 instruction vrsqrt14sd gives y = u^(-1/2) (1 + delta) with |delta| < 2^-14. With e = 1 - u y^2, one fused
// operation, u = (1 - e)/y^2 and
//     u^(-3/2) = y^3 (1 - e)^(-3/2) = y^3 (1 + e (3/2 + 15/8 e + 35/16 e^2 + 315/128 e^3)) + R,   |R| < 2^-63 y^3.
// y has so few digits that y^2 and y^3 are exact; what remains is the rounding of the last addition: the error is at
// most 1.002 x 2^-53, against 2.5 x 2^-53 for 1/(u sqrt(u)). Likewise for u^(-1/2). kernel = "fast" is these two in
// place of quotients, in the motion of any problem (core/tape.hpp, run/fast_functions.hpp).
//
// The library is compiled for any x86-64, and the instructions are used only where the processor (and the system)
// reports that it has them. They stand here as assembly and not as intrinsics in functions of another target, because
// such functions are not inlined into a step loop for any x86-64, and because inline functions of a header compiled for
// different processors in different translation units would be merged by the linker into either one.
//
// The domain is 2^-682 < u < 2^670. Above it u^(-3/2) nears the subnormal numbers and its last digits go; once there
// (u > 2^681) it is right to within 2^-1022. Where it nears the largest double or exceeds it, and for u = 0, subnormal,
// negative or NaN, the result is not finite (NaN or an infinity), for u infinite NaN or 0: no u gives a number that is
// wrong without looking so.
#pragma once

#include <cmath>
#include <string_view>

namespace hamflow {

/// What inverse_cube runs on. The last bits differ: a record names it.
enum class InstructionSet { generic, avx512 };

constexpr std::string_view name(InstructionSet set) { return set == InstructionSet::avx512 ? "avx512" : "x86-64"; }

namespace detail {

#if defined(__x86_64__) && defined(__GNUC__)
/// One load and one test of what was found out at the start of the program.
inline bool has_estimate() { return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma"); }

/// y ~ u^(-1/2). volatile: else the compiler may compute it ahead of the branch that tests whether the instruction is
/// there. Nothing else needs it: the fused operations all need y.
[[gnu::always_inline]] inline double inverse_root_estimate(double u) {
  double y;
  __asm__ volatile("vrsqrt14sd %1, %1, %0" : "=x"(y) : "x"(u));
  return y;
}
/// a b + c with one rounding. The sum is in place of c, which is mostly a constant, so that no move stands on the
/// chain.
[[gnu::always_inline]] inline double fused_add(double a, double b, double c) {
  __asm__("vfmadd231sd %2, %1, %0" : "+x"(c) : "x"(a), "x"(b));
  return c;
}
/// c - a b with one rounding.
[[gnu::always_inline]] inline double fused_subtract(double a, double b, double c) {
  __asm__("vfnmadd231sd %2, %1, %0" : "+x"(c) : "x"(a), "x"(b));
  return c;
}
#else
constexpr bool has_estimate() { return false; }
inline double inverse_root_estimate(double u) { return 1 / std::sqrt(u); }
inline double fused_add(double a, double b, double c) { return std::fma(a, b, c); }
inline double fused_subtract(double a, double b, double c) { return std::fma(-a, b, c); }
#endif

/// k u^(-3/2) from an estimate y of u^(-1/2). Estrin's scheme: five operations from y to the result, and k beside them.
[[gnu::always_inline]] inline double inverse_cube_series(double u, double y, double k) {
  const double yy = y * y;
  const double e = fused_subtract(u, yy, 1.0);
  const double low = fused_add(e, 15.0 / 8, 3.0 / 2);
  const double high = fused_add(e, 315.0 / 128, 35.0 / 16);
  const double sum = fused_add(e * e, high, low);
  const double leading = k * (y * yy);
  return fused_add(leading * e, sum, leading);
}

/// k u^(-1/2), likewise: y (1 - e)^(-1/2) = y (1 + e (1/2 + 3/8 e + 5/16 e^2 + 35/128 e^3)) + R, |R| < 2^-66 y.
[[gnu::always_inline]] inline double inverse_root_series(double u, double y, double k) {
  const double e = fused_subtract(u, y * y, 1.0);
  const double low = fused_add(e, 3.0 / 8, 1.0 / 2);
  const double high = fused_add(e, 35.0 / 128, 5.0 / 16);
  const double sum = fused_add(e * e, high, low);
  const double leading = k * y;
  return fused_add(leading * e, sum, leading);
}

}  // namespace detail

/// Whether inverse_cube has its fast form on this machine.
inline bool fast_kernel_available() { return detail::has_estimate(); }
inline InstructionSet fast_kernel_instruction_set() {
  return fast_kernel_available() ? InstructionSet::avx512 : InstructionSet::generic;
}

/// k u^(-3/2), by estimate and series where there is AVX-512, else k/(u sqrt(u)) with the bits of just that expression.
[[gnu::always_inline]] inline double inverse_cube(double u, double k = 1) {
  if (detail::has_estimate()) return detail::inverse_cube_series(u, detail::inverse_root_estimate(u), k);
  return k / (u * std::sqrt(u));
}

/// k u^(-1/2), by estimate and series where there is AVX-512, else k/sqrt(u) with the bits of just that expression.
[[gnu::always_inline]] inline double inverse_root(double u, double k = 1) {
  if (detail::has_estimate()) return detail::inverse_root_series(u, detail::inverse_root_estimate(u), k);
  return k / std::sqrt(u);
}

}  // namespace hamflow
