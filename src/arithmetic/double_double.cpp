#include "hamflow/arithmetic/double_double.hpp"

#include <mpfr.h>

#include <memory>

namespace hamflow {

namespace {
struct Number {
  explicit Number(mpfr_prec_t bits) { mpfr_init2(value, bits); }
  ~Number() { mpfr_clear(value); }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
  mpfr_t value;
};
constexpr mpfr_prec_t widest_sum = 2200;  // of two doubles, exact
constexpr mpfr_prec_t read_bits = 320;    // that wide_digits determine
}  // namespace

std::string written_wide(const dd_real& x) {
  Number sum(widest_sum);
  mpfr_set_d(sum.value, x.x[0], MPFR_RNDN);
  mpfr_add_d(sum.value, sum.value, x.x[1], MPFR_RNDN);
  char text[wide_digits + 32];
  const int length = mpfr_snprintf(text, sizeof text, "%.*Re", wide_digits - 1, sum.value);
  return {text, static_cast<std::size_t>(length)};
}

dd_real read_wide(std::string_view text) {
  Number x(read_bits);
  mpfr_set_str(x.value, std::string(text).c_str(), 10, MPFR_RNDN);
  const double high = mpfr_get_d(x.value, MPFR_RNDN);
  if (!std::isfinite(high)) return {high};
  mpfr_sub_d(x.value, x.value, high, MPFR_RNDN);
  return {high, mpfr_get_d(x.value, MPFR_RNDN)};
}

std::string rounded_decimal(const std::string& text, int digits) {
  Number x(read_bits);
  mpfr_set_str(x.value, text.c_str(), 10, MPFR_RNDN);
  char rounded[wide_digits + 32];
  const int length = mpfr_snprintf(rounded, sizeof rounded, "%.*Rg", digits, x.value);
  return {rounded, static_cast<std::size_t>(length)};
}

}  // namespace hamflow
