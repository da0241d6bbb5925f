#include "function_calls.hpp"

#include <atomic>
#include <bit>
#include <cmath>
#include <span>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/detail/core/hash.hpp"

namespace {
std::atomic<bool> was_called{false};
std::atomic<bool> was_called_in_double_double{false};
void note_call() { was_called.store(true, std::memory_order_relaxed); }
void note_double_double() { was_called_in_double_double.store(true, std::memory_order_relaxed); }
}  // namespace

// The functions that are not correctly rounded. The same names stand in tests/CMakeLists.txt. log10 is left out:
// hamflow and toml++ use it for texts only.
#define HAMFLOW_TRIGONOMETRIC(X) X(sin) X(cos) X(tan) X(asin) X(acos) X(atan)
#define HAMFLOW_HYPERBOLIC(X) X(sinh) X(cosh) X(tanh) X(asinh) X(acosh) X(atanh)
#define HAMFLOW_EXPONENTIAL(X) X(exp) X(exp2) X(expm1) X(log) X(log2) X(log1p) X(cbrt)
#define HAMFLOW_FUNCTIONS_OF_TWO(X) X(pow) X(atan2) X(hypot)

// NOLINTBEGIN: the linker's names
extern "C" {
#define HAMFLOW_WRAP(name)                      \
  double __real_##name(double);                 \
  double __wrap_##name(double x);               \
  double __wrap_##name(double x) {              \
    note_call();                                \
    return __real_##name(x);                    \
  }                                             \
  long double __real_##name##l(long double);    \
  long double __wrap_##name##l(long double x);  \
  long double __wrap_##name##l(long double x) { \
    note_call();                                \
    return __real_##name##l(x);                 \
  }
HAMFLOW_TRIGONOMETRIC(HAMFLOW_WRAP)
HAMFLOW_HYPERBOLIC(HAMFLOW_WRAP)
HAMFLOW_EXPONENTIAL(HAMFLOW_WRAP)
#undef HAMFLOW_WRAP
#define HAMFLOW_WRAP(name)                                     \
  double __real_##name(double, double);                        \
  double __wrap_##name(double x, double y);                    \
  double __wrap_##name(double x, double y) {                   \
    note_call();                                               \
    return __real_##name(x, y);                                \
  }                                                            \
  long double __real_##name##l(long double, long double);      \
  long double __wrap_##name##l(long double x, long double y);  \
  long double __wrap_##name##l(long double x, long double y) { \
    note_call();                                               \
    return __real_##name##l(x, y);                             \
  }
HAMFLOW_FUNCTIONS_OF_TWO(HAMFLOW_WRAP)
#undef HAMFLOW_WRAP
void __real_sincos(double, double*, double*);
void __wrap_sincos(double x, double* sine, double* cosine);
void __wrap_sincos(double x, double* sine, double* cosine) {
  note_call();
  __real_sincos(x, sine, cosine);
}
}

// Those of double-double, by the names of the linker. Only C++ calls them, so that C need not know the type.
#ifdef __clang__
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif
#define HAMFLOW_WRAP(name)                    \
  dd_real __real__Z##name(const dd_real& x);  \
  dd_real __wrap__Z##name(const dd_real& x);  \
  dd_real __wrap__Z##name(const dd_real& x) { \
    note_double_double();                     \
    return __real__Z##name(x);                \
  }
extern "C" {
HAMFLOW_WRAP(3expRK7dd_real)
HAMFLOW_WRAP(3logRK7dd_real)
HAMFLOW_WRAP(3sinRK7dd_real)
HAMFLOW_WRAP(3cosRK7dd_real)
HAMFLOW_WRAP(3tanRK7dd_real)
HAMFLOW_WRAP(4asinRK7dd_real)
HAMFLOW_WRAP(4acosRK7dd_real)
HAMFLOW_WRAP(4atanRK7dd_real)
HAMFLOW_WRAP(4sinhRK7dd_real)
HAMFLOW_WRAP(4coshRK7dd_real)
HAMFLOW_WRAP(4tanhRK7dd_real)
#undef HAMFLOW_WRAP
#define HAMFLOW_WRAP(name)                                      \
  dd_real __real__Z##name(const dd_real& x, const dd_real& y);  \
  dd_real __wrap__Z##name(const dd_real& x, const dd_real& y);  \
  dd_real __wrap__Z##name(const dd_real& x, const dd_real& y) { \
    note_double_double();                                       \
    return __real__Z##name(x, y);                               \
  }
HAMFLOW_WRAP(5atan2RK7dd_realS1_)
HAMFLOW_WRAP(3powRK7dd_realS1_)
#undef HAMFLOW_WRAP
}
// NOLINTEND

namespace hamflow::test {

FunctionCalls function_calls() { return {was_called.exchange(false), was_called_in_double_double.exchange(false)}; }

std::uint64_t hash_of_c_library() {
  std::uint64_t hash = fnv1a_of_nothing;
  const auto add = [&](double x) { hash = fnv1a(std::as_bytes(std::span(&x, 1)), hash); };
  for (int k = 1; k < 4000; ++k) {
    const double small = k * 0x1.0624dd2f1a9fcp-12;  // in (0, 1)
    const double large = small * 37;
    for (const double x : {small, -small}) {
#define HAMFLOW_ADD(name) add(::name(x));
      HAMFLOW_ADD(asin) HAMFLOW_ADD(acos) HAMFLOW_ADD(atanh) HAMFLOW_ADD(expm1) HAMFLOW_ADD(log1p)
    }
    for (const double x : {small, -small, large, -large}) {
      HAMFLOW_ADD(sin)
      HAMFLOW_ADD(cos)
      HAMFLOW_ADD(tan)
      HAMFLOW_ADD(atan)
      HAMFLOW_ADD(sinh)
      HAMFLOW_ADD(cosh) HAMFLOW_ADD(tanh) HAMFLOW_ADD(asinh) HAMFLOW_ADD(exp) HAMFLOW_ADD(exp2) HAMFLOW_ADD(cbrt)
    }
    for (const double x : {small, large}) {
      HAMFLOW_ADD(log)
      HAMFLOW_ADD(log2)
      HAMFLOW_ADD(log10)
#undef HAMFLOW_ADD
      add(::acosh(1 + x));
      for (const double y : {-2.5, -1.0 / 3, 0.7, 3.1}) {
        add(::pow(x, y));
        add(::atan2(x, y));
        add(::hypot(x, y));
      }
    }
  }
  was_called = false;
  return hash;
}

}  // namespace hamflow::test
