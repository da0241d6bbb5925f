// Long decimals without MPFR: in place of src/arithmetic/double_double.cpp and src/arithmetic/mp.cpp.
#include "boost_float.hpp"
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"

namespace hamflow {

namespace {
constexpr auto general = std::ios_base::fmtflags(0);
using Widest = BoostFloat<2200, 1 << 14>;  // any sum of two doubles, exactly
using Read = BoostFloat<320, 1 << 14>;     // what wide_digits determine
BoostFloat<420, 1 << 28> held(const Mp& x) { return x.value.held<BoostFloat<420, 1 << 28>>(); }
}  // namespace

std::string written_wide(const dd_real& x) {
  return Widest(Widest(x.x[0]) + Widest(x.x[1])).str(wide_digits - 1, std::ios_base::scientific);
}

dd_real read_wide(std::string_view text) {
  const Read x{std::string(text)};
  const auto high = static_cast<double>(x);
  if (!std::isfinite(high)) return {high};
  return {high, static_cast<double>(Read(x - Read(high)))};
}

std::string rounded_decimal(const std::string& text, int digits) { return Read(text).str(digits, general); }

namespace {
thread_local int digits_in_use = 50;
}
MpDigits::MpDigits(int digits) : before_(digits_in_use) { digits_in_use = digits; }
MpDigits::~MpDigits() { digits_in_use = static_cast<int>(before_); }
long MpDigits::bits() { return ExtendedTraits<MpNumber>::digits; }
std::size_t decimal_places(long bits) {
  return static_cast<std::size_t>(std::ceil(1 + static_cast<double>(bits) * std::log10(2.0)));
}

double binary_logarithm(const Mp& x) {
  int exponent = 0;
  const auto mantissa = frexp(held(x), &exponent);
  return std::log2(std::abs(static_cast<double>(mantissa))) + exponent;
}

std::string scientific_text(const Mp& x, int places) { return held(x).str(places, std::ios_base::scientific); }

std::string exact_text(const Mp& x) { return ExtendedTraits<MpNumber>::written(x.value); }
void from_exact_text(const std::string& text, Mp& x) { x = Mp(ExtendedTraits<MpNumber>::read(text)); }

}  // namespace hamflow
