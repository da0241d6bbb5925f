#include <cmath>

#include "boost_float.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"

namespace hamflow {

#define HAMFLOW_SOFT template <int binary, int largest_exponent>

namespace {
template <class S>
struct BoostOf;
HAMFLOW_SOFT
struct BoostOf<SoftFloat<binary, largest_exponent>> {
  using type = BoostFloat<binary, largest_exponent>;
};
/// Functions, sums and differences are computed with 81 binary digits more and rounded.
template <class S>
struct FinerOf;
HAMFLOW_SOFT
struct FinerOf<SoftFloat<binary, largest_exponent>> {
  using type = BoostFloat<binary + 81, largest_exponent>;
};
template <class S>
auto finer(const S& x) {
  return typename FinerOf<S>::type(x.template held<typename BoostOf<S>::type>());
}
/// The same for an angle. Boost's functions are wrong for large angles, so these are reduced by whole turns first. 1224
/// binary digits are enough for all angles up to 2^1024, the range of a double.
template <class S>
auto finer_angle(const S& x) {
  using Finer = typename FinerOf<S>::type;
  using Exact = BoostFloat<1024 + 200, 16383>;
  const Finer angle = finer(x);
  if (!isfinite(angle) || abs(angle) < 1e15) return angle;
  static const Exact whole_turn = 2 * boost::math::constants::pi<Exact>();
  return Finer(fmod(Exact(angle), whole_turn));
}
template <class S>
auto held(const S& x) {
  return x.template held<typename BoostOf<S>::type>();
}
template <class S>
S holding(const typename BoostOf<S>::type& x) {
  return S::template holding<typename BoostOf<S>::type>(x);
}
}  // namespace

#define HAMFLOW_FROM(Given)                               \
  HAMFLOW_SOFT                                            \
  SoftFloat<binary, largest_exponent>::SoftFloat(Given x) \
      : SoftFloat(hamflow::holding<SoftFloat>(typename BoostOf<SoftFloat>::type(x))) {}
HAMFLOW_FROM(double)
HAMFLOW_FROM(long double)
HAMFLOW_FROM(long long)
HAMFLOW_FROM(unsigned long long)
HAMFLOW_FROM(const std::string&)
#undef HAMFLOW_FROM
HAMFLOW_SOFT SoftFloat<binary, largest_exponent>::operator double() const {
  return static_cast<double>(hamflow::held(*this));
}
HAMFLOW_SOFT SoftFloat<binary, largest_exponent>::operator long double() const {
  return static_cast<long double>(hamflow::held(*this));
}
HAMFLOW_SOFT SoftFloat<binary, largest_exponent> SoftFloat<binary, largest_exponent>::operator-() const {
  return hamflow::holding<SoftFloat>(-hamflow::held(*this));
}
#define HAMFLOW_OPERATOR(sign)                                                                         \
  HAMFLOW_SOFT SoftFloat<binary, largest_exponent> SoftFloat<binary, largest_exponent>::operator sign( \
      const SoftFloat& b) const {                                                                      \
    return hamflow::holding<SoftFloat>(hamflow::held(*this) sign hamflow::held(b));                    \
  }
HAMFLOW_OPERATOR(*)
HAMFLOW_OPERATOR(/)
#undef HAMFLOW_OPERATOR
// Boost takes a unit off a difference even where the second number is below half of that.
#define HAMFLOW_OPERATOR(sign)                                                                         \
  HAMFLOW_SOFT SoftFloat<binary, largest_exponent> SoftFloat<binary, largest_exponent>::operator sign( \
      const SoftFloat& b) const {                                                                      \
    return hamflow::holding<SoftFloat>(typename BoostOf<SoftFloat>::type(finer(*this) sign finer(b))); \
  }
HAMFLOW_OPERATOR(+)
HAMFLOW_OPERATOR(-)
#undef HAMFLOW_OPERATOR
#define HAMFLOW_OPERATOR(sign)                                                                     \
  HAMFLOW_SOFT bool SoftFloat<binary, largest_exponent>::operator sign(const SoftFloat& b) const { \
    return hamflow::held(*this) sign hamflow::held(b);                                             \
  }
HAMFLOW_OPERATOR(==)
HAMFLOW_OPERATOR(<)
HAMFLOW_OPERATOR(<=)
#undef HAMFLOW_OPERATOR

#define HAMFLOW_FUNCTION(name, argument)                                                       \
  HAMFLOW_SOFT auto ExtendedTraits<SoftFloat<binary, largest_exponent>>::name(const T& x)->T { \
    return holding<T>(typename BoostOf<T>::type(boost::multiprecision::name(argument(x))));    \
  }
HAMFLOW_FUNCTION(exp, finer)
HAMFLOW_FUNCTION(log, finer)
HAMFLOW_FUNCTION(sin, finer_angle)
HAMFLOW_FUNCTION(cos, finer_angle)
HAMFLOW_FUNCTION(tan, finer_angle)
HAMFLOW_FUNCTION(asin, finer)
HAMFLOW_FUNCTION(acos, finer)
HAMFLOW_FUNCTION(atan, finer)
HAMFLOW_FUNCTION(sinh, finer)
HAMFLOW_FUNCTION(cosh, finer)
HAMFLOW_FUNCTION(tanh, finer)
#undef HAMFLOW_FUNCTION
HAMFLOW_SOFT auto ExtendedTraits<SoftFloat<binary, largest_exponent>>::atan2(const T& y, const T& x) -> T {
  if (!(x == x && y == y)) return nan();
  return holding<T>(typename BoostOf<T>::type(boost::multiprecision::atan2(finer(y), finer(x))));
}
HAMFLOW_SOFT auto ExtendedTraits<SoftFloat<binary, largest_exponent>>::pow(const T& x, const T& y) -> T {
  return holding<T>(typename BoostOf<T>::type(boost::multiprecision::pow(finer(x), finer(y))));
}
HAMFLOW_SOFT auto ExtendedTraits<SoftFloat<binary, largest_exponent>>::abs(const T& x) -> T {
  return holding<T>(boost::multiprecision::abs(held(x)));
}
HAMFLOW_SOFT auto ExtendedTraits<SoftFloat<binary, largest_exponent>>::sqrt(const T& x) -> T {
  return x < T() ? nan() : holding<T>(boost::multiprecision::sqrt(held(x)));
}
HAMFLOW_SOFT std::string ExtendedTraits<SoftFloat<binary, largest_exponent>>::written(const T& x) {
  static const int places = static_cast<int>(std::ceil(1 + binary * std::log10(2.0)));
  return held(x).str(places, std::ios_base::fmtflags(0));
}
#define HAMFLOW_VALUE(name, value)                                                   \
  HAMFLOW_SOFT auto ExtendedTraits<SoftFloat<binary, largest_exponent>>::name()->T { \
    using Number = typename BoostOf<T>::type;                                        \
    return holding<T>(value);                                                        \
  }
HAMFLOW_VALUE(pi, boost::math::constants::pi<Number>())
HAMFLOW_VALUE(epsilon, std::numeric_limits<Number>::epsilon())
HAMFLOW_VALUE(max, (std::numeric_limits<Number>::max)())
HAMFLOW_VALUE(min, (std::numeric_limits<Number>::min)())
HAMFLOW_VALUE(infinity, std::numeric_limits<Number>::infinity())
HAMFLOW_VALUE(nan, std::numeric_limits<Number>::quiet_NaN())
#undef HAMFLOW_VALUE
#undef HAMFLOW_SOFT

template class SoftFloat<64, 16383>;
template struct ExtendedTraits<SoftFloat<64, 16383>>;
template class SoftFloat<113, 16383>;
template struct ExtendedTraits<SoftFloat<113, 16383>>;
template class SoftFloat<420, 1 << 28>;
template struct ExtendedTraits<SoftFloat<420, 1 << 28>>;

}  // namespace hamflow
