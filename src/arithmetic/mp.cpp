#include "hamflow/arithmetic/mp.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace hamflow {

namespace {
/// 2^largest_exponent is some 10^(10^6).
constexpr mpfr_exp_t largest_exponent = 3321928;
/// 0: not set yet.
thread_local long bits_in_use = 0;

long bits_for(int digits) { return static_cast<long>(std::ceil(digits * std::log2(10.0))) + 1; }

template <class Operation>
MpNumber made_by(Operation operation) {
  MpNumber x;
  operation(x.raw());
  return x;
}
}  // namespace

MpDigits::MpDigits(int digits) : before_(bits_in_use) {
  // MPFR keeps constants for each thread; they go with it.
  struct Caches {
    // A sine of an argument beyond that would take minutes, and no trajectory leads there.
    Caches() { mpfr_set_emax(largest_exponent + 1); }
    ~Caches() { mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE); }
  };
  static thread_local const Caches of_thread;
  (void)of_thread;
  bits_in_use = bits_for(digits);
}
MpDigits::~MpDigits() { bits_in_use = before_; }
long MpDigits::bits() { return bits_in_use == 0 ? bits_for(50) : bits_in_use; }

MpNumber::MpNumber() noexcept {
  mpfr_init2(number_, MpDigits::bits());
  mpfr_set_zero(number_, 1);
}
MpNumber::MpNumber(const MpNumber& other) noexcept {
  mpfr_init2(number_, mpfr_get_prec(other.number_));
  mpfr_set(number_, other.number_, MPFR_RNDN);
}
MpNumber::MpNumber(MpNumber&& other) noexcept {
  mpfr_init2(number_, MPFR_PREC_MIN);
  mpfr_swap(number_, other.number_);
}
MpNumber& MpNumber::operator=(const MpNumber& other) noexcept {
  if (this != &other) {
    mpfr_set_prec(number_, mpfr_get_prec(other.number_));
    mpfr_set(number_, other.number_, MPFR_RNDN);
  }
  return *this;
}
MpNumber::~MpNumber() { mpfr_clear(number_); }

MpNumber operator-(const MpNumber& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_neg(x, a.raw(), MPFR_RNDN); });
}

using Traits = ExtendedTraits<MpNumber>;
MpNumber Traits::from(long x) noexcept {
  return made_by([&](mpfr_ptr y) { mpfr_set_si(y, x, MPFR_RNDN); });
}
MpNumber Traits::from(double x) noexcept {
  return made_by([&](mpfr_ptr y) { mpfr_set_d(y, x, MPFR_RNDN); });
}
MpNumber Traits::from(long double x) noexcept {
  return made_by([&](mpfr_ptr y) { mpfr_set_ld(y, x, MPFR_RNDN); });
}
MpNumber Traits::add(const T& a, const T& b) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_add(x, a.raw(), b.raw(), MPFR_RNDN); });
}
MpNumber Traits::subtract(const T& a, const T& b) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_sub(x, a.raw(), b.raw(), MPFR_RNDN); });
}
MpNumber Traits::multiply(const T& a, const T& b) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_mul(x, a.raw(), b.raw(), MPFR_RNDN); });
}
MpNumber Traits::divide(const T& a, const T& b) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_div(x, a.raw(), b.raw(), MPFR_RNDN); });
}
MpNumber Traits::abs(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_abs(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::sqrt(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_sqrt(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::exp(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_exp(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::log(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_log(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::sin(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_sin(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::cos(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_cos(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::tan(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_tan(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::asin(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_asin(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::acos(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_acos(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::atan(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_atan(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::sinh(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_sinh(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::cosh(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_cosh(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::tanh(const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_tanh(x, a.raw(), MPFR_RNDN); });
}
MpNumber Traits::atan2(const T& y, const T& a) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_atan2(x, y.raw(), a.raw(), MPFR_RNDN); });
}
MpNumber Traits::pow(const T& a, const T& b) noexcept {
  return made_by([&](mpfr_ptr x) { mpfr_pow(x, a.raw(), b.raw(), MPFR_RNDN); });
}
MpNumber Traits::pi() noexcept {
  return made_by([](mpfr_ptr x) { mpfr_const_pi(x, MPFR_RNDN); });
}
MpNumber Traits::read(std::string_view text) {
  return made_by([&](mpfr_ptr x) { mpfr_set_str(x, std::string(text).c_str(), 10, MPFR_RNDN); });
}
double binary_logarithm(const Mp& x) {
  if (mpfr_nan_p(x.value.raw())) return std::numeric_limits<double>::quiet_NaN();
  if (mpfr_inf_p(x.value.raw())) return std::numeric_limits<double>::infinity();
  if (mpfr_zero_p(x.value.raw())) return -std::numeric_limits<double>::infinity();
  long exponent = 0;
  const double mantissa = mpfr_get_d_2exp(&exponent, x.value.raw(), MPFR_RNDN);
  return std::log2(std::fabs(mantissa)) + static_cast<double>(exponent);
}
std::size_t decimal_places(long bits) {
  return static_cast<std::size_t>(std::ceil(1 + static_cast<double>(bits) * std::log10(2.0)));
}
std::string Traits::written(const T& x) {
  const int places = static_cast<int>(decimal_places(mpfr_get_prec(x.raw())));
  char* text = nullptr;
  const int length = mpfr_asprintf(&text, "%.*Rg", places, x.raw());
  if (length < 0) return "nan";
  std::string out(text, static_cast<std::size_t>(length));
  mpfr_free_str(text);
  return out;
}
namespace {
MpNumber power_of_two(mpfr_exp_t exponent) {
  return made_by([&](mpfr_ptr x) { mpfr_set_ui_2exp(x, 1, exponent, MPFR_RNDN); });
}
}  // namespace
MpNumber Traits::epsilon() noexcept { return power_of_two(1 - static_cast<mpfr_exp_t>(MpDigits::bits())); }
// Larger numbers overflow (MpDigits).
MpNumber Traits::max() noexcept { return power_of_two(largest_exponent); }
// Far inside MPFR's own range, which is at least 2^(-2^30).
MpNumber Traits::min() noexcept { return power_of_two(-(mpfr_exp_t{1} << 28)); }
MpNumber Traits::infinity() noexcept {
  return made_by([](mpfr_ptr x) { mpfr_set_inf(x, 1); });
}
MpNumber Traits::nan() noexcept {
  return made_by([](mpfr_ptr x) { mpfr_set_nan(x); });
}

std::string scientific_text(const Mp& x, int places) {
  char* text = nullptr;
  const int length = mpfr_asprintf(&text, "%.*Re", places, x.value.raw());
  if (length < 0) throw std::bad_alloc();
  std::string out(text, static_cast<std::size_t>(length));
  mpfr_free_str(text);
  return out;
}

std::string exact_text(const Mp& x) {
  char* text = nullptr;
  const int length = mpfr_asprintf(&text, "%Ra", x.value.raw());
  if (length < 0) throw Error("MPFR cannot write a number as text");
  std::string out = std::to_string(mpfr_get_prec(x.value.raw())) + " " + text;
  mpfr_free_str(text);
  return out;
}
void from_exact_text(const std::string& text, Mp& x) {
  const std::size_t space = text.find(' ');
  long bits = 0;
  try {
    bits = std::stol(text.substr(0, space));
  } catch (const std::exception&) {
  }
  if (space == std::string::npos || bits < MPFR_PREC_MIN || bits > 1000000)
    throw Error("the saved bytes hold no number");
  mpfr_set_prec(x.value.raw(), bits);
  if (mpfr_set_str(x.value.raw(), text.c_str() + space + 1, 0, MPFR_RNDN) != 0) {
    throw Error("the saved bytes hold no number");
  }
}

}  // namespace hamflow
